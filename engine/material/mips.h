// Mip chains of the material maps: each kind is averaged in the quantities that light sees, not in the ones that are
// stored.
#pragma once
#include <burnish/image.h>
#include <burnish/material.h>

#include <vector>

namespace burnish::material {

/// The full chain from `level0` (moved in, unchanged, as element 0) down to 1x1; sides halve and round down.
/// Every texel of a level is the exact area average over the level above's floating-point values (nothing is quantised
/// twice; odd sides get fractional weights):
///  - AlbedoSubstance: F0 and diffuse, encoded again (docs/shading.md, section 1); F0 + diffuse is kept.
///  - NormalRoughness: unit normals; alpha² is averaged and widened by the normals' spread, the stored normal is unit
///  length again.
///  - Emissive: linear light. MetalRough: alpha² of G, linear B. Occlusion: linear. A fourth channel of Emissive and
///  MetalRough is averaged linearly.
/// `level0` must be U8 with the channels that <burnish/scene.h> names for the kind; anything else comes back as a
/// single level.
std::vector<Image> buildMips(MapKind kind, Image level0);

/// Added to alpha² for normals whose average has length `length` in [0,1]: 2 σ², σ² = (1 - length)/length, at most 1.
float spreadFromMeanLength(float length);

}  // namespace burnish::material
