#include "plan/capture_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burnish::plan {
namespace {

/// Of the scene's diagonal: a point may be so near to a surface, and depths are floats whose precision does not depend on it (reversed, no far end).
constexpr double kNearShare = 1e-5;
constexpr double kNearest = 0x1p-17, kFarthest = 0x1p-4;  // metres

/// Columns right, up and back of a face's view: table 8.19 of the OpenGL 4.5 specification, s to the right and t upward.
glm::dmat3 faceAxes(int face) {
  constexpr std::array<glm::dvec3, 6> kRight{{{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}}};
  constexpr std::array<glm::dvec3, 6> kUp{{{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}}};
  const glm::dvec3 right = kRight[std::size_t(face)], up = kUp[std::size_t(face)];
  return {right, up, glm::cross(right, up)};
}

}  // namespace

Quality captureQuality(const Quality& quality) {
  Quality q = quality;
  q.antialiasing = Antialiasing::None;
  q.specularAntialiasing = SpecularAntialiasing::None;
  q.bloom = Bloom::None;
  q.lightBuffer = Quality{}.lightBuffer;
  q.resolutionScale = 1;
  q.toneMap = ToneMap::None;
  // What the screen hides depends on where the eye is: light that probes bring has its shadows already.
  if (q.occlusion > Occlusion::Baked) q.occlusion = Occlusion::Baked;
  q.exposureEv.reset();
  return q;
}

float captureNear(const Scene& scene) {
  const Bounds b = scene.bounds();
  const double near = b.empty() ? 0 : double(glm::length(b.max - b.min)) * kNearShare;
  return std::isfinite(near) ? float(std::clamp(std::exp2(std::floor(std::log2(std::max(near, kNearest)))), kNearest, kFarthest)) : float(kFarthest);
}

std::array<View, 6> faceViews(glm::dvec3 point, float near, int size, glm::ivec2 corner) {
  std::array<View, 6> views;
  for (int face = 0; face < 6; ++face) {
    View& v = views[std::size_t(face)];
    v.eye = point;
    v.axes = faceAxes(face);
    v.fovY = std::numbers::pi_v<float> / 2;
    v.near = near;
    v.viewport = {corner.x + face % 3 * size, corner.y + face / 3 * size, size, size};
  }
  return views;
}

}  // namespace burnish::plan
