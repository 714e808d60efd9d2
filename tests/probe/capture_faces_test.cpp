// What captures hold: every face where OpenGL has it, the surroundings' radiance, nothing that is not finite.
#include <array>

#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;

TEST_CASE("capture: an empty scene shows its surroundings, on every face the right way round") {
  // Grows along each axis in another channel: a face that is mirrored, turned or exchanged is off by far more than the bound.
  const auto sky = [](const dvec3& d) { return dvec3(2) + dvec3(1.5, 1, 0.5) * d; };
  Scene scene;
  scene.environment.map = latLong(256, sky);
  scene.environment.background = false;  // shown or not, it lights
  Observatory o(std::move(scene));
  // Of a cosine between texels of h = π/128 rad, linear in both directions: 1.5 · 2 · h²/8; half floats up to 4: 2⁻⁹ (their step, and some chips cut off what is under it); filter weights of 8 bits: h/256.
  const double h = kPi / 128, bound = 1.5 * h * h / 4 + std::exp2(-9) + 1.5 * h / 256;
  for (const int size : {16, 37}) {
    double worst = 0;
    eachTexel(o.radiance({7, -3, 2}, size), [&](int, int, int, const dvec3& d, const dvec3& l) {
      const dvec3 off = glm::abs(l - sky(d));
      // The picture's first row is h/2 from the pole, which it has no texel for.
      const double pole = std::hypot(d.x, d.z) < h ? 1.5 * h / 2 : 0;
      worst = std::max(worst, std::max({off.x, off.y, off.z}) - pole);
    });
    std::cout << fmt::format("  surroundings on faces of {}: off by {:.2g} at most, bound {:.2g}\n", size, worst, bound);
    CHECK(worst < bound);
  }
  CHECK(o.capture->report().empty());
}

TEST_CASE("capture: the surroundings' range survives") {
  Scene scene;
  scene.environment.map = latLong(64, [](const dvec3& d) { return d.y > 0 ? dvec3(5e4, 1, 1e-4) : dvec3(0); });
  scene.environment.scale = 2;
  Observatory o(std::move(scene));
  const CubeLevel level = o.radiance({0, 0, 0}, 16);
  const dvec3 up = texel(level, 2, 8, 8), down = texel(level, 3, 8, 8);
  CHECK(up.x == Approx(1e5).epsilon(1e-3));
  CHECK(up.y == Approx(2).epsilon(1e-3));
  CHECK(up.z == Approx(2e-4).epsilon(1e-3));
  CHECK(down == dvec3(0));
}

TEST_CASE("capture: the sun's disc is a light's, and no part of what is captured") {
  Scene scene;
  scene.environment.color = vec3(1);
  scene.environment.sun = Environment::Sun{.toSun = {0, 1, 0}, .radiance = vec3(1e6f), .radius = 0.2f};
  Observatory o(std::move(scene));
  eachTexel(o.radiance({0, 0, 0}, 16), [](int, int, int, const dvec3&, const dvec3& l) { CHECK(l == dvec3(1)); });
}

TEST_CASE("capture: the walls of a room are where rays meet them") {
  const vec3 low(-2, -1, -3), high(4, 3, 1.5f);
  std::array<Material, 6> walls;
  for (int w = 0; w < 6; ++w) {
    walls[std::size_t(w)].albedo = vec3(0);
    walls[std::size_t(w)].emission = vec3(float(w + 1), float(10 * (w + 1)), 1);
  }
  Scene scene;
  addRoom(scene, low, high, walls);
  Quality q;
  q.environmentSpecular = EnvironmentSpecular::None;
  Observatory o(std::move(scene), q);
  // Off the middle: each face shows several walls, and their edges lie elsewhere along each of its axes. One point is a hundredth of a millimetre from a wall, nearer than any camera's plane.
  constexpr int kSize = 32;
  for (const dvec3 eye : {dvec3(1.3, 0.2, -1), dvec3(-1.5, 2.4, 1), dvec3(3.9, -0.8, -2.7), dvec3(4 - 2e-4, 1, 0)}) {
    int wrong = 0, edges = 0;
    eachTexel(o.radiance(eye, kSize), [&](int, int, int, const dvec3& d, const dvec3& l) {
      // Distance to each wall, and how far the second one is.
      double first = 1e30, second = 1e30;
      int wall = 0;
      for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0) continue;
        const double t = ((d[axis] > 0 ? double(high[axis]) : double(low[axis])) - eye[axis]) / d[axis];
        if (t < first) second = first, first = t, wall = 2 * axis + (d[axis] > 0);
        else second = std::min(second, t);
      }
      if (second < first * 1.0001) {
        ++edges;
        return;
      }
      wrong += l != dvec3(wall + 1, 10 * (wall + 1), 1);
    });
    CHECK(wrong == 0);
    CHECK(edges < kSize * kSize / 20);
  }
}

TEST_CASE("capture: faces that cannot be drawn are an error") {
  Observatory o{Scene{}};
  CHECK(!o.capture->radiance({0, 0, 0}, 0));
  CHECK(!o.capture->radiance({0, 0, 0}, 5000));
}

TEST_CASE("capture: what is too near to be seen follows the scene's size, in steps") {
  const auto near = [](float half) {
    Scene scene;
    place(scene, box(vec3(-half), vec3(half)), Material{});
    return probe::captureNear(scene);
  };
  CHECK(near(5) <= 1e-5f * 10 * std::sqrt(3.0f));
  CHECK(near(5) > 0.5e-5f * 10 * std::sqrt(3.0f));
  CHECK(near(5) == near(5.5f));
  CHECK(near(1e-6f) == 0x1p-17f);
  CHECK(near(1e9f) == 0x1p-4f);
  CHECK(probe::captureNear(Scene{}) == 0x1p-17f);
}
