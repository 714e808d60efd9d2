// H19: a highlight on a smooth curved surface through the quantised G-buffer, against the double oracle with the exact normals of every pixel. What the G-buffer does to it: the
// normal's rounding spreads it (taken off the stored alpha), the roughness code shifts its width by up to 1.6 % and its peak by 3.2 %.
// GGX at roughness 1 has no highlight: its fit is flat.
#include <fmt/format.h>

#include <iostream>

#include "plan/rungs.h"
#include "reference/oracle.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{192, 192};

/// The unit sphere's cap around `axis`: a grid over [-extent, extent]² on the plane that touches it there.
Mesh cap(const glm::dmat3& frame, double extent) {
  constexpr std::uint32_t kCells = 96;
  Mesh m;
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double x = extent * (2.0 * i / kCells - 1), y = extent * (2.0 * j / kCells - 1);
      const dvec3 n = glm::normalize(frame * dvec3(x, y, std::sqrt(std::max(1 - x * x - y * y, 0.0))));
      m.positions.emplace_back(n);
      m.normals.emplace_back(n);
      m.uv0.emplace_back(0);
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
      m.indices.insert(m.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return m;
}

/// Right, up, and the axis that the cap looks along.
glm::dmat3 frameOf(dvec3 axis) {
  const dvec3 z = glm::normalize(axis), x = glm::normalize(glm::cross(dvec3(0.1, 1, 0.2), z));
  return {x, glm::cross(z, x), z};
}

struct Highlight {
  double peak = 0, width = 0;  ///< of the fit: radiance at the lobe's axis, angle at half of it (radians)
  double mean = 0;             ///< mean over the pixels where the oracle gives more than half of its peak
};

/// Least squares of log L = log peak - tan²(angle) s over the pixels where the oracle gives at least a quarter of its peak, weighted by L² (errors are shares of L). The same pixels
/// and weights for both pictures.
Highlight fit(const std::vector<double>& tan2, const std::vector<double>& radiance, const std::vector<double>& oracle) {
  const double top = *std::max_element(oracle.begin(), oracle.end());
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, sum = 0, count = 0;
  for (std::size_t i = 0; i < tan2.size(); ++i) {
    if (oracle[i] > 0.5 * top) sum += radiance[i], count += 1;
    if (oracle[i] < 0.25 * top) continue;
    const double y = std::log(std::max(radiance[i], 1e-9)), w = oracle[i] * oracle[i];
    n += w, sx += w * tan2[i], sy += w * y, sxx += w * tan2[i] * tan2[i], sxy += w * tan2[i] * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx), at0 = (sy - slope * sx) / n;
  return {std::exp(at0), std::atan(std::sqrt(std::log(2.0) / std::max(-slope, 1e-9))), sum / count};
}

struct Pair {
  Highlight drawn, oracle;
};

Pair measure(Stage& stage, const Quality& quality, double roughness, dvec3 axis, dvec3 lightOffset) {
  const glm::dmat3 frame = frameOf(axis);
  const double alpha = roughness * roughness;
  // Three half-widths to each side; no wider than the sphere is.
  const double extent = std::min(3 * 0.83 * alpha, 0.68);
  Scene scene;
  Material m;
  m.albedo = {0.95f, 0.64f, 0.54f};
  m.substance = 1;
  m.roughness = float(roughness);
  place(scene, cap(frame, extent * 1.04), m);
  // Light and eye are mirrored at the cap's axis: it is the half vector.
  const dvec3 toLight = frame * glm::normalize(lightOffset), toEye = frame * glm::normalize(lightOffset * dvec3(-1, -1, 1));
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, -toLight);
  View view = lookAt(frame[2] + toEye * 3.0, frame[2], frame[1]);
  view.orthographic = true;
  view.height = float(2 * extent);
  view.far = 8;
  const Picture p = stage.linear(scene, view, kSize, quality);
  const shading::Rungs rungs = plan::rungsOf(quality);
  const reference::OracleLight sun{toLight, dvec3(100.0)};
  std::vector<double> tan2, drawn, oracle;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Ray r = rayThrough(view, kSize, x + 0.5, y + 0.5);
      const double b = glm::dot(r.origin, r.direction), d = b * b - glm::dot(r.origin, r.origin) + 1;
      if (d <= 0) continue;
      const dvec3 n = r.origin + r.direction * (-b - std::sqrt(d)), local = glm::transpose(frame) * n;
      if (std::abs(local.x) > extent || std::abs(local.y) > extent) continue;
      tan2.push_back((local.x * local.x + local.y * local.y) / (local.z * local.z));
      drawn.push_back(p.at(x, y).x);
      oracle.push_back(reference::shade({n, toEye, dvec3(m.albedo), 1, alpha}, {&sun, 1}, rungs).x);
    }
  REQUIRE(tan2.size() > 10000);
  return {fit(tan2, drawn, oracle), fit(tan2, oracle, oracle)};
}

}  // namespace

TEST_CASE("highlights through the quantised G-buffer: peak within 5 %, half-width within 4 %") {
  Stage stage;
  Quality ggx;
  ggx.specular = Specular::GgxSmith;
  // The octahedron's axis, face and seam, and the worst of 60 directions at random.
  const dvec3 axes[] = {{0, 0, 1}, {1, 1, 1}, {-0.62, 0.1, -0.77}, {1, 0, 1}, {0.3, 0.8, 0.52}, {-0.519, -0.339, 0.501}, {0.595, 0.513, 0.232}, {-0.548, 0.919, -0.918}};
  for (const auto& [name, quality] : {std::pair("default", Quality{}), std::pair("ggx-smith", ggx)})
    for (double roughness : {0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0}) {
      double peak = 0, width = 0, mean = 0, degrees = 0;
      for (const dvec3& axis : axes)
        for (const dvec3& offset : {dvec3(0, 0, 1), dvec3(0.5, 0.2, 1)}) {
          const Pair q = measure(stage, quality, roughness, axis, offset);
          const auto worse = [](double& worst, double got, double wanted) { worst = std::abs(got / wanted - 1) > std::abs(worst) ? got / wanted - 1 : worst; };
          worse(peak, q.drawn.peak, q.oracle.peak);
          worse(width, q.drawn.width, q.oracle.width);
          worse(mean, q.drawn.mean, q.oracle.mean);
          degrees = glm::degrees(q.oracle.width);
        }
      std::cout << fmt::format("  {:<9} roughness {:<4}: half-width {:7.3f} degrees, off by {:+.2f} %; peak off by {:+.2f} %, mean of the upper half by {:+.2f} %\n", name, roughness, degrees, 100 * width, 100 * peak,
                               100 * mean);
      CHECK(std::abs(peak) < 0.05);
      CHECK(std::abs(mean) < 0.05);
      CHECK(std::abs(width) < 0.04);
    }
}
