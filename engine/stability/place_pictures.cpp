// The hard cases of captured places as pictures: closed rooms, borders, reflections against ray-box in double.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stability/cases.h"
#include "stability/rooms.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr glm::ivec2 kSize{96, 72};

/// A closed room of 6 x 3 x 4 m under a sky, with a ball of metal, one of plastic, a blended pane and one of glass; nothing else gives light.
struct Room {
  Scene scene;
  View view = lookAt({-2.4, 0.6, 1.6}, {0.8, -0.6, -0.4}, {0, 1, 0}, 1.1f);

  explicit Room(float sky) {
    scene.environment.color = vec3(sky);
    Material walls, metal, plastic, blend, glass;
    walls.albedo = {0.6f, 0.55f, 0.5f};
    walls.roughness = 0.35f;
    metal.albedo = {0.9f, 0.7f, 0.4f};
    metal.substance = 1;
    metal.roughness = 0.15f;
    plastic.albedo = {0.2f, 0.4f, 0.7f};
    plastic.roughness = 0.5f;
    blend.blend = true;
    blend.opacity = 0.5f;
    blend.roughness = 0.3f;
    glass.transmission = 1;
    glass.ior = 1.5f;
    glass.roughness = 0.1f;
    place(scene, box({-3, -1.5f, -2}, {3, 1.5f, 2}, true), walls);
    place(scene, sphere(32, 64), metal, translation({-0.5, -0.9, 0}) * glm::dmat4(glm::dmat3(0.6)));
    place(scene, sphere(32, 64), plastic, translation({1.2, -1, 0.4}) * glm::dmat4(glm::dmat3(0.5)));
    place(scene, quad({-0.4f, -0.4f, 0.9f}, {0.5f, 0, -0.1f}, {0, 0.4f, 0.1f}), blend);
    place(scene, quad({-1.4f, 0.1f, 0.8f}, {0.3f, 0, 0.1f}, {0, 0.3f, 0}), glass);
  }
  /// Two boxes that overlap in the middle, exactly as large as the room together: its walls are their faces.
  void light(const dvec3& radiance) {
    ReflectionProbe a = boxed(constantProbe(radiance), {-1.25, 0, 0}, {1.75, 1.5, 2}), b = boxed(constantProbe(radiance), {1, 0, 0}, {2, 1.5, 2});
    a.capture = {-2, 0.3, 0.1};
    setProbes(scene, {std::move(a), std::move(b)});
  }
};

Result<Finding> skyTight(Studio& studio) {
  Finding worst;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Quality q;
    q.path = path;
    Room room(1e4f);
    room.light(dvec3(0));
    const auto p = draw(studio, room.scene, room.view, kSize, {}, q);
    if (!p) return fail(p.error());
    worst.worse(brightest(*p), path == Path::Forward ? "forward path" : "deferred path");
  }
  return worst;
}

Result<Finding> constantBorders(Studio& studio) {
  Finding worst;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Quality q;
    q.path = path;
    // Powers of two are exact in half floats.
    Room open(4), lit(1e4f);
    lit.light(dvec3(4));
    const auto a = draw(studio, lit.scene, lit.view, kSize, {}, q), b = draw(studio, open.scene, open.view, kSize, {}, q);
    if (!a || !b) return fail(a ? b.error() : a.error());
    worst.worse(largestShare(*a, *b), path == Path::Forward ? "forward path" : "deferred path");
  }
  return worst;
}

Material mirror(float roughness) {
  Material m;
  m.albedo = vec3(1);
  m.substance = 1;
  m.roughness = roughness;
  return m;
}
/// White metal by Schlick's rung reflects all: a pixel is what the place's cube holds there.
Quality mirrored(Path path = Path::Forward) {
  Quality q;
  q.path = path;
  q.environmentSpecular = EnvironmentSpecular::Schlick;
  q.ambient = Ambient::None;
  return q;
}

/// A box with a mirror in it: a plane through `at` with normal n. The colour of a wall is the place: 0.5 + 0.4 position / half size.
struct Painted {
  std::string name;
  dvec3 center{0}, half{1}, capture{0};  ///< capture: in the box's axes
  glm::dmat3 axes{1};
  dvec3 at{0}, n{0, 1, 0};
  Scene scene;

  Result<void> make(int size, float roughness, double reach) {
    auto baked = bakedFrom(paintedCube(size, axes, capture, half, [&](const dvec3& q, int, bool) { return dvec3(0.5) + 0.4 * q / half; }), size);
    if (!baked) return fail(baked.error());
    ReflectionProbe p = boxed(std::move(*baked), center, half, axes);
    p.capture = center + axes * capture;
    setProbes(scene, {std::move(p)});
    const dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1))), v = glm::cross(n, u);
    place(scene, quad(vec3(at), vec3(u * reach), vec3(v * reach)), mirror(roughness));
    return {};
  }
  /// Where the mirror's reflection along that ray ends, in the box's axes. False: the ray passes the mirror by.
  bool reflected(const Ray& ray, double reach, dvec3& hit) const {
    const double way = glm::dot(at - ray.origin, n) / glm::dot(ray.direction, n);
    const dvec3 p = ray.origin + ray.direction * way;
    if (!(way > 0) || glm::dot(ray.direction, n) >= -0.02 || glm::length(p - at) > 0.95 * reach) return false;
    const dvec3 r = ray.direction - n * (2 * glm::dot(ray.direction, n)), q = glm::transpose(axes) * (p - center);
    hit = wallHit(glm::clamp(q, -half, half), glm::transpose(axes) * r, half).at;
    return true;
  }
};
/// The mean distance between where a pixel's colour lies and where it should, as a share of the box's largest half size.
Result<double> meanOff(Studio& studio, const Painted& room, const View& view, double reach, Path path) {
  constexpr glm::ivec2 size{120, 90};
  const auto picture = draw(studio, room.scene, view, size, {}, mirrored(path));
  if (!picture) return fail(picture.error());
  double sum = 0;
  int pixels = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      dvec3 hit;
      if (!room.reflected(rayThrough(view, size, x + 0.5, y + 0.5), reach, hit)) continue;
      sum += glm::length((picture->at(x, y) - dvec3(0.5)) / 0.4 * room.half - hit) / std::max({room.half.x, room.half.y, room.half.z});
      ++pixels;
    }
  if (pixels < 1000) return fail("H4", fmt::format("only {} pixels show the mirror", pixels));
  return sum / pixels;
}

// H4. Half floats in steps of 2.4e-4 of a colour, 6e-4 of the box; the corners' kinks; on the deferred path the normal's 1e-3 rad over up to three half sizes, twice.
Result<Finding> standingAnywhere(Studio& studio) {
  Painted off, rotated;
  off.name = "captured off its middle";
  off.half = {2, 1.5, 3};
  off.at = {0.3, -1.2, 0.5};
  off.capture = {1.1, 0.7, -1.9};
  rotated = off;
  rotated.name = "rotated, 1 km from the origin";
  rotated.center = {40.5, -7.25, 1000.125};
  rotated.axes = turned(0.7, 0.3, -0.4);
  rotated.n = glm::normalize(dvec3(0.2, 1, -0.3));
  rotated.at = rotated.center + dvec3(0.2, -0.5, 0.3);
  const View views[] = {lookAt({-1.2, 0.6, 2.2}, {0.4, -1.2, 0}), lookAt(rotated.center + dvec3(-0.9, 0.9, 1.1), rotated.at)};
  const double reach[] = {1.2, 0.7};
  Finding worst;
  int i = 0;
  for (Painted* room : {&off, &rotated}) {
    if (auto made = room->make(128, 0.02f, reach[i]); !made) return fail(made.error());
    for (const Path path : {Path::Forward, Path::Deferred}) {
      const auto found = meanOff(studio, *room, views[i], reach[i], path);
      if (!found) return fail(found.error());
      worst.worse(*found, room->name + (path == Path::Forward ? ", forward path" : ""));
    }
    ++i;
  }
  return worst;
}

// H5: the mirror lies in the box's floor; the eye inside, on a face, on an edge, in a corner, outside. At 64² the corners' kinks are twice as wide as H4's.
Result<Finding> onFaces(Studio& studio) {
  Painted room;
  room.half = {2, 1, 2};
  room.at = {0, -1, 0};
  if (auto made = room.make(64, 0.02f, 1.9); !made) return fail(made.error());
  Finding worst;
  for (const auto& [name, eye] : {std::pair("inside", dvec3(-1, 0.2, 1.2)), std::pair("on a face", dvec3(-2, 0.2, 1.2)), std::pair("on an edge", dvec3(-2, 1, 0.3)), std::pair("in a corner", dvec3(-2, 1, 2)),
                                  std::pair("outside", dvec3(-3.5, 2.5, 3))}) {
    const auto found = meanOff(studio, room, lookAt(eye, {0.2, -1, 0}), 1.9, Path::Forward);
    if (!found) return fail(found.error());
    worst.worse(*found, fmt::format("eye {}", name));
  }
  return worst;
}
Result<Finding> withoutSize(Studio& studio) {
  Painted room;
  room.half = {2, 1, 2};
  room.at = {0, -1, 0};
  if (auto made = room.make(16, 0.02f, 1.9); !made) return fail(made.error());
  Finding bad;
  for (const dvec3& half : {dvec3(0), dvec3(2, 0, 2), dvec3(0, 1, 0), dvec3(0.5, 1, 0.5)})
    for (const Path path : {Path::Deferred, Path::Forward}) {
      ReflectionProbe& p = room.scene.probes.reflections[0];
      p.halfSize = half;
      p.margin = 0.7;
      ++room.scene.probes.revision;
      const auto picture = draw(studio, room.scene, lookAt({-1, 0.2, 1.2}, {0.2, -1, 0}), kSize, {}, mirrored(path));
      if (!picture) return fail(picture.error());
      if (picture->nonfinite && bad.value == 0) bad.where = fmt::format("half sizes ({:g}, {:g}, {:g})", half.x, half.y, half.z);
      bad.value += double(picture->nonfinite);
    }
  return bad;
}

// H3: a small light on the ceiling that the capture sees straight above itself; the middle of what is within 2 % of the brightest lies where geometry mirrors it. The light is 5 pixels wide.
Result<Finding> sameReflectedPoint(Studio& studio) {
  const dvec3 half(3, 1.5, 3), spot(0.8, 1.5, -0.6), capture(0.8, -0.1, -0.6);
  constexpr glm::ivec2 size{160, 120};
  const View view = lookAt({-1.5, 0.4, 2.4}, {0.2, -1.2, -0.2}, {0, 1, 0}, 1.0f);
  auto baked = bakedFrom(paintedCube(128, glm::dmat3(1), capture, half, [&](const dvec3& at, int, bool) { return dvec3(glm::length(at - spot) < 0.12 ? 1 : 0); }), 128);
  if (!baked) return fail(baked.error());
  ReflectionProbe probe = boxed(std::move(*baked), dvec3(0), half);
  probe.capture = capture;
  // The eye's image under the floor looks straight at the spot.
  const dvec3 image(view.eye.x, -2.0 - view.eye.y, view.eye.z), at = image + (spot - image) * ((-1 - image.y) / (spot.y - image.y)), toward = at - view.eye;
  const double t = std::tan(double(view.fovY) / 2), depth = -glm::dot(view.axes[2], toward);
  const glm::dvec2 truth((glm::dot(view.axes[0], toward) / (depth * t * size.x / size.y) + 1) * 0.5 * size.x, (1 - glm::dot(view.axes[1], toward) / (depth * t)) * 0.5 * size.y);
  Finding worst;
  for (const float roughness : {0.05f, 0.15f, 0.3f, 0.5f, 0.7f, 1.0f}) {
    Scene scene;
    setProbes(scene, {probe});
    place(scene, quad({0, -1, 0}, {3, 0, 0}, {0, 0, -3}), mirror(roughness));
    const auto picture = draw(studio, scene, view, size, {}, mirrored());
    if (!picture) return fail(picture.error());
    const double most = brightest(*picture);
    glm::dvec2 sum(0);
    double weight = 0;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (picture->at(x, y).y > 0.98 * most) sum += glm::dvec2(x + 0.5, y + 0.5), weight += 1;
    worst.worse(glm::length(sum / weight - truth), fmt::format("roughness {:g}", roughness));
  }
  return worst;
}

}  // namespace

std::vector<PictureCase> placePictureCases() {
  return {{"H1", "closed room of black places under a sky of 1e4, opaque, blended and glass surfaces: brightest pixel, cd/m2", 0, skyTight, true},
          {"H2", "room of two overlapping places of one constant against a sky of it: largest difference, share of the pixel", 2e-3, constantBorders, true},
          {"H3", "a light on the ceiling mirrored in a floor of roughness 0.05 to 1: off its mirror image, pixels of 1/120 of the height", 1, sameReflectedPoint},
          {"H4", "places captured off their middle, rotated, far from the origin: reflections off ray-box in double, mean share of the box", 3e-3, standingAnywhere},
          {"H5", "mirror in the box's floor; eye inside, on a face, an edge, a corner, outside: off ray-box in double, mean share of the box", 5e-3, onFaces},
          {"H5", "places without a size and a mirror that leaves its box: pixels that are not finite", 0, withoutSize}};
}

}  // namespace burnish::stability
