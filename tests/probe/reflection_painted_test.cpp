// Reflections of painted rooms against ray-box in double: where they lie, in boxes that stand anywhere, at every roughness, from inside, from a face and from outside.
// Mirrors are white metal by Schlick's rung, which reflects all: a pixel is what the place's cube holds there.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "probe/reflection_room.h"

using namespace burnish;
using namespace burnish::test;

namespace {

Material mirror(float roughness) {
  Material m;
  m.albedo = vec3(1);
  m.substance = 1;
  m.roughness = roughness;
  return m;
}
Quality mirrored(Path path = Path::Forward) {
  Quality q;
  q.path = path;
  q.environmentSpecular = EnvironmentSpecular::Schlick;
  q.ambient = Ambient::None;
  return q;
}

/// The colour is the place: 0.5 + 0.4 · position / half size.
dvec3 colorOf(const dvec3& at, const dvec3& half) { return dvec3(0.5) + 0.4 * at / half; }
dvec3 placeOf(const dvec3& color, const dvec3& half) { return (color - dvec3(0.5)) / 0.4 * half; }

/// A box with a mirror in it: a plane through `at` with normal n.
struct Painted {
  dvec3 center{0}, half{1}, capture{0};  ///< capture: in the box's axes
  glm::dmat3 axes{1};
  dvec3 at{0}, n{0, 1, 0};
  Scene scene;

  void make(int size, float roughness, double reach) {
    ReflectionProbe p = boxed(bakedFrom(paintedCube(size, axes, capture, half, [&](const dvec3& q, int, bool) { return colorOf(q, half); }), size), center, half, axes);
    p.capture = center + axes * capture;
    setProbes(scene, {std::move(p)});
    const dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1))), v = glm::cross(n, u);
    place(scene, quad(vec3(at), vec3(u * reach), vec3(v * reach)), mirror(roughness));
  }
  /// Where the mirror's reflection along that ray ends, in the box's axes; from outside the ray starts in the box's nearest point. False: the ray passes the mirror by.
  bool reflected(const Ray& ray, double reach, dvec3& hit) const {
    const double way = glm::dot(at - ray.origin, n) / glm::dot(ray.direction, n);
    const dvec3 p = ray.origin + ray.direction * way;
    if (!(way > 0) || glm::dot(ray.direction, n) >= -0.02 || glm::length(p - at) > 0.95 * reach) return false;
    const dvec3 r = ray.direction - n * (2 * glm::dot(ray.direction, n)), q = glm::transpose(axes) * (p - center);
    hit = wallHit(glm::clamp(q, -half, half), glm::transpose(axes) * r, half).at;
    return true;
  }
};

/// Largest and mean distance between where a pixel's colour lies and where it should, as shares of the box's largest half size.
struct Off {
  double largest = 0, mean = 0;
  int pixels = 0;
};
Off compare(Stage& stage, const Painted& room, const View& view, glm::ivec2 size, double reach, Path path) {
  const Picture picture = stage.linear(room.scene, view, size, mirrored(path));
  Off off;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      dvec3 hit;
      if (!room.reflected(rayThrough(view, size, x + 0.5, y + 0.5), reach, hit)) continue;
      const double error = glm::length(placeOf(picture.at(x, y), room.half) - hit) / std::max({room.half.x, room.half.y, room.half.z});
      off.largest = std::max(off.largest, error);
      off.mean += error;
      ++off.pixels;
    }
  off.mean /= std::max(off.pixels, 1);
  return off;
}

}  // namespace

// H4. What is left: half floats in steps of 2.4e-4 of a colour, 6e-4 of the box; the cube's texels, whose colours bend between samples by the square of a texel, and the corners of the room, where they
// have a kink over a texel (1/64 of a half size at 128²) and the level for roughness 0.02 reaches a texel farther; on the deferred path the normal's 1e-3 rad over up to three half sizes, twice.
TEST_CASE("H4: boxes off-centre and rotated: reflections lie where ray-box in double has them", "[reflection]") {
  Stage stage;
  struct Stand {
    const char* name;
    Painted room;
    View view;
    double reach;
  };
  std::vector<Stand> stands;
  Painted plain;
  plain.half = {2, 1.5, 3};
  plain.at = {0.3, -1.2, 0.5};
  stands.push_back({"in the middle", plain, lookAt({-1.2, 0.6, 2.2}, {0.4, -1.2, 0}), 1.2});
  Painted off = plain;
  off.capture = {1.1, 0.7, -1.9};
  stands.push_back({"captured off its middle", off, lookAt({-1.2, 0.6, 2.2}, {0.4, -1.2, 0}), 1.2});
  Painted turnedRoom = off;
  turnedRoom.center = {40.5, -7.25, 1000.125};
  turnedRoom.axes = turned(0.7, 0.3, -0.4);
  turnedRoom.n = glm::normalize(dvec3(0.2, 1, -0.3));
  turnedRoom.at = turnedRoom.center + dvec3(0.2, -0.5, 0.3);
  stands.push_back({"rotated, far from the origin", turnedRoom, lookAt(turnedRoom.center + dvec3(-0.9, 0.9, 1.1), turnedRoom.at), 0.7});
  for (Stand& s : stands) {
    s.room.make(128, 0.02f, s.reach);
    for (const Path path : {Path::Forward, Path::Deferred}) {
      const Off found = compare(stage, s.room, s.view, {160, 120}, s.reach, path);
      std::cout << fmt::format("  {}, {}: {} pixels, off by {:.2g} of the box's size on the mean, {:.2g} at most\n", s.name, path == Path::Forward ? "forward" : "deferred", found.pixels, found.mean, found.largest);
      CHECK(found.pixels > 3000);
      CHECK(found.mean < 3e-3);
      CHECK(found.largest < 0.05);
    }
  }
}

// H5 in pictures: the mirror lies in the box's floor, the eye on a face, inside and outside, the mirror reaches out of the box within its margin.
TEST_CASE("H5: surfaces on the box's face and outside it, eyes inside, on a face and outside", "[reflection]") {
  Stage stage;
  Painted room;
  room.half = {2, 1, 2};
  room.at = {0, -1, 0};  // on the face itself
  room.make(64, 0.02f, 1.9);
  for (const auto& [name, eye] : {std::pair("inside", dvec3(-1, 0.2, 1.2)), std::pair("on a face", dvec3(-2, 0.2, 1.2)), std::pair("on an edge", dvec3(-2, 1, 0.3)), std::pair("in a corner", dvec3(-2, 1, 2)), std::pair("outside", dvec3(-3.5, 2.5, 3))}) {
    const Off found = compare(stage, room, lookAt(eye, {0.2, -1, 0}), {120, 90}, 1.9, Path::Forward);
    std::cout << fmt::format("  mirror in the box's floor, eye {}: {} pixels, off by {:.2g} on the mean, {:.2g} at most\n", name, found.pixels, found.mean, found.largest);
    CHECK(found.pixels > 1500);
    CHECK(found.mean < 5e-3);
    CHECK(found.largest < 0.09);
  }
  // Boxes without size, and a mirror that ends outside the box: finite and not negative.
  for (const dvec3& half : {dvec3(0), dvec3(2, 0, 2), dvec3(0, 1, 0), dvec3(0.5, 1, 0.5)}) {
    Painted flat = room;
    ReflectionProbe& p = flat.scene.probes.reflections[0];
    p.halfSize = half;
    p.margin = 0.7;
    ++flat.scene.probes.revision;
    RenderRequest request;
    request.output = Output::Linear;
    request.countNonfinite = true;
    const View view = lookAt({-1, 0.2, 1.2}, {0.2, -1, 0});
    const Picture picture = stage.draw(flat.scene, {&view, 1}, {120, 90}, mirrored(Path::Deferred), request);
    CHECK(picture.stats.nonfinitePixels == 0);
  }
}

// H3. A small light on the ceiling, which the capture sees straight above itself: the brightest pixel of its reflection lies where geometry has it, at every roughness.
TEST_CASE("H3: at every roughness the same reflected point", "[reflection]") {
  Stage stage;
  const dvec3 half(3, 1.5, 3), spot(0.8, 1.5, -0.6);
  const glm::ivec2 size{320, 240};
  const View view = lookAt({-1.5, 0.4, 2.4}, {0.2, -1.2, -0.2}, {0, 1, 0}, 1.0f);
  const CubeLevel level = paintedCube(128, glm::dmat3(1), dvec3(0.8, -0.1, -0.6), half, [&](const dvec3& at, int, bool) { return dvec3(glm::length(at - spot) < 0.12 ? 1 : 0); });
  ReflectionProbe probe = boxed(bakedFrom(level, 128), dvec3(0), half);
  probe.capture = {0.8, -0.1, -0.6};
  // The mirror point of the floor for the spot: the eye's image under the floor looks straight at it.
  const dvec3 image(view.eye.x, -2.0 - view.eye.y, view.eye.z), at = image + (spot - image) * ((-1 - image.y) / (spot.y - image.y)), toward = at - view.eye;
  const double t = std::tan(double(view.fovY) / 2), depth = -glm::dot(view.axes[2], toward);
  const glm::dvec2 truth((glm::dot(view.axes[0], toward) / (depth * t * size.x / size.y) + 1) * 0.5 * size.x, (1 - glm::dot(view.axes[1], toward) / (depth * t)) * 0.5 * size.y);
  for (const Reflection rung : {Reflection::Box, Reflection::BoxRough})
    for (const float roughness : {0.05f, 0.15f, 0.3f, 0.5f, 0.7f, 1.0f}) {
      Scene scene;
      setProbes(scene, {probe});
      place(scene, quad({0, -1, 0}, {3, 0, 0}, {0, 0, -3}), mirror(roughness));
      Quality q = mirrored();
      q.reflection = rung;
      const Picture picture = stage.linear(scene, view, size, q);
      double most = 0, weight = 0;
      glm::dvec2 sum(0);
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) most = std::max(most, picture.at(x, y).y);
      // The middle of what is within 2 % of the brightest.
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          if (picture.at(x, y).y > 0.98 * most) sum += glm::dvec2(x + 0.5, y + 0.5), weight += 1;
      const double off = glm::length(sum / weight - truth);
      std::cout << fmt::format("  {}, roughness {}: the brightest pixels lie {:.2f} pixels from the mirrored light\n", rung == Reflection::Box ? "box" : "box-rough", roughness, off);
      CHECK(off < 2);  // the light itself is 10 pixels wide
    }
}

// The acceptance line: a room's corner as a glossy floor shows it, at 1280 x 720 with a probe of 256².
TEST_CASE("a room's corner in a floor of roughness 0.05 lines up with the corner itself", "[reflection]") {
  Stage stage;
  const dvec3 half(3, 1.5, 3);
  const glm::ivec2 size{1280, 720};
  // Each wall has a colour of its own; blue tells ceiling and floor from the walls.
  const Paint paint = [](const dvec3&, int axis, bool positive) {
    if (axis == 1) return dvec3(0.5, 0.5, 1);
    return axis == 0 ? dvec3(positive ? 1 : 0.2, 0.1, 0) : dvec3(0.1, positive ? 0.2 : 1, 0);
  };
  for (const dvec3& capture : {dvec3(0), dvec3(-0.9, 0.4, 0.8)}) {
    ReflectionProbe probe = boxed(bakedFrom(paintedCube(256, glm::dmat3(1), capture, half, paint), 256), dvec3(0), half);
    probe.capture = capture;
    for (const Path path : {Path::Deferred, Path::Forward}) {
      Scene scene;
      setProbes(scene, {probe});
      place(scene, quad({0, -1.5f, 0}, {3, 0, 0}, {0, 0, -3}), mirror(0.05f));
      const View view = lookAt({-1.2, 0.2, 1.6}, {2.2, -1.6, -2.2}, {0, 1, 0}, 1.0f);
      const Picture picture = stage.linear(scene, view, size, mirrored(path));
      double largest = 0, sum = 0;
      int rows = 0;
      for (int y = 0; y < size.y; ++y) {
        // Which wall the reflected ray of a place in this row meets; the corner of +x and -z is where it changes.
        const auto redWall = [&](double x) {
          const Ray ray = rayThrough(view, size, x, y + 0.5);
          const double way = (-1.5 - ray.origin.y) / ray.direction.y;
          const dvec3 p = ray.origin + ray.direction * way, r(ray.direction.x, -ray.direction.y, ray.direction.z);
          if (!(way > 0) || std::abs(p.x) > 2.99 || std::abs(p.z) > 2.99) return -1;
          const WallHit hit = wallHit({p.x, -half.y, p.z}, r, half);
          return hit.axis == 1 ? -1 : hit.axis == 0 && hit.positive ? 1 : hit.axis == 2 && !hit.positive ? 0 : -1;
        };
        double truth = -1;
        for (int x = 40; x < size.x - 40 && truth < 0; ++x)
          if (redWall(x) == 0 && redWall(x + 1) == 1) {
            double low = x, high = x + 1;
            for (int i = 0; i < 40; ++i) (redWall(0.5 * (low + high)) == 1 ? high : low) = 0.5 * (low + high);
            truth = 0.5 * (low + high);
          }
        if (truth < 0 || redWall(truth - 30) != 0 || redWall(truth + 30) != 1) continue;
        // In the picture: where red and green are alike, between two pixels' middles.
        double found = -1;
        for (int x = int(truth) - 30; x < int(truth) + 30; ++x) {
          const dvec3 a = picture.at(x, y), b = picture.at(x + 1, y);
          const double da = a.x - a.y, db = b.x - b.y;
          if (da < 0 && db >= 0) found = x + 0.5 + da / (da - db);
        }
        REQUIRE(found >= 0);
        largest = std::max(largest, std::abs(found - truth));
        sum += std::abs(found - truth);
        ++rows;
      }
      std::cout << fmt::format("  corner captured from {}, {}: {} rows, {:.2f} pixels off on the mean, {:.2f} at most\n", capture == dvec3(0) ? "the middle" : "beside it", path == Path::Forward ? "forward" : "deferred", rows, sum / std::max(rows, 1), largest);
      CHECK(rows > 100);
      CHECK(largest < 2);
    }
  }
}
