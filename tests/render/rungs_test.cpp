// Rungs in force: each is specialised into the lighting programs and nothing else, draws something finite, and shows where it must; the plan says what a rung calls for.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{96, 72};

/// What every term has an effect on: gold with tangents and baked occlusion, plastic, a narrow lobe; a light and uneven surroundings. With details the gold is brushed and the plastic rough:
/// each of the two doubles the lighting programs.
struct Exhibition : Workshop {
  explicit Exhibition(bool details = false, bool captured = false, bool lattice = false) {
    std::vector<Id<Instance>> all;
    scene.instances.each([&](Id<Instance> id, const Instance&) { all.push_back(id); });
    for (Id<Instance> id : all) scene.instances.remove(id);
    std::vector<Id<Light>> lights;
    scene.lights.each([&](Id<Light> id, const Light&) { lights.push_back(id); });
    for (Id<Light> id : lights) scene.lights.remove(id);
    addLight(scene, test::light(LightKind::Directional, {1, 0.9f, 0.8f}, 40), {0, 0, 0}, {-0.9, -0.5, 0.1});
    const Substance* gold = findSubstance("gold");
    REQUIRE(gold);
    Material m;
    m.mapC = occlusion;
    m.albedo = gold->f0;
    m.conductorEta = gold->eta;
    m.conductorK = gold->k;
    m.substance = 1;
    m.roughness = 0.4f;
    if (details) m.anisotropy = 0.8f;
    place(scene, sphere(0.6f, 48, 96), m, translation({-1.3, 0, 0}));
    m = {};
    m.albedo = {0.6f, 0.7f, 0.8f};
    m.roughness = 0.6f;
    if (details) m.diffuseRoughness = 0.6f;
    place(scene, sphere(0.6f, 48, 96), m, translation({0, 0, 0}));
    m.diffuseRoughness = 0;
    // A mirror turned so that the light's narrow highlight lies in its middle: what evaluations of the lobe differ in.
    m.roughness = 0.1f;
    view = lookAt({0, 0.3, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f);
    const dvec3 middle(1.3, 0, 0), h = glm::normalize(glm::normalize(dvec3(0.9, 0.5, -0.1)) + glm::normalize(view.eye - middle)), a = glm::normalize(glm::cross(dvec3(0, 1, 0), h));
    place(scene, quad(vec3(middle), vec3(a * 0.8), vec3(glm::cross(h, a) * 0.6)), m);
    // Surroundings with all bands.
    Image& map = scene.environment.map;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c) map.f32()[(y * 32 + x) * 3 + c] = float(2 + 1.5 * std::cos(0.4 * (x - 5)) + (y < 8 ? 3 - c : 0.3 * c));
    ++scene.environment.revision;
    if (captured) addPlace();
    if (lattice) addLattice();
  }
  // A place around all of it, captured off its middle: bright toward +x, in each level as wide as its roughness.
  void addPlace() {
    CubeLevel level;
    level.size = 32;
    for (int face = 0; face < 6; ++face)
      for (int i = 0; i < 32 * 32; ++i)
        for (int c = 0; c < 3; ++c) level.texels.push_back(face == 0 && (i / 4 + i / 128) % 2 ? 9.0f : 0.5f * float(1 + (face + c) % 3));
    ReflectionProbe p;
    auto cube = prefilterCubemap(level, {.size = 32});
    REQUIRE(cube);
    p.radiance = std::move(*cube);
    p.irradiance[0] = {1, 1, 1};
    p.irradiance[3] = {0.5, 0.4, 0.3};
    p.irradiance[4] = {0.2, -0.1, 0.3};
    p.halfSize = {2.5, 1.5, 2};
    p.capture = {-1.2, 0.4, 0.7};
    scene.probes.reflections.push_back(std::move(p));
    ++scene.probes.revision;
  }
  // A lattice over it, of other light.
  void addLattice() {
    AmbientGrid g;
    g.origin = {-2, -1, -2};
    g.spacing = {1, 1, 1};
    g.counts = {5, 3, 5};
    for (int i = 0; i < 75; ++i) {
      AmbientGrid::Point& p = g.points.emplace_back();
      p.valid = true;
      p.irradiance[0] = vec3(2, 1 + 0.1f * float(i % 5), 0.5f);
      p.irradiance[1] = vec3(0.3f);
      p.distances.assign(AmbientGrid::kDistanceSize * AmbientGrid::kDistanceSize, {2, 4});
    }
    scene.probes.grid = std::move(g);
    ++scene.probes.revision;
  }
};

/// The largest difference, as a share of what the pixel shows plus 2 % of the mean.
double change(const Picture& p, const Picture& base) {
  double mean = 0, largest = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) mean += base.at(x, y).y / (kSize.x * kSize.y);
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const dvec3 q = base.at(x, y), d = glm::abs(p.at(x, y) - q);
      largest = std::max(largest, std::max({d.x, d.y, d.z}) / (std::max({q.x, q.y, q.z}) + 0.02 * mean));
    }
  return largest;
}

FramePlan planOf(const Scene& scene, const View& view, const Quality& quality, const Capabilities& caps = {}) {
  PlanOptions options;
  options.size = kSize;
  options.output = Output::Linear;
  options.countNonfinite = true;
  return makePlan(scene, {&view, 1}, quality, caps, options);
}

bool shades(const ProgramPlan& p) { return p.name.starts_with("lighting/") || p.name.starts_with("forward"); }
std::ptrdiff_t shadingPrograms(const FramePlan& plan) { return std::count_if(plan.programs.begin(), plan.programs.end(), shades); }
/// Those of tiles that captured places may light: the others stay as they are when a rung of such light changes.
std::ptrdiff_t placePrograms(const FramePlan& plan) {
  return std::count_if(plan.programs.begin(), plan.programs.end(), [](const ProgramPlan& p) { return shades(p) && std::find(p.defines.begin(), p.defines.end(), "PROBES 0") == p.defines.end(); });
}

bool reads(const FramePlan& plan, std::string_view pass, std::string_view table) {
  const PassPlan* p = plan.pass(pass);
  REQUIRE(p);
  return std::find(p->reads.begin(), p->reads.end(), table) != p->reads.end();
}

const EffectPlan& effectOf(const FramePlan& plan, std::string_view name) {
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(), [&](const EffectPlan& e) { return e.name == name; });
  REQUIRE(found != plan.effects.end());
  return *found;
}

bool warned(const Report& report, std::string_view text) {
  const auto& all = report.warnings();
  return std::any_of(all.begin(), all.end(), [&](const Warning& w) { return w.message().find(text) != std::string::npos; });
}

/// Settings beside which a term has an effect.
Quality besideOf(std::string_view term) {
  Quality q;
  if (term == "normalization") q.geometry = Geometry::Void;
  return q;
}

}  // namespace

TEST_CASE("every rung of every term: finite, seen where it must be, and only lighting programs are linked for it", "[sweep]") {
  Stage stage;
  const Exhibition plain, detailed(true), captured(false, true), latticed(false, true, true);
  RenderRequest request;
  request.output = Output::Linear;
  request.countNonfinite = true;
  int linked = 0;
  std::vector<ProgramPlan> shared;  // by rungs
  for (std::size_t t = 0; t < terms().size(); ++t) {
    if (terms()[t].picture) continue;
    const bool details = terms()[t].name == "anisotropy" || terms()[t].name == "rough-diffuse", occlusion = terms()[t].name == "occlusion";
    const std::string_view name = terms()[t].name;
    const Exhibition& e = details ? detailed : name == "reflection" || name == "ambient" ? captured : name == "ambient-source" ? latticed : plain;
    const Quality beside = besideOf(terms()[t].name);
    const FramePlan usual = planOf(e.scene, e.view, beside, stage.renderer->capabilities());
    REQUIRE(stage.renderer->warmUp(usual));
    shared.insert(shared.end(), usual.programs.begin(), usual.programs.end());
    const Picture base = stage.draw(e.scene, {&e.view, 1}, kSize, beside, request);
    std::string line;
    for (std::size_t r = 0; r < terms()[t].rungs.size(); ++r) {
      if (r == rungOf(beside, t)) continue;
      Quality quality = beside;
      setRung(quality, t, r);
      INFO(terms()[t].name << "=" << terms()[t].rungs[r].name);
      const FramePlan plan = planOf(e.scene, e.view, quality, stage.renderer->capabilities());
      std::ptrdiff_t fresh = 0, known = 0;
      for (const ProgramPlan& program : plan.programs)
        if (std::find(usual.programs.begin(), usual.programs.end(), program) == usual.programs.end()) {
          ++fresh;
          if (std::find(shared.begin(), shared.end(), program) != shared.end())
            ++known;
          else
            shared.push_back(program);
          // Without occlusion the G-buffer loses a target, occlusion found on the screen has passes of its own; where nothing is brushed the G-buffer's programs write less.
          CHECK((shades(program) || occlusion || details));
          CHECK_FALSE((shades(program) && details));  // those of other surfaces stay as they are
        }
      const bool ofPlaces = name == "reflection" || (name == "ambient" && terms()[t].rungs[r].name == "box");
      if (ofPlaces) REQUIRE(placePrograms(plan) > 0);
      if (!details && !plan.on("screen_occlusion")) CHECK(fresh >= (ofPlaces ? placePrograms(plan) : shadingPrograms(plan)));
      const auto built = stage.renderer->warmUp(plan);
      REQUIRE(built);
      CHECK(std::ptrdiff_t(*built) == fresh - known);
      linked += *built;
      const Picture p = stage.draw(e.scene, {&e.view, 1}, kSize, quality, request);
      CHECK(stage.renderer->lastPlan().programs == plan.programs);
      CHECK(p.stats.nonfinitePixels == 0);
      const auto back = stage.renderer->warmUp(usual);
      REQUIRE(back);
      CHECK(*back == 0);
      const double changed = change(p, base);
      line += fmt::format(" {} {:.2g}", terms()[t].rungs[r].name, changed);
      CHECK(changed > (terms()[t].name == "lobe" ? 1e-3 : 5e-3));
    }
    std::cout << fmt::format("  {:<21} changes the picture by at most:{}\n", terms()[t].name, line);
  }
  CHECK(linked > 40);
}

TEST_CASE("a change of rung relinks each lighting program once, whatever the lights; what is off is not relinked for it") {
  Stage stage;
  Workshop w;
  const auto build = [&](const Quality& quality) {
    const auto built = stage.renderer->warmUp(planOf(w.scene, w.view, quality, stage.renderer->capabilities()));
    REQUIRE(built);
    return std::ptrdiff_t(*built);
  };
  const FramePlan plan = planOf(w.scene, w.view, {}, stage.renderer->capabilities());
  CHECK(build({}) == std::ptrdiff_t(plan.programs.size()));
  CHECK(shadingPrograms(plan) == 10);  // the tiles' buckets up to 10 lights, the loop, and the loop with spots
  Quality other;
  other.fresnel = Fresnel::SphericalGaussian;
  CHECK(build(other) == 10);
  CHECK(build({}) == 0);
  CHECK(build(other) == 0);
  // Nothing is occluded here.
  other = {};
  other.specularOcclusion = SpecularOcclusion::None;
  other.directOcclusion = DirectOcclusion::Specular;
  CHECK(build(other) == 0);
  // Developing is no lighting.
  other = {};
  other.toneMap = ToneMap::Aces;
  other.exposureEv = 2.0f;
  other.lightThreshold = 1;
  CHECK(build(other) == 0);
  w.scene.environment.scale = 0;
  other = {};
  const std::ptrdiff_t unlit = build(other);
  CHECK(unlit == 10);
  other.environmentSpecular = EnvironmentSpecular::Sampled;
  other.ambient = Ambient::None;
  CHECK(build(other) == 0);
}

TEST_CASE("the plan of rungs: tables, cube and targets are there only when a rung reads them") {
  const Workshop w;
  Quality seed;
  REQUIRE(setPreset(seed, "seed"));
  const auto plan = [&](const Quality& q) { return planOf(w.scene, w.view, q); };
  CHECK(reads(plan({}), "lighting", "dfg"));
  CHECK(reads(plan({}), "lighting", "environment cube"));
  CHECK(!reads(plan(seed), "lighting", "dfg"));
  CHECK(reads(plan(seed), "lighting", "environment cube"));
  Quality q;
  q.environmentSpecular = EnvironmentSpecular::None;
  CHECK(!reads(plan(q), "lighting", "environment cube"));
  CHECK(!reads(plan(q), "lighting", "dfg"));
  CHECK(plan(q).on("environment_lighting"));
  q.ambient = Ambient::None;
  CHECK(!plan(q).on("environment_lighting"));
  CHECK(effectOf(plan(q), "environment_lighting").reason == "the quality turns it off");
  for (Diffuse diffuse : {Diffuse::Coupled, Diffuse::OrenNayarEnergy}) {
    q.diffuse = diffuse;
    CHECK(reads(plan(q), "lighting", "dfg"));
  }
  q = seed;
  q.compensation = Compensation::MultipleScattering;
  CHECK(reads(plan(q), "lighting", "dfg"));
}

TEST_CASE("the plan of the forward path: one pass, no G-buffer, and why") {
  const Workshop w;
  Quality q;
  CHECK(!planOf(w.scene, w.view, q).on("forward_reference"));
  CHECK(effectOf(planOf(w.scene, w.view, q), "forward_reference").reason == "path=forward or a forward-only rung would call for it");
  q.path = Path::Forward;
  const FramePlan plan = planOf(w.scene, w.view, q);
  CHECK(plan.on("forward_reference"));
  CHECK(effectOf(plan, "forward_reference").reason == "path=forward");
  CHECK(effectOf(plan, "forward_reference").calledBy == CalledBy::Setting);
  for (const char* pass : {"gbuffer", "tiles", "lighting"}) CHECK(plan.pass(pass) == nullptr);
  for (const TargetPlan& t : plan.targets) CHECK(!t.name.starts_with("gbuffer"));
  CHECK(plan.target("tile_depth") == nullptr);
  CHECK(plan.gbufferBytesPerPixel == 0);
  CHECK(reads(plan, "forward", "lights"));
  CHECK(plan.target("light")->format == "RGBA32F");
  // Every rung that the G-buffer cannot feed takes it, and is named.
  std::size_t only = 0;
  for (std::size_t t = 0; t < terms().size(); ++t)
    for (std::size_t r = 0; r < terms()[t].rungs.size(); ++r) {
      Quality one;
      setRung(one, t, r);
      const bool takes = terms()[t].rungs[r].forwardOnly;
      only += takes;
      const std::string name = fmt::format("{}={}", terms()[t].name, terms()[t].rungs[r].name);
      INFO(name);
      CHECK(forwardOnlyRung(one) == (takes ? name : ""));
      CHECK(planOf(w.scene, w.view, one).on("forward_reference") == (takes || name == "path=forward"));
      if (takes) CHECK(effectOf(planOf(w.scene, w.view, one), "forward_reference").reason == name + " needs what the G-buffer does not hold");
    }
  CHECK(only == 1);
  Scene nothing;
  CHECK(!planOf(nothing, w.view, q).on("forward_reference"));
  CHECK(effectOf(planOf(nothing, w.view, q), "forward_reference").reason == "nothing to shade");
}

TEST_CASE("the renderer says what a quality does not get as asked") {
  Stage stage;
  Exhibition w;
  Quality q;
  stage.linear(w.scene, w.view, kSize, q);
  CHECK(!warned(stage.renderer->report(), "forward"));
  CHECK(!warned(stage.renderer->report(), "has no effect"));
  q.fresnel = Fresnel::Conductor;
  stage.linear(w.scene, w.view, kSize, q);
  CHECK(warned(stage.renderer->report(), "fresnel=conductor needs what the G-buffer does not hold: drawn by the forward reference path (slow)"));
  q = {};
  q.normalization = Normalization::Plus8;
  stage.linear(w.scene, w.view, kSize, q);
  CHECK(warned(stage.renderer->report(), "normalization=plus-8 has no effect with geometry=kelemen"));
  q = {};
  q.specular = Specular::GgxSmith;
  q.geometry = Geometry::Smith;
  q.lobe = Lobe::Pow;
  stage.linear(w.scene, w.view, kSize, q);
  CHECK(warned(stage.renderer->report(), "geometry=smith has no effect with specular=ggx-smith"));
  CHECK(warned(stage.renderer->report(), "lobe=pow has no effect with specular=ggx-smith"));
  // Asked for once, said once.
  const std::size_t before = stage.renderer->report().warnings().size();
  stage.linear(w.scene, w.view, kSize, q);
  CHECK(stage.renderer->report().warnings().size() == before);
}

TEST_CASE("the forward path takes no depth from a host: one clear error, and nothing is drawn") {
  Stage stage;
  Exhibition w;
  auto target = OffscreenTarget::create(stage.context->procAddress(), kSize, Output::Display);
  REQUIRE(target);
  Quality q;
  q.path = Path::Forward;
  Target withDepth = (*target)->target();
  withDepth.depthIn = HostDepth{1, 0.1f, 100, false};
  const auto done = stage.renderer->render(w.scene, {&w.view, 1}, withDepth, q);
  REQUIRE(!done);
  CHECK(done.error().message().find("the forward reference path cannot take in") != std::string::npos);
  CHECK(done.error().message().find("path=deferred") != std::string::npos);
  // The next frame is none the worse for it.
  const auto after = stage.renderer->render(w.scene, {&w.view, 1}, (*target)->target(), q);
  REQUIRE(after);
  CHECK(after->glErrors == std::vector<std::string>{});
}
