// H20: glossy bumpy surfaces that move by parts of a pixel. One sample a pixel hits or misses lobes that are narrower than the normal's turn within it; against 16 x 16 samples a pixel
// that is noise over time. Specular antialiasing bounds it and keeps the light.
#include <fmt/format.h>

#include <iostream>

#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{40, 32};
constexpr int kFrames = 16, kFine = 16;

/// A pixel is a metre.
View above(double x, double y) {
  View v = lookAt({x, y, 50}, {x, y, 0});
  v.orthographic = true;
  v.height = float(kSize.y);
  v.far = 100;
  return v;
}

Material glossy(float roughness) {
  Material m;
  m.albedo = vec3(0.9f);
  m.substance = 1;
  m.roughness = roughness;
  return m;
}

void addSun(Scene& scene) { addLight(scene, light(LightKind::Directional, vec3(1), 10), {0, 0, 0}, {-0.25, -0.2, -1}); }

/// Balls with a radius of a few pixels, side by side.
Scene beads() {
  Scene scene;
  const Material m = glossy(0.2f);
  for (int j = -3; j <= 3; ++j)
    for (int i = -4; i <= 4; ++i) place(scene, sphere(2.2f, 24, 48), m, translation({i * 5.3, j * 5.1, 0}));
  addSun(scene);
  return scene;
}

/// A surface whose normal turns by up to 0.25 radians a pixel, by its own vertices.
Scene ripples() {
  Scene scene;
  Mesh m;
  constexpr int kCells = 220;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) {
      const double x = (i - kCells / 2) * 0.25, y = (j - kCells / 2) * 0.25;
      m.positions.emplace_back(float(x), float(y), 0);
      m.normals.push_back(vec3(glm::normalize(dvec3(0.22 * std::cos(1.1 * x + 0.4 * y), 0.22 * std::cos(0.9 * y - 0.3 * x), 1))));
      m.uv0.emplace_back(0);
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
      m.indices.insert(m.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  place(scene, std::move(m), glossy(0.2f));
  addSun(scene);
  return scene;
}

/// The same from a normal map of so many texels a pixel.
Scene mapped(double texels) {
  Scene scene;
  Material m = glossy(0.2f);
  m.mapB = scene.textures.add(painted(MapKind::NormalRoughness, 256, [](float u, float v) {
    const float x = 6.2831853f * u, y = 6.2831853f * v;
    const vec3 n = glm::normalize(vec3(0.22f * std::cos(42 * x + 15 * y), 0.22f * std::cos(34 * y - 11 * x), 1));
    return vec4(n * (127.0f / 255) + 128.0f / 255, 1);
  }));
  Mesh floor = quad({0, 0, 0}, {40, 0, 0}, {0, 40, 0});
  for (glm::vec2& uv : floor.uv0) uv *= float(80 * texels / 256);
  makeTangents(floor);
  place(scene, std::move(floor), m);
  addSun(scene);
  return scene;
}

double value(const Picture& p, int x, int y) { return p.at(x, y).y; }

/// Means of kFine x kFine pixels.
std::vector<double> reduced(const Picture& p) {
  std::vector<double> out(std::size_t(kSize.x * kSize.y));
  for (int y = 0; y < kSize.y * kFine; ++y)
    for (int x = 0; x < kSize.x * kFine; ++x) out[std::size_t(y / kFine * kSize.x + x / kFine)] += value(p, x, y) / (kFine * kFine);
  return out;
}

struct Measured {
  double change = 0;  ///< variance over time, mean of all pixels
  double error = 0;   ///< mean square of the difference to the fine picture
  double mean = 0;
};

Measured measure(const std::vector<std::vector<double>>& frames, const std::vector<std::vector<double>>& exact) {
  Measured m;
  const std::size_t pixels = frames[0].size();
  for (std::size_t i = 0; i < pixels; ++i) {
    double sum = 0, square = 0;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      sum += frames[f][i];
      square += frames[f][i] * frames[f][i];
      m.error += std::pow(frames[f][i] - exact[f][i], 2) / double(pixels * frames.size());
    }
    const double mean = sum / double(frames.size());
    m.change += (square / double(frames.size()) - mean * mean) / double(pixels);
    m.mean += mean / double(pixels);
  }
  return m;
}

}  // namespace

TEST_CASE("H20: glossy bumpy surfaces that move by parts of a pixel: specular antialiasing bounds what changes and keeps the light", "[h20]") {
  Stage stage;
  struct Row {
    const char* name;
    Scene scene;
    double quieter, over, light;  ///< how much less error over time; change against the fine picture's; share of light that may differ
    // Past a texel a pixel the map's levels say how far normals spread, and it is their light that is missing without.
  } rows[] = {{"beads", beads(), 40, 1.5, 0.1}, {"ripples", ripples(), 10, 1.5, 0.1}, {"map, 0.25 texels a pixel", mapped(0.25), 1.4, 1.5, 0.05}, {"map, 1 texel a pixel", mapped(1), 6, 1.5, 0.1},
              {"map, 3 texels a pixel", mapped(3), 2, 4, 0.25}};
  for (const Row& row : rows) {
    std::vector<std::vector<double>> exact, frames[2];
    for (int f = 0; f < kFrames; ++f) {
      // Steps that are no simple part of a pixel, along a slanted line.
      const View view = above(0.171 * f, 0.0917 * f);
      exact.push_back(reduced(stage.linear(row.scene, view, kSize * kFine)));
      for (int on = 0; on < 2; ++on) {
        Quality q;
        q.specularAntialiasing = on ? SpecularAntialiasing::Geometric : SpecularAntialiasing::None;
        const Picture p = stage.linear(row.scene, view, kSize, q);
        std::vector<double>& values = frames[on].emplace_back();
        for (int y = 0; y < kSize.y; ++y)
          for (int x = 0; x < kSize.x; ++x) values.push_back(value(p, x, y));
      }
    }
    const Measured fine = measure(exact, exact), off = measure(frames[0], exact), on = measure(frames[1], exact);
    std::cout << fmt::format("  {:<24}: variance over time {:.4f} fine, {:.4f} without, {:.4f} with; mean square error {:.4f} without, {:.4f} with ({:.1f} times less); light {:.4f} fine, {:.4f}, {:.4f}\n", row.name,
                             fine.change, off.change, on.change, off.error, on.error, off.error / on.error, fine.mean, off.mean, on.mean);
    CHECK(off.error / on.error > row.quieter);
    CHECK(on.change < row.over * fine.change);
    CHECK(std::abs(on.mean / fine.mean - 1) < row.light);
  }
}
