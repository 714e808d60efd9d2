// What the tests of the measurement share: a small scene, and a bench before it.
#pragma once
#include "cost/bench.h"
#include "cost/terms.h"
#include "render/scenes.h"

namespace burnish::test {

inline constexpr glm::ivec2 kSize{64, 48};

/// A ball on a floor below a grey sky and a lamp.
inline Scene ball(float substance = 1.0f / 3) {
  Scene scene;
  Material m;
  m.albedo = vec3(0.6f, 0.5f, 0.4f);
  m.roughness = 0.4f;
  m.substance = substance;
  place(scene, sphere(1, 24, 48), m);
  place(scene, quad({0, -1, 0}, {4, 0, 0}, {0, 0, -4}), m);
  scene.environment.color = vec3(1);
  scene.environment.background = true;
  Light lamp;
  lamp.intensity = 60;
  addLight(scene, lamp, {2, 3, 3});
  return scene;
}
inline View view() { return lookAt({0, 1, 5}, {0, 0, 0}, {0, 1, 0}, 0.6f); }

struct Bed {
  std::unique_ptr<Context> context = openContext();
  Scene scene;
  View eye = view();
  Report report;
  std::unique_ptr<cost::Bench> bench;

  explicit Bed(Scene s, const Quality& base = {}) : scene(std::move(s)) {
    auto made = cost::Bench::create(context->procAddress(), scene, eye, kSize, base, report);
    if (!made) FAIL(made.error().message());
    bench = std::move(*made);
  }
  ~Bed() {
    if (context->makeCurrent()) bench.reset();
  }
  Bed(const Bed&) = delete;
  Bed& operator=(const Bed&) = delete;
  const Image& picture(const Quality& q) {
    const auto p = bench->picture(q);
    if (!p) FAIL(p.error().message());
    return **p;
  }
  cost::TermsToMeasure found(const Quality& base = {}, const std::vector<std::string>& only = {}) {
    return cost::termsToMeasure(scene, eye, kSize, base, [this](const Quality& q) { return bench->plan(q); }, only);
  }
};

inline Quality with(std::string_view term, std::string_view rung) {
  Quality q;
  if (!setRung(q, term, rung)) FAIL("no rung " << term << "=" << rung);
  return q;
}

}  // namespace burnish::test
