// Light that crosses glass: exact Fresnel at each face, thin panes with all that goes back and forth in them, slabs and bodies that refract and absorb (docs/shading.md, section 6, says what the
// renderer makes of the same materials). Colours are by channel; cosines in [0, 1].
#pragma once
#include <glm/glm.hpp>

#include "pathtrace/world.h"

namespace burnish::pathtrace {

class Bsdf;

[[nodiscard]] inline bool isGlass(Passage p) { return p == Passage::Pane || p == Passage::Frosted || p == Passage::Body; }

/// Index inside over outside, at least 1: the material's, or that of its substance's F0.
float indexOf(const SurfacePoint& point);
/// Exact reflectance of its outer face.
float faceReflectance(const SurfacePoint& point, float cosine);

/// A pane of two faces of reflectance F with `tint` between them, once a crossing: what crosses, (1 - F)² a/(1 - F² a²), the sum over all that goes back and forth; and what comes back out of its
/// front after the first reflection, over F: (1 - F)² a²/(1 - F² a²).
glm::vec3 paneThrough(float f, const glm::vec3& tint);
glm::vec3 paneBack(float f, const glm::vec3& tint);

/// What absorption leaves of light that crosses a slab (a body whose mesh is open) once. 1 for panes.
glm::vec3 slabLeft(const SurfacePoint& point, float cosine);

/// A ray that has crossed a face.
struct Crossed {
  glm::vec3 direction{0, 0, -1};  ///< unit
  glm::vec3 share{0};             ///< of radiance, as seen from where the path comes from
  glm::dvec3 shift{0};            ///< by how far it leaves from elsewhere, m (slabs)
  bool into = false;              ///< it is in the body now
};
/// The front of a body: the ray goes in, through a facet. Radiance inside is the index squared times as much.
Crossed enter(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler);
/// The back of a body, met from inside: one facet reflects or lets out, exact for both, beyond the critical angle all comes back.
Crossed meetFromInside(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler);
/// Frosted panes and slabs: in through a facet, out through a smooth face parallel to the surface. Rays that the far face keeps try another facet.
Crossed crossPane(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler);

}  // namespace burnish::pathtrace
