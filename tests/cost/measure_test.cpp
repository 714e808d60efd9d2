// The bench and what is measured with it, on small scenes.
#include <algorithm>

#include "cost/bench.h"
#include "cost/front.h"
#include "cost/metrics.h"
#include "cost/terms.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::cost;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{64, 48};

/// A ball on a floor below a grey sky and a lamp.
Scene ball(float substance = 1.0f / 3) {
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
View view() { return lookAt({0, 1, 5}, {0, 0, 0}, {0, 1, 0}, 0.6f); }

struct Bed {
  std::unique_ptr<Context> context = openContext();
  Scene scene;
  View eye = view();
  Report report;
  std::unique_ptr<Bench> bench;

  explicit Bed(Scene s, const Quality& base = {}) : scene(std::move(s)) {
    auto made = Bench::create(context->procAddress(), scene, eye, kSize, base, report);
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
  TermsToMeasure found(const Quality& base = {}, const std::vector<std::string>& only = {}) {
    return termsToMeasure(scene, eye, kSize, base, [this](const Quality& q) { return bench->plan(q); }, only);
  }
};

template <class T, class Change>
void edit(Table<T>& table, Change change) {
  std::vector<Id<T>> ids;
  table.each([&](Id<T> id, const T&) { ids.push_back(id); });
  for (const Id<T> id : ids) change(*table.edit(id));
}

bool listed(const TermsToMeasure& found, std::string_view name) {
  return std::any_of(found.terms.begin(), found.terms.end(), [&](const TermToMeasure& t) { return terms()[t.term].name == name; });
}
std::string idleReason(const TermsToMeasure& found, std::string_view name) {
  for (const auto& [term, why] : found.idle)
    if (term == name) return why;
  return {};
}

Quality with(std::string_view term, std::string_view rung) {
  Quality q;
  if (!setRung(q, term, rung)) FAIL("no rung " << term << "=" << rung);
  return q;
}

}  // namespace

TEST_CASE("measure: the bench develops as the renderer does, and keeps pictures") {
  Bed bed(ball());
  const Image& linear = bed.picture({});
  CHECK(linear.channels == 3);
  Quality shown;
  shown.exposureEv = bed.bench->exposureEv();
  auto target = OffscreenTarget::create(bed.context->procAddress(), kSize, Output::Display);
  auto renderer = Renderer::create(bed.context->procAddress());
  REQUIRE((target && renderer));
  REQUIRE((*renderer)->render(bed.scene, {&bed.eye, 1}, (*target)->target(), shown));
  const auto display = (*target)->read();
  REQUIRE(display);
  const Image developed = bed.bench->developed(linear);
  int worst = 0;
  for (std::size_t i = 0; i < developed.pixelCount(); ++i)
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(int(developed.u8()[3 * i + c]) - int(display->u8()[4 * i + c])));
  CHECK(worst <= 1);  // the display's sRGB curve is within 0.1/255 of the exact one
  CHECK(developed.u8()[0] > 0);

  Quality other;
  other.toneMap = ToneMap::Aces;
  other.antialiasing = Antialiasing::Edge;
  CHECK(&bed.picture(other) == &linear);
  bed.bench->forget();
  CHECK(&bed.picture({}) == &linear);
  // The same pixels from another bench on the same machine.
  Bed again(ball());
  CHECK(again.picture({}).data == linear.data);
}

TEST_CASE("measure: a repeated time lies within its stated spread, and a rung that does more is slower") {
  Bed bed(ball());
  const std::vector<Quality> qualities{Quality{}, with("environment-specular", "sampled"), with("environment-specular", "none")};
  const std::vector<std::string> passes{"lighting"};
  int within = 0, count = 0;
  std::vector<std::vector<Timing>> runs;
  for (int i = 0; i < 5; ++i) {
    auto timings = bed.bench->time(qualities, 7, passes);
    if (!timings) FAIL(timings.error().message());
    runs.push_back(std::move(*timings));
  }
  for (std::size_t i = 1; i < runs.size(); ++i)
    for (std::size_t q = 0; q < qualities.size(); ++q) {
      const Spread &a = runs[i - 1][q].ratio, &b = runs[i][q].ratio;
      within += b.median >= a.low && b.median <= a.high ? 1 : 0, ++count;
      CHECK(a.count == 7);
    }
  INFO(within << " of " << count);
  CHECK(within >= 8);  // of 12; fewer than 8 of 12 at 19 in 20 is one run in 5000
  for (const auto& run : runs) {
    CHECK(run[1].passes.low > 2 * run[0].passes.high);  // 256 samples a pixel in place of one lookup
    CHECK(run[1].ratio.low > run[0].ratio.high);
    CHECK(run[0].passes.median < run[0].frame.median);
    CHECK(run[0].byPass.count("lighting") == 1);
  }
  CHECK(bed.bench->baseFrame().count >= 5 * 7 * 4);
}

TEST_CASE("measure: a rung that is wrong by a known share shows it") {
  // A white metal ball that fills the view, in a uniform sky: without reflections it is black.
  Scene scene;
  Material mirror;
  mirror.albedo = vec3(1);
  mirror.substance = 1;
  mirror.roughness = 0.3f;
  place(scene, sphere(40, 48, 96), mirror, translation({0, 0, -39}));
  scene.environment.color = vec3(1);
  Bed bed(std::move(scene));
  const Image dfg = bed.picture({});
  const PictureError none = errorOf({bed.picture(with("environment-specular", "none")), {}}, {dfg, {}});
  CHECK(none.energy == Approx(-1).margin(1e-6));
  CHECK(none.rms == Approx(1).margin(1e-6));
}

TEST_CASE("measure: terms that nothing calls for are left out, each with a reason") {
  Scene plain = ball();
  Bed bed(plain);
  const TermsToMeasure lit = bed.found();
  for (const char* name : {"specular", "geometry", "normalization", "lobe", "fresnel", "diffuse", "environment-specular", "ambient", "occlusion", "path"}) {
    INFO(name);
    CHECK(listed(lit, name));
  }
  for (const char* name : {"reflection", "ambient-source", "anisotropy", "rough-diffuse", "shadow", "specular-occlusion", "direct-occlusion", "antialiasing", "bloom", "specular-antialiasing"}) {
    INFO(name);
    CHECK(!listed(lit, name));
    CHECK(idleReason(lit, name).size() > 10);
  }
  CHECK(lit.terms.size() + lit.idle.size() == terms().size());
  for (const TermToMeasure& t : lit.terms) {
    const std::string name(terms()[t.term].name);
    INFO(name);
    CHECK(!t.calledBy.empty());
    CHECK(std::find(t.rungs.begin(), t.rungs.end(), t.exact) != t.rungs.end());
    CHECK(t.setting == (name == "normalization" ? "geometry=void" : ""));
    for (const std::size_t rung : t.rungs) CHECK(idleRungs(t.with({}, rung)).empty());
  }
  CHECK(bed.found({}, {"fresnel"}).terms.size() == 1);
}

TEST_CASE("measure: what the scene brings calls for its terms") {
  Scene scene = ball();
  edit(scene.lights, [](Light& l) { l.castsShadow = true; });
  edit(scene.materials, [](Material& m) {
    m.anisotropy = 0.5f, m.diffuseRoughness = 0.4f;
    m.conductorEta = vec3(0.2f), m.conductorK = vec3(3);
  });
  Bed bed(std::move(scene));
  const TermsToMeasure found = bed.found();
  for (const char* name : {"anisotropy", "rough-diffuse", "shadow"}) {
    INFO(name);
    CHECK(listed(found, name));
  }
  for (const TermToMeasure& t : found.terms)
    if (terms()[t.term].name == "fresnel") CHECK(terms()[t.term].rungs[t.exact].name == "conductor");
  // Lamps gone, surroundings stay.
  edit(bed.scene.lights, [](Light& l) { l.enabled = false; });
  const TermsToMeasure dark = bed.found();
  for (const char* name : {"normalization", "lobe", "shadow"}) {
    INFO(name);
    CHECK(!listed(dark, name));
  }
  CHECK(listed(dark, "fresnel"));
}

TEST_CASE("measure: dominated rungs") {
  const auto rung = [](double rms) {
    RungCost r;
    r.exact.rms = rms;
    return r;
  };
  std::vector<RungCost> rungs{rung(0.10), rung(0.05), rung(0.05), rung(0), rung(0.2)};
  const auto time = [](double ms) { return Spread{ms, ms * 0.98, ms * 1.02, 7}; };
  // 0 is as fast as 1 and worse: dominated. 2 is as exact as 1 and slower. 3 is slowest and exact. 4 was not timed.
  markDominated(rungs, {time(1), time(1.01), time(1.2), time(2), {}});
  CHECK(rungs[0].dominated);
  CHECK(!rungs[1].dominated);
  CHECK(rungs[2].dominated);
  CHECK(!rungs[3].dominated);
  CHECK(!rungs[4].dominated);
  // Within the spread of both nothing beats anything.
  std::vector<RungCost> equal{rung(0.05), rung(0.05)};
  markDominated(equal, {time(1), time(1.01)});
  CHECK(!equal[0].dominated);
  CHECK(!equal[1].dominated);
}

TEST_CASE("measure: the front holds what nothing beats") {
  std::vector<FrontPoint> front(4);
  const double ms[] = {3, 1, 2, 2.5}, rms[] = {0, 0.3, 0.1, 0.2};
  for (std::size_t i = 0; i < 4; ++i) front[i].ms = {ms[i], ms[i], ms[i], 3}, front[i].error.rms = rms[i];
  sortFront(front);
  CHECK(front[0].ms.median == 1);
  CHECK(front[3].ms.median == 3);
  std::vector<bool> dominated;
  for (const FrontPoint& p : front) dominated.push_back(p.dominated);
  CHECK(dominated == std::vector<bool>{false, false, true, false});
}

TEST_CASE("measure: a whole report, against a truth that is the preset exact") {
  Bed bed(ball());
  Quality exact;
  REQUIRE(setPreset(exact, "exact"));
  ReferencePicture truth;
  truth.radiance = bed.picture(exact);
  truth.variance = makeImage(kSize.x, kSize.y, 3, PixelType::F32);
  truth.samples = 1;
  CostOptions options;
  options.size = kSize;
  options.truth = &truth;
  options.rounds = 3;
  options.minutes = 0;
  options.terms = {"fresnel"};
  options.choices = false;
  Report report;
  int told = 0;
  options.progress = [&told](double share, std::string_view) { return ++told, share >= 0 && share <= 1; };
  const auto cost = measureCost(bed.context->procAddress(), bed.scene, bed.eye, options, report);
  if (!cost) FAIL(cost.error().message());
  CHECK(told > 3);
  CHECK(cost->against == "ground truth");
  CHECK(cost->clock == "CPU time");
  REQUIRE(cost->terms.size() == 1);
  const TermCost& fresnel = cost->terms[0];
  CHECK(fresnel.exactRung == "dielectric");
  REQUIRE(fresnel.rungs.size() == 4);
  for (const RungCost& r : fresnel.rungs) {
    INFO(r.name << " " << r.note);
    CHECK(r.inForce == (r.name == "schlick"));
    CHECK((r.exact.rms == 0) == (r.name == "dielectric"));
    CHECK(r.exactRestKnown);
    CHECK((r.exactRest.rms == 0) == (r.name == "dielectric"));
    CHECK(r.frameMs.count == 3);
    CHECK(r.passMs.median > 0);
    CHECK(r.passMs.median < r.frameMs.median);
    CHECK(r.exactPassMs.count == 3);
    CHECK(r.picture.width == kSize.x);
    CHECK(r.difference.channels == 1);
  }
  // F0 at every angle is farther from Fresnel's equations than Schlick's fit of them.
  CHECK(fresnel.rungs[0].exact.rms > 2 * fresnel.rungs[1].exact.rms);
  CHECK(fresnel.rungs[0].exact.energy < fresnel.rungs[1].exact.energy);
  CHECK(cost->exact.error.rms == 0);
  CHECK(cost->base.error.rms > 0);
  // Presets, and the three other rungs.
  CHECK(cost->front.size() == 6);
  REQUIRE(cost->contributors.size() == 3);
  double all = 0;
  for (const auto& [name, share] : cost->contributors)
    if (name.rfind("all terms", 0) == 0) all = share;
  CHECK(all == Approx(cost->base.error.rms));

  options.progress = [](double, std::string_view) { return false; };
  const auto stopped = measureCost(bed.context->procAddress(), bed.scene, bed.eye, options, report);
  REQUIRE(!stopped);
  CHECK(stopped.error().message().find("stopped") != std::string::npos);
  options.terms = {"frensel"};
  CHECK(!measureCost(bed.context->procAddress(), bed.scene, bed.eye, options, report));
}
