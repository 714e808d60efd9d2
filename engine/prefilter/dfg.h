// The directional albedo of the specular lobe as scale and bias of F0 (DFG), tabulated when the project is built.
#pragma once
#include <burnish/quality.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace burnish::prefilter {

/// Texels on each side. Column i stands for n·v = i/(size-1), row j for perceptual roughness j/(size-1); dfgCoordinate of shading/environment.h leads there.
inline constexpr int kDfgSize = 64;
/// kDfgSize² pairs (scale, bias) as 16-bit unsigned normalized: E(v) = F0 · scale + bias, Schlick's Fresnel, exact normalization.
std::span<const std::uint16_t> dfgTable(Geometry geometry);

/// One entry by quadrature over the half vector (importance sampled grid of u × v samples), in double. nov in (0, 1], roughness in [0, 1].
glm::dvec2 integrateDfg(Geometry geometry, double nov, double roughness, int u = 128, int v = 64);

}  // namespace burnish::prefilter
