// What points see: distances against closed forms, free points, visible instances against a search of all triangles.
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "place_scenes.h"
#include "probe/visibility.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Material material(bool twoSided = false) {
  Material m;
  m.twoSided = twoSided;
  return m;
}

std::set<std::uint32_t> indicesOf(const std::vector<Id<Instance>>& ids) {
  std::set<std::uint32_t> out;
  for (const Id<Instance> id : ids) out.insert(id.index);
  return out;
}

/// A room of one-sided walls with a solid crate, a glass pane, a grille, a mirrored post, a morphed ball and a hidden thing.
Scene furnished(dvec3 origin) {
  Scene s;
  place(s, box({-3, 0, -4}, {3, 2.5f, 4}, true), material(), translation(origin));
  place(s, box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), material(), translation(origin) * turned(30, {1.5, 0.5, 1}));
  Material glass = material(true);
  glass.transmission = 1;
  place(s, quad({0, 1.2f, -2}, {1, 0, 0}, {0, 0.8f, 0}), glass, translation(origin));
  Material grille = material(true);
  grille.alphaTest = true;
  place(s, quad({-2, 1, 0}, {0, 0, 1}, {0, 1, 0}), grille, translation(origin));
  glm::dmat4 mirror = translation(origin + dvec3(-1.5, 0, 2));
  mirror[0][0] = -1;
  place(s, box({-0.2f, 0, -0.2f}, {0.2f, 2, 0.2f}), material(), mirror);
  Mesh ball = sphere(0.3f, 12, 24);
  ball.targets.push_back({"up", std::vector<vec3>(ball.positions.size(), vec3(0, 1, 0)), {}, {}});
  const Id<Instance> morphed = place(s, ball, material(), translation(origin + dvec3(0.5, 0.6, -3)));
  s.instances.edit(morphed)->morphWeights = {0.9f};
  s.instances.edit(place(s, box({-1, 0, -1}, {1, 1, 1}), material(), translation(origin)))->visible = false;
  return s;
}

}  // namespace

TEST_CASE("distances of a point in a box are those of its walls", "[place][visibility]") {
  Scene s;
  const dvec3 low(-1, -0.75, -0.5), high(1.5, 0.5, 0.75), point(0.2, -0.1, 0.05), spacing(0.5);
  place(s, box(vec3(low), vec3(high), true), material());
  const AmbientGrid::Point seen = probe::lookAround(geometryOf(s), point, spacing);
  CHECK(seen.valid);
  REQUIRE(seen.distances.size() == 256);
  const double limit = 1.5 * std::sqrt(0.75);
  int held = 0;
  double worstMean = 0, worstSquare = 0;
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      // Over the texel, finely: the closed form's distance at 32 x 32 places. Sixteen rays stand for them.
      double sum = 0, squares = 0, least = 10, most = 0;
      for (int i = 0; i < 1024; ++i) {
        const dvec3 d = shading::f64::distanceDirection(x + (i % 32 + 0.5) / 32, y + (i / 32 + 0.5) / 32, 16);
        const dvec3 to = glm::max((low - point) / d, (high - point) / d);
        const double t = std::min(std::min({to.x, to.y, to.z}), limit);
        sum += t;
        squares += t * t;
        least = std::min(least, t);
        most = std::max(most, t);
      }
      const glm::vec2 got = seen.distances[std::size_t(y * 16 + x)];
      held += double(got.x) > limit - 1e-6;
      REQUIRE(got.x >= float(least) - 1e-5f);
      REQUIRE(got.x <= float(most) + 1e-5f);
      REQUIRE(got.y >= got.x * got.x * (1 - 1e-5f));
      // Middles of sixteenths against the mean over the texel: no sixteenth errs by more than half of what the distance runs over it, which is about a quarter of the texel's.
      worstMean = std::max(worstMean, std::abs(double(got.x) - sum / 1024) / (most - least + 1e-6));
      worstSquare = std::max(worstSquare, std::abs(double(got.y) - squares / 1024) / (most * most - least * least + 1e-6));
    }
  CHECK(held > 0);
  CHECK(held < 200);
  CHECK(worstMean < 0.125);
  CHECK(worstSquare < 0.125);
}

TEST_CASE("the lattice's points: in the room, in the crate, in the wall, touching", "[place][visibility]") {
  const dvec3 origin(5000, 20, -8000);
  const Scene s = furnished(origin);
  const probe::Geometry g = geometryOf(s);
  CHECK(probe::isFree(g, origin + dvec3(0, 1.2, 0)));
  CHECK_FALSE(probe::isFree(g, origin + dvec3(1.5, 0.5, 1)));   // in the crate
  CHECK_FALSE(probe::isFree(g, origin + dvec3(-1.5, 1, 2)));    // in the mirrored post
  CHECK_FALSE(probe::isFree(g, origin + dvec3(0, 3, 0)));       // above the ceiling: nothing but backs
  CHECK_FALSE(probe::isFree(g, origin + dvec3(0.5, 1.5, -3)));  // in the ball where its morph target takes it
  CHECK(probe::isFree(g, origin + dvec3(0.5, 0.6, -3)));        // and where it was
  CHECK_FALSE(probe::isFree(g, origin + dvec3(2.98, 1.2, 0)));  // 2 cm from a wall
  CHECK(probe::isFree(g, origin + dvec3(2.9, 1.2, 0)));
  CHECK(probe::isFree(g, origin + dvec3(0, 1.2, -2.01)));       // beside the glass
  CHECK(probe::isFree(g, origin + dvec3(0, 1, 0)));             // in the hidden box
}

TEST_CASE("inside a body that another one sticks in, and under one that stands on the floor", "[place][visibility]") {
  Scene s;
  place(s, box({-4, 0, -4}, {4, 3, 4}, true), material());
  Mesh both = box({-1, 0, -1}, {1, 1, 1});
  const Mesh post = box({-0.2f, -0.5f, -0.2f}, {0.2f, 2, 0.2f});
  for (const std::uint32_t i : post.indices) both.indices.push_back(i + std::uint32_t(both.positions.size()));
  both.positions.insert(both.positions.end(), post.positions.begin(), post.positions.end());
  both.normals.insert(both.normals.end(), post.normals.begin(), post.normals.end());
  both.uv0.clear();
  place(s, both, material());
  const probe::Geometry g = geometryOf(s);
  CHECK_FALSE(probe::isFree(g, {0.27, 0.5, 0}, 0.01));  // half of what it sees is the post's front
  CHECK_FALSE(probe::isFree(g, {0.6, 0.02, 0.6}, 0.01)); // half of what it sees is the floor, on which the body stands
  CHECK(probe::isFree(g, {1.1, 0.5, 0}, 0.01));
  CHECK(probe::isFree(g, {0.27, 1.5, 0}, 0.01));
}

TEST_CASE("a crack is no free point, a gap is", "[place][visibility]") {
  Scene s;
  place(s, box({-4, 0, -4}, {4, 3, 4}, true), material());
  place(s, box({-1, 0.04f, -1}, {1, 1, 1}), material());
  place(s, box({-1, 1.06f, -1}, {1, 1.5f, 1}), material());
  const probe::Geometry g = geometryOf(s);
  CHECK_FALSE(probe::isFree(g, {0, 0.02, 0}, 0.01));
  CHECK(probe::isFree(g, {0, 1.03, 0}, 0.01));
}

TEST_CASE("a wall of two sheets back to back is seen from its front on both sides", "[place][visibility]") {
  Scene s;
  place(s, box({-2, 0, -2}, {2, 3, 2}, true), material());
  place(s, box({-2, 0, -2}, {2, 3, 2}, false), material());  // the same walls from outside
  place(s, box({-20, -20, -20}, {20, 20, 20}, true), material());
  const probe::Geometry g = geometryOf(s);
  CHECK(probe::isFree(g, {0, 1, 0}));
  CHECK(probe::isFree(g, {5, 1, 0}));
  // A hull around the rooms, a body of its own, is not what the rooms are inside of.
  place(s, box({-2.2f, -0.2f, -2.2f}, {2.2f, 3.2f, 2.2f}, false), material());
  const probe::Geometry hull = geometryOf(s);
  CHECK(probe::isFree(hull, {0, 1, 0}));
  CHECK(probe::isFree(hull, {1.8, 0.2, -1.8}));
  CHECK_FALSE(probe::isFree(hull, {2.1, 1, 0}));
}

TEST_CASE("a lattice is filled the same way by any number of threads", "[place][visibility]") {
  const Scene s = furnished(dvec3(0));
  const probe::Geometry g = geometryOf(s);
  AmbientGrid one;
  one.origin = {-3.5, 0.25, -4.5};
  one.spacing = {1.0, 0.5, 1.5};
  one.counts = {8, 6, 7};
  AmbientGrid many = one;
  std::vector<double> shares;
  REQUIRE(probe::fillPoints(g, one, 1, [&](double share) { shares.push_back(share); }));
  REQUIRE(probe::fillPoints(g, many, 7));
  REQUIRE(one.points.size() == 8 * 6 * 7);
  bool same = true;
  int valid = 0;
  const Solids solids(s);
  for (int z = 0; z < 7; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        const std::size_t i = std::size_t(x + 8 * (y + 6 * z));
        same = same && one.points[i].valid == many.points[i].valid && one.points[i].distances == many.points[i].distances;
        valid += one.points[i].valid;
        const dvec3 p = one.position({x, y, z});
        const bool inRoom = glm::all(glm::lessThan(glm::abs(p - dvec3(0, 1.25, 0)), dvec3(3, 1.25, 4)));
        INFO(p.x << " " << p.y << " " << p.z);
        CHECK(one.points[i].valid == (inRoom && !solids.hold(p)));
      }
  CHECK(same);
  CHECK(valid > 140);
  CHECK(valid < 150);  // 6 · 5 · 5 are in the room, a few of them in the furniture
  REQUIRE(shares.size() >= 2);
  CHECK(shares.front() == 0);
  CHECK(shares.back() == 1);
  CHECK(std::is_sorted(shares.begin(), shares.end()));
}

TEST_CASE("lattices that are none, or too large, are errors", "[place][visibility]") {
  const Scene s = furnished(dvec3(0));
  const probe::Geometry g = geometryOf(s);
  AmbientGrid grid;
  grid.name = "bad";
  grid.counts = {4, 0, 4};
  CHECK_FALSE(probe::fillPoints(g, grid, 1));
  grid.counts = {4, 4, 4};
  grid.spacing = {1, -1, 1};
  CHECK_FALSE(probe::fillPoints(g, grid, 1));
  grid.spacing = {1, NAN, 1};
  CHECK_FALSE(probe::fillPoints(g, grid, 1));
  grid.spacing = dvec3(1);
  grid.counts = glm::ivec3(100000);
  const auto large = probe::fillPoints(g, grid, 1);
  REQUIRE_FALSE(large);
  CHECK(large.error().message().find("bad") != std::string::npos);
}

TEST_CASE("visible instances are what a search of all triangles finds on the pixels' rays", "[place][visibility]") {
  const int size = GENERATE(1, 7, 16);
  const dvec3 origin(-300, 4, 900);
  const Scene s = furnished(origin);
  const probe::Geometry g = geometryOf(s);
  const std::vector<Facet> facets = facetsOf(s);
  std::mt19937_64 random(std::uint64_t(21 + size));
  std::uniform_real_distribution<double> x(-2.9, 2.9), y(0.1, 2.4), z(-3.9, 3.9);
  for (int n = 0; n < 12; ++n) {
    const dvec3 point = origin + dvec3(x(random), y(random), z(random));
    std::set<std::uint32_t> expected;
    for (int face = 0; face < 6; ++face)
      for (int i = 0; i < size * size; ++i) {
        dvec3 d(0);
        const double a = (2 * (i % size) + 1.0) / size - 1, b = (2 * (i / size) + 1.0) / size - 1;
        const int axis = face / 2;
        d[axis] = face % 2 ? -1 : 1;
        d[(axis + 1) % 3] = a;
        d[(axis + 2) % 3] = b;
        double nearest = INFINITY;
        for (const Facet& f : facets)
          if (f.opaque && (f.twoSided || !seenFromBehind(f, d))) nearest = std::min(nearest, meets(f, point, d));
        for (const Facet& f : facets)
          if (const double t = meets(f, point, d); std::isfinite(t) && (f.twoSided || !seenFromBehind(f, d)) && (f.opaque ? t == nearest : t < nearest)) expected.insert(f.instance.index);
      }
    CHECK(indicesOf(probe::visibleInstances(g, point, size)) == expected);
  }
}

TEST_CASE("visible instances: behind glass yes, behind a wall no, in order", "[place][visibility]") {
  Scene s;
  place(s, box({-1, -1, -1}, {1, 1, 1}), material(), translation({0, 0, -12}));  // 0: behind the wall
  place(s, quad({0, 0, -8}, {9, 0, 0}, {0, 9, 0}), material());                  // 1: the wall
  Material blended = material();
  blended.blend = true;
  place(s, quad({0, 0, -4}, {2, 0, 0}, {0, 2, 0}), blended);                      // 2: a pane before it
  place(s, quad({0, 0, -3}, {2, 0, 0}, {0, -2, 0}), material());                  // 3: faces away
  const std::vector<Id<Instance>> seen = probe::visibleInstances(geometryOf(s), dvec3(0), 8);
  REQUIRE(seen.size() == 2);
  CHECK(seen[0].index == 1);
  CHECK(seen[1].index == 2);
}

TEST_CASE("a skinned arm stands where its joints are", "[place][visibility]") {
  Arm arm(4, {100, 0, -50});
  arm.scene.nodes.edit(arm.joints[1])->local[3].y += 3;
  const probe::Geometry g = geometryOf(arm.scene);
  const std::vector<Facet> facets = facetsOf(arm.scene);
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> spread(-1, 1);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    const dvec3 from = dvec3(101.5, 1.5, -50) + dvec3(spread(random) * 4, spread(random) * 4, 6), to = dvec3(101.5, 1.5, -50) + dvec3(spread(random) * 3, spread(random) * 3, 0), d = glm::normalize(to - from);
    double nearest = INFINITY;
    for (const Facet& f : facets) nearest = std::min(nearest, meets(f, from, d));
    const reference::Hit hit = g.rays.nearest({from, d});
    if (!hit || !std::isfinite(nearest)) continue;
    ++met;
    CHECK(hit.distance == Approx(nearest).margin(1e-3));
  }
  CHECK(met > 100);
}

TEST_CASE("the share of sky", "[place][visibility]") {
  Scene s;
  CHECK(probe::skyShare(geometryOf(s), dvec3(0)) == 1);
  place(s, quad({0, -1, 0}, {1e5f, 0, 0}, {0, 0, -1e5f}), material());
  CHECK(probe::skyShare(geometryOf(s), dvec3(0)) == Approx(0.5).margin(1.0 / 64));
  place(s, box({-1, -1, -1}, {1, 1, 1}, true), material());
  CHECK(probe::skyShare(geometryOf(s), dvec3(0)) == 0);
}
