// The hard cases of captures and bakes as pictures: mirror rooms, what a capture depends on, thin walls, a white furnace from end to end.
#include <fmt/format.h>

#include <cmath>

#include "probe/bounce.h"
#include "stability/cases.h"
#include "stability/rooms.h"
#include "stability/scenes.h"
#include "stability/two_rooms.h"
#include "stability/white_furnace.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

/// A bake in memory of a set with one place: `each` sees its light after every bounce.
Result<ProbeSet> bake(Studio& studio, Scene scene, const ProbeSet& places, const BakeOptions& options, const std::function<void(const probe::PointLight&)>& each) {
  auto capture = probe::Capture::create(studio.gl, std::move(scene), options.quality);
  if (!capture) return fail(capture.error());
  ProbeSet set = probe::blackLight(places, options);
  for (int i = 0; i < options.bounces; ++i) {
    (*capture)->setProbes(set);
    probe::PointTime time;
    auto light = probe::capturePoint(**capture, places, 0, options, time);
    if (!light) return fail(light.error());
    each(*light);
    set = probe::withLight(places, {&*light, 1});
  }
  return set;
}

// H6: six mirrors that shine alike: whatever way light takes, bounce k adds e R^(k-1).
Result<Finding> mirrorRoom(Studio& studio) {
  const vec3 low(-1, -1.5f, -2), high(3, 1, 2);
  Material mirror;
  mirror.substance = 1;
  mirror.albedo = vec3(0.9f);
  mirror.roughness = 0.02f;
  mirror.emission = vec3(2);
  Scene scene;
  addRoom(scene, low, high, {mirror, mirror, mirror, mirror, mirror, mirror});
  ProbeSet places;
  places.reflections.push_back(probeIn(low, high, {0.5, 0.1, 0.3}));
  BakeOptions options;
  options.quality.fresnel = Fresnel::None;  // no Fresnel, no diffuse light: the same from every side
  options.quality.ambient = Ambient::None;
  options.size = 16;
  options.bounces = 4;
  const double code = std::round(std::sqrt(0.9) * 255) / 255;
  Finding worst;
  double sum = 0, term = 2;
  int bounce = 0;
  const auto baked = bake(studio, std::move(scene), places, options, [&](const probe::PointLight& light) {
    sum += term;
    term *= code * code;
    ++bounce;
    for (const float v : light.radiance.levels[0].texels) worst.worse(std::abs(double(v) / sum - 1), fmt::format("bounce {}", bounce));
  });
  if (!baked) return fail(baked.error());
  return worst;
}

// H6: a capture is of the scene and the point alone, whatever is drawn in between.
Result<Finding> captureAlone(Studio& studio) {
  Scene scene;
  Material floor, metal;
  floor.albedo = vec3(0.6f, 0.5f, 0.4f);
  metal.substance = 1;
  metal.roughness = 0.3f;
  place(scene, box({-4, -1, -4}, {4, -0.9f, 4}), floor);
  place(scene, sphere(16, 24), metal, translation({1.5, 0, -1}) * glm::dmat4(glm::dmat3(0.7)));
  Light sun;
  sun.kind = LightKind::Directional;
  sun.intensity = 20;
  sun.castsShadow = true;
  addLight(scene, sun, {0, 0, 0}, {-0.4, -1, -0.3});
  scene.environment.color = vec3(0.2f, 0.3f, 0.5f);
  Quality quality;
  quality.shadowResolution = 256;
  auto capture = probe::Capture::create(studio.gl, scene, quality);
  if (!capture) return fail(capture.error());
  const dvec3 eye(0.2, 0.3, 0.4), elsewhere(-3, 2, 3);
  const auto before = (*capture)->radiance(eye, 16), there = (*capture)->radiance(elsewhere, 16);
  if (!before || !there) return fail(before ? there.error() : before.error());
  // Another camera with shadow maps of its own.
  const auto drawn = draw(studio, scene, lookAt({3, 1, 3}, {0, 0, 0}), {64, 48}, {}, quality);
  if (!drawn) return fail(drawn.error());
  const auto after = (*capture)->radiance(eye, 16);
  if (!after) return fail(after.error());
  if (there->texels == before->texels) return Finding{std::nan(""), "captures of two places are the same"};
  Finding differ;
  for (std::size_t i = 0; i < before->texels.size(); ++i) differ.value += before->texels[i] != after->texels[i];
  return differ;
}

/// What ambient light the six walls of a room show from its middle: mean and largest of all pixels.
struct RoomLight {
  double mean = 0, most = 0;
};
Result<RoomLight> roomLight(Studio& studio, const TwoRooms& rooms, const AmbientGrid& grid, double begin) {
  Scene scene;
  place(scene, box(vec3(rooms.place(begin, 0, 0)), vec3(rooms.place(begin + 2, 2, 2)), true), Material{});
  scene.probes.grid = grid;
  ++scene.probes.revision;
  Quality q;  // white walls show ambient light and nothing else
  q.diffuse = Diffuse::Lambert;
  q.environmentSpecular = EnvironmentSpecular::None;
  constexpr int kFace = 24;
  const auto views = probe::faceViews(rooms.place(begin + 1, 1, 1), 0.05f, kFace);
  const auto p = draw(studio, scene, views, {3 * kFace, 2 * kFace}, {}, q);
  if (!p) return fail(p.error());
  RoomLight light;
  for (int y = 0; y < 2 * kFace; ++y)
    for (int x = 0; x < 3 * kFace; ++x) {
      const double v = p->at(x, y).x;
      light.mean += v / (6 * kFace * kFace);
      if (!(v <= light.most)) light.most = v;
    }
  return light;
}
// H11. worst: the largest pixel, else the mean.
Result<Finding> thinWall(Studio& studio, bool worst) {
  Finding found;
  int axis = 0;
  for (const double thickness : {0.02, 0.2}) {
    const TwoRooms rooms{axis++ % 3, thickness, glm::dmat3(1)};
    const AmbientGrid grid = latticeOver(rooms, 0.06, 0);
    const auto dark = roomLight(studio, rooms, grid, thickness), lit = roomLight(studio, rooms, grid, -2);
    if (!dark || !lit) return fail(dark ? lit.error() : dark.error());
    if (!(lit->mean > 0.99)) return Finding{std::nan(""), fmt::format("the lit room shows {:.3f} of its light", lit->mean)};
    found.worse((worst ? dark->most : dark->mean) / lit->mean, fmt::format("wall of {:g} cm", 100 * thickness));
  }
  return found;
}

// H29: white surroundings are captured and filtered, and light balls through a place's box and the quantised G-buffer. `whole`: with compensation and coupled diffuse, off 1.
Result<Finding> furnace(Studio& studio, bool whole) {
  static constexpr FurnacePaint kPaints[] = {{1 / 3.0, 1}, {1, 1}, {0, 0.5}, {1 / 3.0, 0.5}, {0.4, 0.2}, {0.7, 0.5}, {1, 0.5}, {1 / 3.0, 0.05}};
  static constexpr double kRoughness[] = {0.05, 0.4, 1};
  constexpr float kWhite = 700;
  const vec3 low(-1, -2, -3), high(18, 7, 4);
  ProbeSet places;
  places.reflections.push_back(probeIn(low, high, dvec3(low) * 0.7 + dvec3(high) * 0.3));
  Scene white;
  white.environment.color = vec3(kWhite);
  BakeOptions options;
  options.size = 16;
  options.bounces = 1;
  const auto baked = bake(studio, std::move(white), places, options, [](const probe::PointLight&) {});
  if (!baked) return fail(baked.error());
  Quality q;
  if (whole) q.compensation = Compensation::MultipleScattering, q.diffuse = Diffuse::Coupled;
  const auto drawLinear = [&](const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality) -> Result<Image> {
    auto p = draw(studio, scene, view, size, {}, quality);
    if (!p) return fail(p.error());
    return std::move(p->image);
  };
  const auto found = whiteFurnace(drawLinear, {kPaints, kRoughness, 24, kWhite}, q, [&](Scene& scene) {
    scene.environment.color = vec3(kWhite / 10);  // what gets past the box shows
    scene.probes = *baked;
  });
  if (!found) return fail(found.error());
  return Finding{std::abs(whole ? found->unity : found->worst), whole ? std::string() : found->where};
}

}  // namespace

std::vector<PictureCase> bakePictureCases() {
  return {{"H6", "room of six mirrors that shine alike, 4 bounces: texels off the sum of e R^k, share", 0.01, mirrorRoom, true},
          {"H6", "a capture before and after another camera, place and shadow map: texels that differ", 0, captureAlone, true},
          {"H11", "wall of 2 and 20 cm between a lit and a dark room under one lattice: leak, mean of the dark walls, share of the lit", 1e-3, [](Studio& s) { return thinWall(s, false); }, true},
          {"H11", "the same: the brightest pixel of the dark walls", 0.01, [](Studio& s) { return thinWall(s, true); }, true},
          {"H29", "white furnace through capture, filter, box and G-buffer, default rungs: off the directional albedo by quadrature, share", 0.02, [](Studio& s) { return furnace(s, false); }, true},
          {"H29", "the same with compensation and coupled diffuse: white paints off 1", 0.02, [](Studio& s) { return furnace(s, true); }, true}};
}

}  // namespace burnish::stability
