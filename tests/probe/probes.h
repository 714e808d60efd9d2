// What the tests of captures share: a context, a capture on it, texels by name.
#pragma once
#include <fmt/format.h>

#include <iostream>

#include "prefilter/cube.h"
#include "probe/bounce.h"
#include "render/scenes.h"
#include "stability/rooms.h"

namespace burnish::test {

/// Context and capture of a scene. `scene` is taken as it is: darken it first where that matters.
struct Observatory {
  std::unique_ptr<Context> context = openContext();
  std::unique_ptr<probe::Capture> capture;

  explicit Observatory(Scene scene, const Quality& quality = {}) { point(std::move(scene), quality); }
  /// Starts anew with another scene, on the same context.
  void point(Scene scene, const Quality& quality = {}) {
    REQUIRE(context->makeCurrent());
    capture.reset();
    auto made = probe::Capture::create(context->procAddress(), std::move(scene), quality);
    if (!made) FAIL("no capture: " << made.error().message());
    capture = std::move(*made);
  }
  ~Observatory() {
    if (context->makeCurrent()) capture.reset();
  }
  Observatory(const Observatory&) = delete;
  Observatory& operator=(const Observatory&) = delete;
  CubeLevel radiance(dvec3 at, int size) {
    REQUIRE(context->makeCurrent());
    auto level = capture->radiance(at, size);
    if (!level) FAIL("capture: " << level.error().message());
    REQUIRE(level->size == size);
    REQUIRE(level->texels.size() == std::size_t(18 * size * size));
    return std::move(*level);
  }
};

inline dvec3 texel(const CubeLevel& level, int face, int x, int y) {
  const float* t = level.texels.data() + 3 * ((std::size_t(face) * std::size_t(level.size) + std::size_t(y)) * std::size_t(level.size) + std::size_t(x));
  return {t[0], t[1], t[2]};
}
/// f(face, x, y, direction, radiance) for each texel.
template <class F>
void eachTexel(const CubeLevel& level, F&& f) {
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < level.size; ++y)
      for (int x = 0; x < level.size; ++x) f(face, x, y, prefilter::texelDirection(level.size, face, x, y), texel(level, face, x, y));
}
/// A lat-long picture of a function of the direction.
template <class F>
Image latLong(int width, F&& f) {
  Image image = makeImage(width, width / 2, 3, PixelType::F32);
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const double t = kPi * (y + 0.5) / (width / 2), p = 2 * kPi * ((x + 0.5) / width - 0.5);
      const dvec3 c = f(dvec3(std::sin(t) * std::sin(p), std::cos(t), -std::sin(t) * std::cos(p)));
      for (int k = 0; k < 3; ++k) image.f32()[(y * width + x) * 3 + k] = float(c[k]);
    }
  return image;
}
using stability::addRoom;
using stability::probeIn;
/// All six walls of one material.
inline void addRoom(Scene& scene, vec3 low, vec3 high, const Material& material) { addRoom(scene, low, high, {material, material, material, material, material, material}); }

/// A bake in memory: bounce after bounce, each lit by the one before.
struct Bake {
  ProbeSet set;                       ///< as the last bounce left it
  std::vector<BounceReport> bounces;
  std::vector<probe::PointLight> lights;
  std::string error;

  /// One more bounce; false: it was the last.
  bool bounce(Observatory& o, const ProbeSet& places, const BakeOptions& options) {
    if (!probe::wantsMore(bounces, options)) return false;
    o.capture->setProbes(bounces.empty() ? probe::blackLight(places, options) : set);
    std::vector<IrradianceSh> before, now;
    for (const probe::PointLight& l : lights) before.push_back(l.irradiance);
    probe::PointTime time;
    for (int i = 0; i < probe::captureCount(places); ++i) {
      auto light = probe::capturePoint(*o.capture, places, i, options, time);
      if (!light) FAIL("capture: " << light.error().message());
      now.push_back(light->irradiance);
      if (std::size_t(i) < lights.size())
        lights[std::size_t(i)] = std::move(*light);
      else
        lights.push_back(std::move(*light));
    }
    auto judged = probe::judge(bounces, probe::changeOf(before, now));
    if (!judged) {
      error = judged.error().message();
      return false;
    }
    bounces.push_back(*judged);
    set = probe::withLight(places, lights);
    return true;
  }
  void run(Observatory& o, const ProbeSet& places, const BakeOptions& options) {
    while (bounce(o, places, options)) {}
  }
};

}  // namespace burnish::test
