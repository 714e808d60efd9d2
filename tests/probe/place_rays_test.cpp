// Rays against closed forms and against every triangle in double.
#include <catch2/catch.hpp>
#include <random>

#include "reference/rays.h"

using namespace burnish;
using reference::Hit;
using reference::Ray;
using reference::RayScene;
using reference::TriangleMesh;
using glm::dvec3;

namespace {

RayScene sceneOf(const std::vector<TriangleMesh>& meshes) {
  auto made = RayScene::create(meshes);
  if (!made) FAIL(made.error().message());
  return std::move(*made);
}

dvec3 directionOf(std::mt19937_64& random) {
  std::normal_distribution<double> g;
  return glm::normalize(dvec3(g(random), g(random), g(random)));
}

/// Corners of an icosphere's triangles lie on the sphere.
TriangleMesh globe(dvec3 center, double radius, int rings) {
  TriangleMesh m;
  const int columns = 2 * rings;
  for (int r = 0; r <= rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const double t = M_PI * r / rings, p = 2 * M_PI * c / columns;
      m.positions.push_back(center + radius * dvec3(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)));
    }
  for (int r = 0; r < rings; ++r)
    for (int c = 0; c < columns; ++c) {
      const auto at = [&](int row, int column) { return std::uint32_t(row * columns + column % columns); };
      m.indices.insert(m.indices.end(), {at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r, c), at(r + 1, c + 1), at(r + 1, c)});
    }
  return m;
}

TriangleMesh cube(dvec3 low, dvec3 high) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i) m.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  m.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return m;
}

/// Möller and Trumbore 1997, in double; distance, or infinity. `edge`: how near to an edge it passes (barycentric).
double brute(const TriangleMesh& m, std::size_t t, const Ray& ray, double& edge) {
  const dvec3 a = m.positions[m.indices[3 * t]], u = m.positions[m.indices[3 * t + 1]] - a, v = m.positions[m.indices[3 * t + 2]] - a;
  const dvec3 p = glm::cross(ray.direction, v);
  const double det = glm::dot(u, p);
  if (det == 0) return INFINITY;
  const dvec3 s = ray.origin - a, q = glm::cross(s, u);
  const double x = glm::dot(s, p) / det, y = glm::dot(ray.direction, q) / det, d = glm::dot(v, q) / det;
  edge = std::min({x, y, 1 - x - y});
  return edge >= 0 && d >= ray.from && d <= ray.to ? d : INFINITY;
}

}  // namespace

TEST_CASE("rays from inside a closed globe always meet it, at its distance", "[place][rays]") {
  std::mt19937_64 random(11);
  const dvec3 center(1000, -2000, 500);
  const RayScene rays = sceneOf({globe(center, 3, 64)});
  // A chord's sagitta: 3 · (1 - cos(half the angle between neighbours' corners)), the diagonal of a cell of π/64.
  const double sagitta = 3 * (1 - std::cos(M_PI / 64 / std::sqrt(2.0))) + rays.rounding();
  std::vector<Ray> all;
  for (int i = 0; i < 200000; ++i) all.push_back({center, directionOf(random)});
  // Straight at corners and along edges, where rays could slip through.
  const TriangleMesh mesh = globe(center, 3, 64);
  for (std::size_t i = 0; i + 1 < mesh.positions.size(); ++i) {
    all.push_back({center, glm::normalize(mesh.positions[i] - center)});
    all.push_back({center, glm::normalize((mesh.positions[i] + mesh.positions[i + 1]) * 0.5 - center)});
  }
  std::vector<Hit> hits(all.size());
  rays.nearest(all, hits, 2);
  double least = 10, most = 0;
  bool backs = true;
  for (const Hit& h : hits) {
    least = std::min(least, h.distance);
    most = std::max(most, h.distance);
    backs = backs && h.back;
  }
  CHECK(least >= 3 - sagitta);
  CHECK(most <= 3 + rays.rounding());
  CHECK(backs);  // wound outward
}

TEST_CASE("rays meet boxes where slabs say, on the right side", "[place][rays]") {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> spread(-4, 4);
  const dvec3 low(-1, -0.5, -2), high(2, 0.75, 1);
  const RayScene rays = sceneOf({cube(low, high)});
  int met = 0;
  for (int i = 0; i < 100000; ++i) {
    const Ray ray{{spread(random), spread(random), spread(random)}, directionOf(random)};
    const dvec3 a = (low - ray.origin) / ray.direction, b = (high - ray.origin) / ray.direction;
    const dvec3 enter = glm::min(a, b), leave = glm::max(a, b);
    const double in = std::max({enter.x, enter.y, enter.z}), out = std::min({leave.x, leave.y, leave.z});
    if (std::abs(in - out) < 1e-5 || std::abs(out) < 1e-5 || std::abs(in) < 1e-5) continue;  // grazes an edge, or starts on a face
    const Hit hit = rays.nearest(ray);
    const bool should = in < out && out > 0;
    REQUIRE(bool(hit) == should);
    REQUIRE(rays.occluded(ray) == should);
    if (!should) continue;
    ++met;
    REQUIRE(hit.distance == Approx(in > 0 ? in : out).margin(2e-6));
    REQUIRE(hit.back == (in < 0));
    std::vector<Hit> every;
    rays.all(ray, every);
    REQUIRE(every.size() == (in > 0 ? 2u : 1u));
    REQUIRE(every.back().distance == Approx(out).margin(2e-6));
  }
  CHECK(met > 5000);
}

TEST_CASE("rays find the triangle that a search of all of them in double finds", "[place][rays]") {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> spread(-10, 10), size(-1.5, 1.5);
  const dvec3 far(30000, 40, -70000);
  std::vector<TriangleMesh> meshes(3);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    meshes[m].mask = 1u << m;
    meshes[m].twoSided = m == 1;
    for (int t = 0; t < 150; ++t) {
      const dvec3 c = far + dvec3(spread(random), spread(random), spread(random));
      for (int k = 0; k < 3; ++k) {
        meshes[m].indices.push_back(std::uint32_t(meshes[m].positions.size()));
        meshes[m].positions.push_back(c + dvec3(size(random), size(random), size(random)));
      }
    }
  }
  const RayScene rays = sceneOf(meshes);
  int hits = 0, unclear = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray{far + dvec3(spread(random), spread(random), spread(random)), directionOf(random)};
    ray.direction *= 0.5;
    ray.mask = 1u + std::uint32_t(i % 7);
    ray.cull = i % 2 == 0;
    ray.from = i % 5 == 0 ? 3 : 0;
    ray.to = i % 3 == 0 ? 12 : INFINITY;
    double nearest = INFINITY;
    std::uint32_t mesh = Hit::kNone, triangle = Hit::kNone;
    std::size_t count = 0;
    bool close = false;
    for (std::uint32_t m = 0; m < 3; ++m)
      for (std::uint32_t t = 0; t < 150; ++t) {
        if (!(meshes[m].mask & ray.mask)) continue;
        double edge = -1;
        Ray open = ray;
        open.from = ray.from - 1e-4;
        open.to = ray.to + 1e-4;
        const double loose = brute(meshes[m], t, open, edge);
        close = close || std::abs(edge) < 1e-4;  // passes an edge: floats may say either
        const double d = brute(meshes[m], t, ray, edge);
        close = close || (std::isfinite(loose) && !std::isfinite(d));
        if (!std::isfinite(d)) continue;
        const dvec3* p = &meshes[m].positions[std::size_t(3) * t];
        if (ray.cull && !meshes[m].twoSided && glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), ray.direction) > 0) continue;
        ++count;
        if (std::abs(d - nearest) < 1e-4) close = true;
        if (d < nearest) nearest = d, mesh = m, triangle = t;
      }
    if (close) {
      ++unclear;
      continue;
    }
    const Hit hit = rays.nearest(ray);
    REQUIRE(hit.mesh == mesh);
    REQUIRE(hit.triangle == triangle);
    REQUIRE(rays.occluded(ray) == bool(hit));
    std::vector<Hit> all;
    rays.all(ray, all);
    REQUIRE(all.size() == count);
    if (!hit) continue;
    ++hits;
    REQUIRE(hit.distance == Approx(nearest).margin(1e-4));
    REQUIRE(all[0].distance == hit.distance);
  }
  CHECK(hits > 2000);
  CHECK(unclear < 1000);
}

TEST_CASE("the number of threads and a second scene change no hit, also where sheets coincide", "[place][rays]") {
  std::mt19937_64 random(14);
  std::vector<TriangleMesh> meshes;
  for (int m = 0; m < 6; ++m) meshes.push_back(cube(dvec3(-1, -1, -1) * double(1 + m / 2), dvec3(1, 1, 1) * double(1 + m / 2)));  // each twice
  const RayScene a = sceneOf(meshes), b = sceneOf(meshes);
  std::vector<Ray> all;
  for (int i = 0; i < 30000; ++i) all.push_back({directionOf(random) * 5.0, directionOf(random)});
  std::vector<Hit> first(all.size()), second(all.size());
  a.nearest(all, first, 1);
  b.nearest(all, second, 5);
  bool same = true;
  for (std::size_t i = 0; i < all.size(); ++i) same = same && first[i].mesh == second[i].mesh && first[i].triangle == second[i].triangle && (first[i].distance == second[i].distance || !first[i]);
  CHECK(same);
}

TEST_CASE("broken geometry and broken rays hit nothing", "[place][rays]") {
  TriangleMesh m = cube(dvec3(-1), dvec3(1));
  m.positions[0].x = std::nan("");
  m.positions[1].y = INFINITY;
  m.indices.insert(m.indices.end(), {1, 2, 99, 1});
  const RayScene rays = sceneOf({m, {}});
  CHECK(rays.triangles() < 12);
  CHECK(rays.triangles() > 0);
  for (const Ray& r : {Ray{{NAN, 0, 0}, {0, 0, 1}}, Ray{{0, 0, 0}, {0, 0, 0}}, Ray{{0, 0, 0}, {0, INFINITY, 1}}, Ray{{0, 0, 0}, {0, 0, 1}, 5, 4}}) {
    CHECK_FALSE(rays.nearest(r));
    CHECK_FALSE(rays.occluded(r));
  }
  std::vector<Hit> hits(3);
  for (const dvec3 d : {dvec3(1, 0.1, 0.2), dvec3(-0.2, 1, 0.1)}) {
    const Hit hit = rays.nearest({dvec3(0), d});
    if (hit) CHECK(std::isfinite(hit.distance));
  }
  const RayScene none = sceneOf({});
  CHECK_FALSE(none.nearest({dvec3(0), dvec3(1, 0, 0)}));
  CHECK(none.triangles() == 0);
  CHECK(none.rounding() == 0);
}

TEST_CASE("points see each other unless something is between them", "[place][rays]") {
  const RayScene rays = sceneOf({cube(dvec3(-1), dvec3(1))});
  CHECK(rays.occluded(dvec3(-3, 0, 0), dvec3(3, 0, 0)));
  CHECK(rays.occluded(dvec3(-3, 0, 0), dvec3(-0.5, 0, 0)));
  CHECK_FALSE(rays.occluded(dvec3(-3, 0, 0), dvec3(-1.01, 0, 0)));
  CHECK_FALSE(rays.occluded(dvec3(-3, 0, 0), dvec3(-1, 0, 0), 0.01));  // the surface itself
  CHECK_FALSE(rays.occluded(dvec3(-3, 0, 0), dvec3(-3, 3, 0)));
  CHECK_FALSE(rays.occluded(dvec3(-3, 0, 0), dvec3(3, 0, 0), 0, 2));
}
