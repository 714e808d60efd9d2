#include "scene/fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/shading.h"

namespace burnish::scene {
namespace {

using glm::dvec3;

float held(float value, float least, float most, float otherwise, const char* name, Report* report) {
  const float good = std::isfinite(value) ? std::clamp(value, least, most) : otherwise;
  if (!(good == value) && report) report->warn("fog", fmt::format("its {} is {:g}: {:g} is taken ({:g} to {:g} can be drawn)", name, value, good, least, most));
  return good;
}

double depthOf(const Fog& fog, double from, double to, double way) { return shading::f64::fogDepth(from, to, way, fog.start, fog.density, fog.falloff); }

// The way to the background: the lower a ray points, the deeper its fog. Corners are the lowest directions of a view that looks up only.
double depthOfBackground(const Fog& fog, const ViewFrame& v) {
  using shading::f64::real;
  const double far = BURNISH_FOG_FAR, eye = v.eye.y - fog.height;
  double deepest = 0;
  for (const double x : {-v.tanX, v.tanX})
    for (const double y : {-v.tanY, v.tanY}) {
      const dvec3 aside = v.axes[0] * x + v.axes[1] * y, forward = -v.axes[2];
      const double from = v.orthographic ? eye + aside.y : eye, up = v.orthographic ? forward.y : glm::normalize(forward + aside).y;
      deepest = std::max(deepest, depthOf(fog, from, from + (up > 0 ? up : -1) * far, far));
    }
  return deepest;
}

// To the farthest corner of an instance's box, as dense as where box or eye is lowest.
double depthOfInstance(const Fog& fog, const Derived& derived, const ViewFrame& frame, const VisibleInstance& v) {
  const Bounds& bounds = v.pose ? v.pose->bounds : derived.bounds(v.instance->mesh);
  const dvec3 half = (dvec3(bounds.max) - dvec3(bounds.min)) * 0.5, middle = (dvec3(bounds.max) + dvec3(bounds.min)) * 0.5;
  dvec3 center(0), extent(0);
  for (int r = 0; r < 3; ++r) {
    center[r] = glm::dot(dvec3(v.model[r]), middle) + double(v.model[r].w);
    extent[r] = glm::dot(glm::abs(dvec3(v.model[r])), half);
  }
  const double low = std::min(center.y - extent.y, 0.0) + frame.eye.y - fog.height - (frame.orthographic ? frame.tanX + frame.tanY : 0.0);
  return depthOf(fog, low, low, glm::length(center) + glm::length(extent));
}

bool shines(const Environment& e) { return e.scale > 0 && (!e.map.empty() || e.color.r > 0 || e.color.g > 0 || e.color.b > 0); }

}  // namespace

Fog fogOf(const Scene& scene, Report* report) {
  Fog fog = scene.fog;
  fog.density = held(fog.density, 0, 1e6f, 0, "density", report);
  fog.falloff = held(fog.falloff, 0, 1e6f, 0, "falloff", report);
  fog.height = held(fog.height, -1e9f, 1e9f, 0, "height", report);
  fog.start = held(fog.start, 0, 1e6f, 0, "start", report);
  fog.anisotropy = held(fog.anisotropy, -0.95f, 0.95f, 0, "anisotropy", report);
  for (int i = 0; i < 3; ++i) fog.albedo[i] = held(fog.albedo[i], 0, 1, 1, "albedo", report);
  return fog;
}

double deepestFog(const Scene& scene, const Derived& derived, const ViewFrame& frame, const std::vector<VisibleInstance>& instances, const LightSet& lights) {
  const Fog fog = fogOf(scene, nullptr);
  if (!(fog.density > 0)) return 0;
  double deepest = shines(scene.environment) || !lights.directional.empty() ? depthOfBackground(fog, frame) : 0;
  for (const VisibleInstance& v : instances) {
    if (deepest > kLeastFog) break;
    deepest = std::max(deepest, depthOfInstance(fog, derived, frame, v));
  }
  return deepest;
}

}  // namespace burnish::scene
