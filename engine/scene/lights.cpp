// Lights of a scene as culling and shading want them: relative to the eye, finite, each with a radius beyond which it gives nothing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "interface/limits.h"
#include "scene/visibility.h"

namespace burnish::scene {
namespace {

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string place(const Light& light) { return light.name.empty() ? "an unnamed light" : fmt::format("light '{}'", light.name); }

// A light's size, held at 0 to `most`; what cannot be is 0.
float sizeOf(const Light& light, float size, const char* name, float most, Report& report) {
  if (!light.castsShadow || (size >= 0 && size <= most)) return light.castsShadow ? size : 0;
  const float held = size > most ? most : 0;
  report.warn(place(light), fmt::format("has {} {:.3g}: {:.3g} is used, 0 to {:.3g} can be", name, size, held, most));
  return held;
}

// Where the light ends: at its own range through a window, or where it falls to the threshold.
void setRange(LocalLight& l, const Light& light, const Quality& quality, Report& report) {
  if (light.range > 0 && std::isfinite(light.range)) {
    l.radius = light.range;
    const double r2 = double(light.range) * light.range;
    l.invRange4 = float(std::min(1.0 / (r2 * r2), 1e30));
    return;
  }
  const float peak = std::max({l.intensity.x, l.intensity.y, l.intensity.z});
  const float threshold = std::max(quality.lightThreshold, 1e-12f);
  l.radius = float(std::sqrt(double(peak) / threshold));
  l.bias = threshold / peak;  // 1/radius²: the strongest channel reaches zero at the radius, without a step
  report.warn(place(light), fmt::format("has no range: it ends at {:.3g} m, where it gives {:.3g} lux; it loses that much everywhere (Quality::lightThreshold)", l.radius, threshold));
}

void setCone(LocalLight& l, const Light& light, const glm::dmat4& world) {
  const glm::dvec3 axis = -glm::dvec3(world[2]);
  const double length = glm::length(axis);
  l.axis = length > 1e-30 ? glm::vec3(axis / length) : glm::vec3(0, -1, 0);
  // glTF: 0 <= inner < outer <= pi/2. Equal cones get a sharp edge 0.001 rad wide; zero cones are lit by nothing.
  const float outer = std::clamp(std::isfinite(light.outerCone) ? light.outerCone : 0.7853982f, 0.0f, 1.5707964f);
  const float inner = std::clamp(std::isfinite(light.innerCone) ? light.innerCone : 0.0f, 0.0f, std::max(outer - 0.001f, 0.0f));
  const double cosInner = std::cos(double(inner)), cosOuter = std::cos(double(outer));
  const double scale = 1 / std::max(cosInner - cosOuter, 1e-7);
  l.spotScale = float(scale);
  l.spotOffset = float(-cosOuter * scale);
  l.cosOuter = float(cosOuter);
}

}  // namespace

LightSet gatherLights(const Scene& scene, const Derived& derived, const ViewFrame& frame, const Quality& quality, Report& report, Reach reach) {
  LightSet set;
  const Frustum frustum(frame);
  const bool probes = scene.probes.lit();
  scene.lights.each([&](Id<Light> id, const Light& light) {
    if (!light.enabled || (light.standIn && probes)) return;
    const glm::dmat4 world = scene.nodes.has(light.node) ? derived.world(light.node) : glm::dmat4(1);
    const glm::vec3 power = glm::max(light.color, glm::vec3(0)) * light.intensity;
    if (!finite(light.color) || !std::isfinite(light.intensity) || !finite(power) || !finite(glm::vec3(glm::dvec3(world[3]) - frame.eye))) {
      report.warn(place(light), "has a colour, intensity or position that is not finite: it is off");
      return;
    }
    if (!(std::max({power.x, power.y, power.z}) > 0)) return;
    if (light.kind == LightKind::Directional) {
      if (set.directional.size() == MAX_DIRECTIONAL) {
        report.warn(place(light), fmt::format("is past the limit of {} directional lights: it is off", MAX_DIRECTIONAL));
        return;
      }
      const glm::dvec3 back(world[2]);
      const double length = glm::length(back);
      set.directional.push_back({id, length > 1e-30 ? glm::vec3(back / length) : glm::vec3(0, 1, 0), power, sizeOf(light, light.angularDiameter, "angularDiameter", 3.0f, report), light.castsShadow});
      return;
    }
    LocalLight l;
    l.id = id;
    l.position = glm::vec3(glm::dvec3(world[3]) - frame.eye);
    l.intensity = power;
    l.sourceRadius = sizeOf(light, light.sourceRadius, "sourceRadius", 1e6f, report);
    l.castsShadow = light.castsShadow;
    setRange(l, light, quality, report);
    if (light.kind == LightKind::Spot) {
      if (light.outerCone <= 0) return;
      setCone(l, light, world);
    }
    if (reach == Reach::InView && !frustum.meetsSphere(l.position, l.radius)) return;
    set.local.push_back(l);
  });
  return set;
}

}  // namespace burnish::scene
