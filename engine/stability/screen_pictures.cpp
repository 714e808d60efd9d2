// The hard cases of depth, of occlusion found on the screen, of motion by parts of a pixel, and of what is no number in the light buffer.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "stability/cases.h"
#include "stability/depth_position.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

// H20: balls of polished metal with a radius of 2 pixels that move by parts of a pixel, a metre a pixel; against 12 x 12 samples a pixel.
struct Motion {
  double variance = 0;  ///< over time, mean of all pixels, over the fine pictures'
  double light = 0;     ///< off the fine pictures', share
};
constexpr glm::ivec2 kBeads{30, 20};
constexpr int kBeadFrames = 8;
struct Sums {
  std::vector<double> sum = std::vector<double>(std::size_t(kBeads.x * kBeads.y)), square = sum;
  void add(const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i], square[i] += values[i] * values[i];
  }
  [[nodiscard]] double variance() const {
    double all = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) all += square[i] / kBeadFrames - std::pow(sum[i] / kBeadFrames, 2);
    return all;
  }
  [[nodiscard]] double light() const {
    double all = 0;
    for (const double s : sum) all += s;
    return all;
  }
};
Result<Motion> beads(Studio& studio) {
  constexpr int kFine = 12;
  Scene scene;
  Material m;
  m.albedo = vec3(0.9f);
  m.substance = 1;
  m.roughness = 0.2f;
  for (int j = -2; j <= 2; ++j)
    for (int i = -3; i <= 3; ++i) place(scene, sphere(24, 48), m, translation({i * 5.3, j * 5.1, 0}) * glm::dmat4(glm::dmat3(2.2)));
  addLight(scene, LightKind::Directional, 10, {0, 0, 0}, {-0.25, -0.2, -1});
  const auto frame = [&](int f, int scale, SpecularAntialiasing rung) -> Result<std::vector<double>> {
    View v = lookAt({0.171 * f, 0.0917 * f, 50}, {0.171 * f, 0.0917 * f, 0});
    v.orthographic = true;
    v.height = float(kBeads.y);
    v.far = 100;
    Quality q;
    q.specularAntialiasing = rung;
    const auto p = draw(studio, scene, v, kBeads * scale, {}, q);
    if (!p) return fail(p.error());
    std::vector<double> values(std::size_t(kBeads.x * kBeads.y));
    for (int y = 0; y < kBeads.y * scale; ++y)
      for (int x = 0; x < kBeads.x * scale; ++x) values[std::size_t(y / scale * kBeads.x + x / scale)] += p->at(x, y).y / (scale * scale);
    return values;
  };
  Sums fine, filtered;
  for (int f = 0; f < kBeadFrames; ++f) {
    const auto exact = frame(f, kFine, SpecularAntialiasing::None), one = frame(f, 1, SpecularAntialiasing::Geometric);
    if (!exact || !one) return fail(exact ? one.error() : exact.error());
    fine.add(*exact);
    filtered.add(*one);
  }
  return Motion{filtered.variance() / fine.variance(), std::abs(filtered.light() / fine.light() - 1)};
}

Material matte() {
  Material m;
  m.albedo = vec3(0.8f);
  return m;
}
Result<Picture> occlusionOf(Studio& studio, const Scene& scene, const View& view, glm::ivec2 size) {
  Quality q;
  q.occlusion = Occlusion::Screen8;
  q.exposureEv = 0.0f;  // the debug view shows occlusion as it is, one byte
  RenderRequest request;
  request.debugView = DebugView::Occlusion;
  return draw(studio, scene, view, size, request, q);
}
View parallel(View view, float height) {
  view.orthographic = true;
  view.height = height;
  view.far = 50;
  return view;
}
// H22: a lone plane, from above to grazing; the far plane cuts it off.
Result<Finding> lonePlane(Studio& studio) {
  constexpr glm::ivec2 size{72, 48};
  Finding worst;
  Scene scene;
  place(scene, quad({0, 0, 0}, {0, 0, 3000}, {3000, 0, 0}), matte());
  for (const double degrees : {0.0, 35.0, 75.0, 85.0, 89.0, 89.8}) {
    const double a = glm::radians(degrees);
    const dvec3 eye(4 * std::sin(a), 4 * std::cos(a), 0);
    View view = lookAt(eye, {0, 0, 0}, glm::normalize(dvec3(0.3, 0.9, 0.5)), 0.7f);
    View far = view;
    far.far = 400;
    for (const View& v : {view, far, parallel(view, 3)}) {
      const auto p = occlusionOf(studio, scene, v, size);
      if (!p) return fail(p.error());
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const Ray r = rayThrough(v, size, x + 0.5, y + 0.5);
          const double depth = r.direction.y < 0 ? glm::dot(r.direction, v.axes[2]) * r.origin.y / r.direction.y : -1;
          if (depth > 1.01 * double(v.near) && depth < (v.far > 0 ? std::min(double(v.far), 1000.0) : 1000.0)) worst.worse(1 - p->at(x, y).x, fmt::format("{:g} degrees{}", degrees, v.orthographic ? ", parallel" : ""));
        }
    }
  }
  return worst;
}
// H22: panels before a wall that is out of reach, a ball before the sky; all of it is open.
Result<Finding> bleeding(Studio& studio) {
  constexpr glm::ivec2 size{96, 72};
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  Scene panels, ball;
  place(panels, quad({0, 0, -3}, {9, 0, 0}, {0, 9, 0}), matte());
  place(panels, quad({0, 0, 0}, {0.7f, 0, 0}, {0, 0.7f, 0}), matte());
  place(panels, quad({-1.2f, 0.9f, 0.5f}, {0.01f, 0, 0}, {0, 0.9f, 0}), matte());
  place(ball, sphere(128, 256), matte());
  Finding worst;
  for (const View& v : {view, parallel(view, 3)}) {
    const auto a = occlusionOf(studio, panels, v, size), b = occlusionOf(studio, ball, v, size);
    if (!a || !b) return fail(a ? b.error() : a.error());
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        worst.worse(1 - a->at(x, y).x, "panels before a wall");
        const Ray r = rayThrough(v, size, x + 0.5, y + 0.5);
        const double along = glm::dot(r.origin, r.direction);
        if (glm::dot(r.origin, r.origin) - along * along < 0.998) worst.worse(1 - b->at(x, y).x, "a ball before the sky");
      }
  }
  return worst;
}

Result<Finding> positions(Studio& studio) {
  Finding worst;
  for (const bool orthographic : {false, true})
    for (const dvec3& origin : {dvec3(0), dvec3(1e6 + 0.123, 2e5, -1e6)})
      for (const double distance : {1.0, 1000.0, 100000.0}) {
        const auto e = positionError(studio.gl, studio.device, studio.renderer, distance, origin, orthographic);
        if (!e) return fail(e.error());
        worst.worse(e->total / 1000 / distance, fmt::format("{:.4g} mm at {:g} m{}{}", e->total, distance, orthographic ? ", parallel" : "", origin.x > 0 ? ", far from the origin" : ""));
      }
  return worst;
}

// H17: one value that is no number in the light buffer, in the first of three frames. `pixels`: those that are hurt besides its own.
struct Hurt {
  double pixels = 0;
  bool reported = false;
};
Result<Hurt> hurt(Studio& studio, const Quality& quality, int sequence) {
  constexpr glm::ivec2 size{48, 36};
  constexpr int kX = 20, kY = 15;
  Scene scene;
  Material m;
  m.unlit = true;
  m.albedo = vec3(0.4f, 0.3f, 0.2f);
  place(scene, quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), m);
  const View view = lookAt({0, 0, 2}, {0, 0, 0});
  auto target = OffscreenTarget::create(studio.gl, size, Output::Linear);
  if (!target) return fail(target.error());
  Hurt found;
  for (int frame = 0; frame < 3; ++frame) {
    RenderRequest request;
    request.sequence = sequence;
    request.countNonfinite = true;
    if (frame == 0)
      request.hostDraw = [&](const HostDraw&) {
        const float nan[4] = {std::numeric_limits<float>::quiet_NaN(), 0.5f, 0.5f, 1};
        studio.device.gl.Enable(GL_SCISSOR_TEST);
        studio.device.gl.Scissor(kX, kY, 1, 1);
        studio.device.gl.ClearBufferfv(GL_COLOR, 0, nan);
      };
    const auto stats = studio.renderer.render(scene, {&view, 1}, (*target)->target(), quality, request);
    auto image = (*target)->read();
    if (!stats || !image) return fail(stats ? image.error() : stats.error());
    if (frame == 0) found.reported = stats->nonfinitePixels == 1;
    const Picture p{std::move(*image), 0};
    const dvec3 usual = p.at(1, 1);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const bool own = frame == 0 && x == kX && y == size.y - 1 - kY;
        found.pixels += !own && !(glm::length(p.at(x, y) - usual) < 1e-3);
      }
  }
  studio.renderer.release(scene);
  return found;
}
Result<Finding> lightBuffer(Studio& studio) {
  Finding bad;
  Quality plain;
  plain.toneMap = ToneMap::None;
  plain.exposureEv = -std::log2(1.2f);  // the light buffer holds cd/m2 as they are
  Quality blooming = plain, averaging = plain, metering = plain;
  blooming.bloom = Bloom::Scatter;
  averaging.antialiasing = Antialiasing::Temporal;
  metering.exposureEv.reset();
  int sequence = 170;
  for (const auto& [name, quality] : {std::pair("bloom", blooming), std::pair("antialiasing over time", averaging), std::pair("automatic exposure", metering)}) {
    const auto found = hurt(studio, quality, ++sequence);
    if (!found) return fail(found.error());
    if (const double wrong = found->pixels + !found->reported; wrong > 0) {
      if (bad.value == 0) bad.where = found->reported ? name : fmt::format("{}, not reported", name);
      bad.value += wrong;
    }
  }
  return bad;
}

}  // namespace

std::vector<PictureCase> screenPictureCases() {
  // Both rows are of the same frames.
  const auto motion = std::make_shared<std::optional<Motion>>();
  const auto measured = [motion](Studio& studio, double Motion::*member) -> Result<Finding> {
    if (!*motion) {
      auto m = beads(studio);
      if (!m) return fail(m.error());
      *motion = *m;
    }
    return Finding{(**motion).*member, {}};
  };
  return {{"H17", "NaN in one pixel of the light buffer: other pixels that differ, in that frame and two more, under bloom, averaging and metering; or no report", 0, lightBuffer, true},
          {"H20", "glossy balls that move by parts of a pixel, specular antialiasing: variance over time over that of 144 samples a pixel", 1.5, [measured](Studio& s) { return measured(s, &Motion::variance); }, true},
          {"H20", "the same: light off that of 144 samples a pixel, share", 0.1, [measured](Studio& s) { return measured(s, &Motion::light); }, true},
          {"H22", "screen occlusion of a lone plane, 0 to 89.8 degrees, up to the far plane: light that it loses", 2.5 / 255, lonePlane, true},
          {"H22", "screen occlusion of panels before a far wall and of a ball before the sky: light that they lose", 0.02, bleeding, true},
          {"H23", "position from depth at 1 m, 1 km and 100 km, eye up to 1e6 m from the origin: error, share of the distance", 1e-6, positions}};
}

}  // namespace burnish::stability
