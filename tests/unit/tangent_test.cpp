// Tangents by the MikkTSpace rules.
#include <burnish/scene.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/tangents.h"

using namespace burnish;

namespace {

/// A quad in the xy plane facing +z; the texture's top is up (v runs down, as in glTF).
Mesh quad(bool mirrored = false, float x0 = 0) {
  Mesh m;
  m.positions = {{x0, 0, 0}, {x0 + 1, 0, 0}, {x0 + 1, 1, 0}, {x0, 1, 0}};
  m.normals.assign(4, {0, 0, 1});
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  if (mirrored)
    for (glm::vec2& uv : m.uv0) uv.x = 1 - uv.x;
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}

void append(Mesh& a, const Mesh& b) {
  const std::uint32_t base = std::uint32_t(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  a.normals.insert(a.normals.end(), b.normals.begin(), b.normals.end());
  a.uv0.insert(a.uv0.end(), b.uv0.begin(), b.uv0.end());
  for (const std::uint32_t i : b.indices) a.indices.push_back(base + i);
}

void checkFrames(const Mesh& m) {
  REQUIRE(m.tangents.size() == m.positions.size());
  REQUIRE(m.normals.size() == m.positions.size());
  for (std::size_t i = 0; i < m.tangents.size(); ++i) {
    const glm::vec3 t(m.tangents[i]);
    REQUIRE(glm::length(t) == Approx(1).margin(1e-4));
    REQUIRE(std::abs(m.tangents[i].w) == 1);
    REQUIRE(std::abs(glm::dot(t, m.normals[i])) < 1e-3f);
  }
}

/// A unit sphere with u around and v from the north pole down; `seam` vertices doubled as exporters do.
Mesh sphere(int rings, int segments) {
  Mesh m;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s <= segments; ++s) {
      const float theta = float(M_PI) * float(r) / float(rings),
                  phi = 2 * float(M_PI) * float(s % segments) / float(segments);
      const glm::vec3 p(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
      m.positions.push_back(p);
      m.normals.push_back(p);
      m.uv0.push_back({float(s) / float(segments), float(r) / float(rings)});
    }
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t a = std::uint32_t(r * (segments + 1) + s), b = a + std::uint32_t(segments) + 1;
      for (const std::uint32_t i : {a, b, b + 1, a, b + 1, a + 1}) m.indices.push_back(i);
    }
  return m;
}

}  // namespace

TEST_CASE("A quad's tangent follows u, its bitangent points up the texture", "[tangent]") {
  Mesh m = quad();
  makeTangents(m);
  checkFrames(m);
  REQUIRE(m.positions.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(m.tangents[i].x == Approx(1));
    const glm::vec3 bitangent = m.tangents[i].w * glm::cross(m.normals[i], glm::vec3(m.tangents[i]));
    CHECK(bitangent.y == Approx(1));
  }
}

TEST_CASE("Mirrored texture coordinates keep their handedness and are never mixed", "[tangent]") {
  // A butterfly: two quads that meet at x = 1 with the same position, normal and uv on the shared edge, the second one
  // mirrored.
  Mesh m = quad();
  append(m, quad(true, 1));
  m.indices = {0, 1, 2, 0, 2, 3, 1, 5, 6, 1, 6, 2};  // welded: the shared vertices have uv x = 1 in both
  makeTangents(m);
  checkFrames(m);
  CHECK(m.positions.size() == 10);  // the two shared vertices were split (4 and 7 are unused)
  for (std::size_t i = 0; i < m.indices.size(); ++i) {
    const std::size_t v = m.indices[i];
    const bool mirrored = i >= 6;
    CHECK(m.tangents[v].x == Approx(mirrored ? -1 : 1));
    const glm::vec3 bitangent = m.tangents[v].w * glm::cross(m.normals[v], glm::vec3(m.tangents[v]));
    CHECK(bitangent.y == Approx(1));
  }
}

TEST_CASE("Vertices doubled by an exporter are smoothed as one", "[tangent]") {
  Mesh welded = sphere(12, 24), doubled = welded;
  Mesh loose;
  for (const std::uint32_t i : doubled.indices) {
    loose.positions.push_back(doubled.positions[i]);
    loose.normals.push_back(doubled.normals[i]);
    loose.uv0.push_back(doubled.uv0[i]);
    loose.indices.push_back(std::uint32_t(loose.indices.size()));
  }
  makeTangents(welded);
  makeTangents(loose);
  for (std::size_t c = 0; c < loose.indices.size(); ++c) {
    const glm::vec4 a = welded.tangents[welded.indices[c]], b = loose.tangents[loose.indices[c]];
    REQUIRE(glm::length(glm::vec3(a) - glm::vec3(b)) < 1e-5f);
    REQUIRE(a.w == b.w);
  }
}

TEST_CASE("A sphere's tangents run around it", "[tangent]") {
  Mesh m = sphere(32, 64);
  makeTangents(m);
  checkFrames(m);
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    const glm::vec3 p = m.positions[i];
    if (std::abs(p.y) > 0.95f) continue;
    const glm::vec3 around = glm::normalize(glm::vec3(p.z, 0, -p.x));
    CHECK(glm::dot(around, glm::vec3(m.tangents[i])) > 0.998f);
    CHECK((m.tangents[i].w * glm::cross(m.normals[i], glm::vec3(m.tangents[i]))).y > 0);
  }
}

TEST_CASE("Angles weigh tangents, not triangle counts", "[tangent]") {
  // A fan around the origin: the half x > 0 is one big triangle pair, the half x < 0 many slivers, with shear that
  // differs between the halves.
  Mesh m;
  m.positions.push_back({0, 0, 0});
  m.uv0.push_back({0, 0});
  constexpr int kLeft = 40;
  std::vector<float> angles = {-90, 0, 90};
  for (int i = 1; i <= kLeft; ++i) angles.push_back(90 + 180 * float(i) / kLeft);
  for (const float degrees : angles) {
    const float a = glm::radians(degrees), x = std::cos(a), y = std::sin(a);
    m.positions.push_back({x, y, 0});
    m.uv0.push_back(x < -1e-6f ? glm::vec2(x + 0.5f * y, -y)
                               : glm::vec2(x, -y));  // left: dP/du still +x after the shear, dP/dv differs
  }
  m.normals.assign(m.positions.size(), {0, 0, 1});
  for (std::uint32_t i = 1; i + 1 < m.positions.size(); ++i) {
    m.indices.push_back(0);
    m.indices.push_back(i);
    m.indices.push_back(i + 1);
  }
  makeTangents(m);
  checkFrames(m);
  // By hand: the angle-weighted mean of the faces' own dP/du.
  glm::vec3 expected(0);
  for (std::size_t t = 0; t < m.indices.size(); t += 3) {
    const glm::vec3 d1 = m.positions[m.indices[t + 1]], d2 = m.positions[m.indices[t + 2]];
    const glm::vec2 u1 = m.uv0[m.indices[t + 1]], u2 = m.uv0[m.indices[t + 2]];
    const float area = u1.x * u2.y - u1.y * u2.x;
    expected += std::acos(glm::dot(glm::normalize(d1), glm::normalize(d2))) *
                glm::normalize((u2.y * d1 - u1.y * d2) * (area < 0 ? -1.0f : 1.0f));
  }
  expected = glm::normalize(expected);
  CHECK(glm::dot(expected, glm::vec3(m.tangents[m.indices[0]])) > 0.99999f);
}

TEST_CASE("Degenerate texture coordinates and triangles give finite frames", "[tangent]") {
  Mesh all = quad();
  for (glm::vec2& uv : all.uv0) uv = {0.5f, 0.5f};
  makeTangents(all);
  checkFrames(all);

  Mesh part = quad();
  append(part, quad(false, 1));
  for (std::size_t i = 4; i < 8; ++i) part.uv0[i] = {1, part.uv0[i].y};  // a line in the texture
  part.indices = {0, 1, 2, 0, 2, 3, 1, 5, 6, 1, 6, 2};
  makeTangents(part);
  checkFrames(part);
  CHECK(part.tangents[1].x == Approx(1));  // the degenerate neighbour joins the group: nothing is split
  CHECK(part.positions.size() == 8);

  std::mt19937 rng(5);
  Mesh soup;
  for (int i = 0; i < 300; ++i) {
    const auto coordinate = [&rng] { return float(rng() % 4) - 1.5f; };
    soup.positions.push_back({coordinate(), coordinate(), coordinate()});
    soup.normals.push_back(glm::normalize(glm::vec3(coordinate(), coordinate(), coordinate())));
    soup.uv0.push_back({coordinate(), coordinate()});
  }
  for (int i = 0; i < 3000; ++i) soup.indices.push_back(rng() % 300);
  makeTangents(soup);
  checkFrames(soup);
}

TEST_CASE("A rotated texture turns the tangent", "[tangent]") {
  Mesh m = quad();
  UvMapping mapping;
  mapping.transform = {0, -1, 1, 0, 0, 0};  // u' = v, v' = -u
  scene::makeTangents(m, mapping);
  checkFrames(m);
  CHECK(m.tangents[0].y == Approx(-1));  // u' grows with v, which runs down
}

TEST_CASE("Meshes that cannot have tangents are left alone", "[tangent]") {
  Mesh m = quad();
  m.uv0.clear();
  makeTangents(m);
  CHECK(m.tangents.empty());
  m = quad();
  m.indices[0] = 99;
  makeTangents(m);
  CHECK(m.tangents.empty());
  Mesh none;
  makeTangents(none);
  CHECK(none.tangents.empty());
}
