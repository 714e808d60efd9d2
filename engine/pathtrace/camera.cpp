#include "pathtrace/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/fog.h"

namespace burnish::pathtrace {

namespace f64 = shading::f64;

Camera::Camera(const View& view, glm::ivec2 size) : size_(size) {
  View whole = view;
  whole.viewport = glm::ivec4(0);
  frame_ = scene::frameOf(whole, size);
}

PathRay Camera::ray(const glm::dvec2& pixel) const {
  const glm::dvec2 step(2 * frame_.tanX / size_.x, 2 * frame_.tanY / size_.y);
  const glm::dvec3 right = frame_.axes[0], up = frame_.axes[1], aside = right * (pixel.x * step.x - frame_.tanX) + up * (frame_.tanY - pixel.y * step.y);
  PathRay r;
  r.camera = true;
  r.acrossX = right * step.x;
  r.acrossY = up * step.y;
  r.origin = frame_.orthographic ? frame_.eye + aside : frame_.eye;
  r.direction = glm::normalize(frame_.orthographic ? forward() : forward() + aside);
  r.from = frame_.near / glm::dot(r.direction, forward());
  return r;
}

double Camera::end(const PathRay& ray) const { return frame_.far > 0 ? frame_.far / glm::dot(ray.direction, forward()) : std::numeric_limits<double>::infinity(); }

glm::vec3 Camera::sunDisc(const Environment::Sun& sun, const glm::dvec3& d) const {
  const auto finite = [](float v, float otherwise) { return double(std::isfinite(v) ? v : otherwise); };
  if (frame_.orthographic) return glm::vec3(0);
  const double radius = std::clamp(finite(sun.radius, 0.004652f), 1e-5, 1.5), horizon = finite(sun.horizon, -2);
  const double step = 4 * frame_.tanX * frame_.tanY / (double(size_.x) * double(size_.y)), c = glm::dot(d, forward());
  const double pixel = std::sqrt(step * c * c * c), edge = pixel * pixel / 12, own = radius * radius, drawn = std::max(own - edge, pixel * pixel);
  const double share = std::clamp(0.5 + (std::sqrt(drawn) - glm::distance(d, glm::dvec3(sun.toSun))) / pixel, 0.0, 1.0) * std::clamp(0.5 + (d.y - horizon) / pixel, 0.0, 1.0);
  glm::vec3 out;
  for (int i = 0; i < 3; ++i) out[i] = float(std::clamp(finite(sun.radiance[i], 0), 0.0, 1e30) * share * own / (drawn + edge));
  return out;
}

FogBefore::FogBefore(const Scene& scene, const Surroundings& surroundings, std::span<const PunctualLight> suns, Report& report) : fog_(scene::fogOf(scene, &report)) {
  if (!there()) return;
  if (surroundings.lit()) {
    if (auto sh = irradianceSh(surroundings.picture()))
      for (std::size_t i = 0; i < 4; ++i)
        for (int c = 0; c < 3; ++c) ambient_[i][c] = float((*sh)[i][std::size_t(c)]) * fog_.albedo[c] * (i == 0 ? 1 : 1.5f * fog_.anisotropy);
  }
  for (const PunctualLight& l : suns)
    if (l.directional) suns_.emplace_back(l.toLight, l.power * fog_.albedo);
}

FogShare FogBefore::share(const PathRay& ray, double distance) const {
  FogShare s;
  if (!there()) return s;
  using f64::real;
  const double way = std::isfinite(distance) ? distance : BURNISH_FOG_FAR, from = ray.origin.y - double(fog_.height);
  const double depth = f64::fogDepth(from, from + ray.direction.y * way, std::max(way, 1e-30), fog_.start, fog_.density, fog_.falloff);
  s.through = float(f64::fogThrough(depth));
  const glm::vec3 d(ray.direction);
  s.source = glm::max(ambient_[0] + ambient_[1] * d.y + ambient_[2] * d.z + ambient_[3] * d.x, glm::vec3(0));
  for (const auto& [toSun, light] : suns_) s.source += light * float(f64::phaseHenyeyGreenstein(glm::dot(glm::dvec3(toSun), ray.direction), fog_.anisotropy));
  return s;
}

}  // namespace burnish::pathtrace
