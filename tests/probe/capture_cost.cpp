// What captures cost: test_probe "[cost]" prints the figures of docs/probes.md: CPU time of all threads, llvmpipe's among them.
#include <algorithm>
#include <map>

#include "prefilter/parallel.h"
#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// A room of 40 balls under four spot lights with shadows and eight lamps without.
Scene furnished(bool sun) {
  Scene scene;
  Material m;
  m.albedo = vec3(0.5f);
  addRoom(scene, vec3(-5, -2, -5), vec3(5, 2, 5), m);
  for (int i = 0; i < 40; ++i) place(scene, sphere(0.3f, 12, 16), m, translation({-4 + i % 8 * 1.1, -1, -4 + i / 8 * 1.7}));
  Light spot = light(LightKind::Spot, {1, 1, 1}, 50, 12), day = light(LightKind::Directional, {1, 1, 1}, 5);
  spot.castsShadow = day.castsShadow = true;
  for (int i = 0; i < 4; ++i) addLight(scene, spot, {-3.0 + 2 * i, 1.8, -3.0 + 2 * i}, {0.1, -1, 0.2});
  for (int i = 0; i < 8; ++i) addLight(scene, light(LightKind::Point, {1, 1, 1}, 5, 4), {-4.0 + i, 1, 2});
  if (sun) addLight(scene, day, {0, 0, 0}, {-0.3, -1, -0.2});
  scene.environment.color = vec3(0.3f);
  return scene;
}

/// Median of the CPU times of f(i), milliseconds; the first call is left out.
template <class F>
double median(int count, F&& f) {
  std::vector<double> ms;
  for (int i = 0; i <= count; ++i) {
    const double start = prefilter::cpuMilliseconds();
    f(i);
    if (i > 0) ms.push_back(prefilter::cpuMilliseconds() - start);
  }
  std::nth_element(ms.begin(), ms.begin() + count / 2, ms.end());
  return ms[std::size_t(count / 2)];
}
dvec3 pointOf(int i) { return {0.1 + 0.06 * i, 0.2, 0.3}; }

}  // namespace

TEST_CASE("capture: what a point costs", "[.][cost]") {
  for (const bool sun : {false, true}) {
    const Scene scene = furnished(sun);
    Observatory o(scene);
    for (const int size : {16, 64, 128}) std::cout << fmt::format("  {}faces of {}: {:.1f} ms a point\n", sun ? "with a sun, " : "", size, median(21, [&](int i) { o.radiance(pointOf(i), size); }));
    auto renderer = Renderer::create(o.context->procAddress(), {});
    REQUIRE(renderer);
    RenderRequest request;
    request.output = Output::Linear;
    for (const int points : {1, 8}) {
      auto target = OffscreenTarget::create(o.context->procAddress(), {48, 32 * points}, Output::Linear);
      REQUIRE(target);
      const double ms = median(7, [&](int call) {
        std::vector<View> views;
        for (int i = 0; i < points; ++i)
          for (const View& v : probe::faceViews(pointOf(call * points + i), probe::captureNear(scene), 16, {0, 32 * i})) views.push_back(v);
        REQUIRE((*renderer)->render(scene, views, (*target)->target(), probe::captureQuality({}), request));
        REQUIRE((*target)->read());
      });
      std::cout << fmt::format("  {}faces of 16, {} point{} a call: {:.1f} ms a point\n", sun ? "with a sun, " : "", points, points > 1 ? "s" : "", ms / points);
    }
    request.timing = TimingMode::Profile;
    auto target = OffscreenTarget::create(o.context->procAddress(), {48, 32}, Output::Linear);
    REQUIRE(target);
    std::map<std::string, double> passes;
    for (int i = 0; i < 3; ++i) {
      auto stats = (*renderer)->render(scene, probe::faceViews(pointOf(i), probe::captureNear(scene), 16), (*target)->target(), probe::captureQuality({}), request);
      REQUIRE(stats);
      passes.clear();
      for (const PassTime& p : stats->passes) passes[p.name] += p.cpuMs;
    }
    for (const auto& [name, ms] : passes) std::cout << fmt::format("    {}: {:.2f} ms of CPU time\n", name, ms);
  }
}
