// A clear day's sun and sky in a scene.
#include "prefilter/sky.h"

#include <burnish/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prefilter/spectrum.h"

namespace burnish {
namespace {

using glm::dvec3;

double held(double value, double least, double most, double otherwise, const char* name, Report& report) {
  const double good = std::isfinite(value) ? std::clamp(value, least, most) : otherwise;
  if (!(good == value)) report.warn("sky", fmt::format("its {} is {:g}: {:g} is taken ({:g} to {:g} can be computed)", name, value, good, least, most));
  return good;
}

prefilter::SkyModel modelOf(const SunSky& sky, Report& report) {
  prefilter::SkyModel m;
  const dvec3 to(sky.toSun);
  const double length = glm::length(to);
  if (std::isfinite(length) && length > 0)
    m.toSun = glm::vec3(to / length);
  else
    report.warn("sky", "its sun is in no direction: the zenith is taken");
  m.turbidity = held(sky.turbidity, 1, 10, 2.5, "turbidity", report);
  m.altitude = held(sky.altitude, 1, 50000, 2, "altitude", report);
  for (int i = 0; i < 3; ++i) m.ground[i] = float(held(sky.ground[i], 0, 1, 0.2, "ground", report));
  return m;
}

// Half floats hold the map where its largest value is some thousands.
void setEnvironment(Environment& e, const prefilter::SkyModel& model, prefilter::SkyPicture picture) {
  const std::span<float> values(picture.map.f32(), picture.map.pixelCount() * 3);
  const float largest = *std::max_element(values.begin(), values.end());
  const float scale = largest > 0 ? std::exp2(std::clamp(std::ceil(std::log2(largest / 8192)), -60.0f, 60.0f)) : 1;
  for (float& v : values) v /= scale;
  e.map = std::move(picture.map);
  e.color = glm::vec3(0);
  e.scale = scale;
  e.sun.reset();
  if (glm::length(picture.sunRadiance) > 0) e.sun = Environment::Sun{model.toSun, glm::vec3(picture.sunRadiance), float(prefilter::kSunRadius), float(picture.horizon)};
  ++e.revision;
}

// Axes whose third column points to the sun: lights shine along -Z.
glm::dmat4 turnedTo(const dvec3& sun) {
  const dvec3 side = glm::normalize(glm::cross(std::abs(sun.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), sun));
  return glm::dmat4(glm::dmat3(side, glm::cross(sun, side), sun));
}

}  // namespace

Id<Light> setSky(Scene& scene, const SunSky& sky, Report& report, Id<Light> sun) {
  const prefilter::SkyModel model = modelOf(sky, report);
  prefilter::SkyPicture picture = prefilter::skyPicture(model);
  const dvec3 lux = picture.sunIlluminance;
  setEnvironment(scene.environment, model, std::move(picture));
  if (!scene.lights.has(sun)) {
    Node node;
    node.name = "sun";
    Light light;
    light.name = "sun";
    light.node = scene.nodes.add(node);
    sun = scene.lights.add(light);
  }
  Light& light = *scene.lights.edit(sun);
  const double most = std::max({lux.x, lux.y, lux.z});
  light.kind = LightKind::Directional;
  light.enabled = most > 0;
  light.intensity = float(most);
  light.color = most > 0 ? glm::vec3(lux / most) : glm::vec3(1);
  if (!scene.nodes.has(light.node)) light.node = scene.nodes.add(Node{});
  Node& node = *scene.nodes.edit(light.node);
  const glm::dmat4 parent = node.parent ? scene.world(node.parent) : glm::dmat4(1);
  node.local = std::abs(glm::determinant(glm::dmat3(parent))) > 0 ? glm::inverse(parent) * turnedTo(dvec3(model.toSun)) : turnedTo(dvec3(model.toSun));
  return sun;
}

}  // namespace burnish
