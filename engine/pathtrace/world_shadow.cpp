// What light loses on a straight way: shadow rays.
#include <algorithm>
#include <cmath>
#include <vector>

#include "pathtrace/glass.h"
#include "pathtrace/world_parts.h"
#include "prefilter/dfg.h"

namespace burnish::pathtrace {
namespace {

namespace f32 = shading::f32;

// What the surface reflects of light from `v`, by the rungs in force: the rest crosses it (forward/transparent.frag, reflectedShare).
glm::vec3 reflected(const f32::Surface& m, const shading::Rungs& k) {
  const glm::vec2 dfg(prefilter::lookUpDfg(k, m.nov, m.alpha)), mean(prefilter::lookUpDfgMean(k, m.alpha));
  return {f32::specularAlbedo(m.f0.x, dfg, mean, k), f32::specularAlbedo(m.f0.y, dfg, mean, k), f32::specularAlbedo(m.f0.z, dfg, mean, k)};
}

bool turns(Passage p) { return p == Passage::Body || p == Passage::Frosted; }

}  // namespace

glm::vec3 World::Parts::crossing(const SurfacePoint& p, const glm::vec3& toRay) const {
  if (p.passage == Passage::Opaque) return glm::vec3(0);
  if (p.unlit) return glm::vec3(1 - p.coverage * p.pigment);
  const f32::Surface m = f32::makeSurface(p.normal, toRay, p.albedo, p.substance, p.alpha);
  glm::vec3 through;
  if (p.passage == Passage::Blend) through = (1 - p.pigment) * glm::clamp(glm::vec3(1) - reflected(m, rungs), glm::vec3(0), glm::vec3(1));
  else if (p.passage == Passage::Body && !p.open) through = m.diffuse * p.transmission * (1 - faceReflectance(p, m.nov));
  else through = paneThrough(faceReflectance(p, m.nov), m.diffuse * p.transmission);
  return through * p.coverage + (1 - p.coverage);
}

// All surfaces on the way that may let light through, nearest first.
glm::vec3 World::Parts::through(std::vector<reference::Hit>& hits, const PathRay& ray, bool straight) const {
  glm::vec3 left(1);
  SurfacePoint p;
  double entered = 0;                  // metres along the ray
  std::uint32_t inside = ~0u;          // the instance whose body the ray is in
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const reference::Hit& hit = hits[i];
    // Both triangles of an edge that the ray meets are one surface.
    if (i > 0 && hit.mesh == hits[i - 1].mesh && hit.back == hits[i - 1].back && hit.distance - hits[i - 1].distance <= gap) continue;
    if (!surface(ray, hit, p)) continue;
    if (p.passage == Passage::Opaque || (turns(p.passage) && !straight)) return glm::vec3(0);
    left *= crossing(p, glm::vec3(-ray.direction));
    if (p.passage == Passage::Body) {
      // From where it was entered (or from where the ray starts) to here, where it is left.
      if (p.open) left *= slabLeft(p, std::abs(glm::dot(p.normal, glm::vec3(ray.direction))));
      else if (p.back) left *= glm::exp(p.absorption * float(-(hit.distance - (inside == p.instance ? entered : 0))));
      inside = p.back ? ~0u : p.instance;
      entered = hit.distance;
    }
    if (left == glm::vec3(0)) return left;
  }
  return left;
}

glm::vec3 World::Parts::transmittance(const glm::dvec3& origin, const glm::dvec3& direction, double length, Bodies bodies) const {
  if (!(length > 0)) return glm::vec3(1);
  const bool straight = bodies == Bodies::Straight;
  // Punctual lights are kept off by what casts shadows, surroundings and emitters by all that paths meet.
  const std::uint32_t of = straight ? std::uint32_t(kCasters) : 1u;
  reference::Ray r{origin, direction, 0, length};
  r.mask = of * (std::uint32_t(kSolid) | (straight ? 0u : std::uint32_t(kBody)));
  if (geometry.rays.occluded(r)) return glm::vec3(0);
  const std::uint32_t partly = (geometry.holes ? std::uint32_t(kHoles) : 0) | (geometry.thin ? std::uint32_t(kThin) : 0) | (geometry.bodies && straight ? std::uint32_t(kBody) : 0);
  if (partly == 0) return glm::vec3(1);
  r.mask = of * partly;
  if (!geometry.rays.occluded(r)) return glm::vec3(1);
  std::vector<reference::Hit> hits;
  geometry.rays.all(r, hits);
  PathRay ray;
  ray.origin = origin;
  ray.direction = direction;
  return through(hits, ray, straight);
}

}  // namespace burnish::pathtrace
