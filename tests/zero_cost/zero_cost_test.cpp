// What is off costs nothing, and that it is off shows nowhere (docs/zero_cost.md). Every effect of effectList(), on a stand and on the three samples.
#include <catch2/catch.hpp>

#include <map>

#include "render/workshop.h"
#include "zero_cost/account.h"

using namespace burnish;
using namespace burnish::test;

namespace {

/// BURNISH_EFFECT=glass looks at one effect alone.
bool chosen(std::string_view effect) {
  const char* one = std::getenv("BURNISH_EFFECT");
  return !one || effect == one;
}

Subject subjectNamed(std::string_view name) { return name == "stand" ? stand() : sample(name); }
constexpr std::string_view kSubjects[] = {"stand", "fps", "rts", "space"};

/// The frame where nothing calls for the effect. Where nothing did before either, one observation serves all effects.
const Observation& observedOff(const EffectCase& row, const std::string& name, Subject& subject) {
  static std::map<std::string, Observation> seen;
  const auto& bare = [&]() -> const Observation& {
    if (const auto found = seen.find(name); found != seen.end()) return found->second;
    return seen.emplace(name, observe(subject)).first->second;
  }();
  if (!bare.plan.on(row.effect)) return bare;
  row.off(subject);
  const std::string key = fmt::format("{} without {}", name, row.effect);
  if (const auto found = seen.find(key); found != seen.end()) return found->second;
  return seen.emplace(key, observe(subject)).first->second;
}

int largestDifference(const Image& a, const Image& b) {
  REQUIRE(a.data.size() == b.data.size());
  if (a.type != PixelType::U8) return a.data == b.data ? 0 : 255;
  int largest = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) largest = std::max(largest, std::abs(int(a.u8()[i]) - int(b.u8()[i])));
  return largest;
}

}  // namespace

TEST_CASE("zero cost: every effect has a row, and every row an effect", "[zero_cost]") {
  std::vector<std::string_view> effects, rows;
  for (const EffectInfo& e : effectList()) effects.push_back(e.name);
  for (const EffectCase& c : effectCases()) rows.push_back(c.effect);
  CHECK(rows == effects);
}

TEST_CASE("zero cost: absent is off, and nothing is done that the plan does not say", "[zero_cost]") {
  for (const std::string_view name : kSubjects)
    for (const EffectCase& row : effectCases()) {
      if (!chosen(row.effect)) continue;
      INFO(row.effect << " on " << name);
      Subject subject = subjectNamed(name);
      const Observation& off = observedOff(row, std::string(name), subject);
      REQUIRE(!off.plan.on(row.effect));
      CHECK(off.strays == std::vector<std::string>{});
      const Observation without = observe(subject, {.removed = {std::string(row.effect)}});
      CHECK(without.strays == std::vector<std::string>{});
      CHECK(difference(off, without).value_or("") == "");
      CHECK(largestDifference(off.picture, without.picture) == 0);
    }
}

TEST_CASE("zero cost: each row can fail: the effect that is called for shows in plan, objects or calls", "[zero_cost]") {
  for (const EffectCase& row : effectCases()) {
    if (!chosen(row.effect)) continue;
    INFO(row.effect);
    Subject subject = stand();
    const Observation& off = observedOff(row, "stand", subject);
    row.off(subject);
    row.on(subject);
    const Observation on = observe(subject);
    CHECK(on.plan.on(row.effect));
    CHECK(on.strays == std::vector<std::string>{});
    CHECK(difference(off, on).has_value());
  }
}

TEST_CASE("zero cost: a picture of the surroundings is filtered for lighting and kept for the background, each where it is called for", "[zero_cost]") {
  Subject subject = stand();
  Environment& e = subject.scene.environment;
  e.map = makeImage(16, 8, 3, PixelType::F32);
  for (std::size_t i = 0; i < e.map.pixelCount() * 3; ++i) e.map.f32()[i] = 0.1f + 0.02f * float(i % 40);
  for (const bool lights : {false, true}) {
    CAPTURE(lights);
    e.background = !lights;
    subject.quality.ambient = lights ? Ambient::ShL2 : Ambient::None;
    subject.quality.environmentSpecular = lights ? EnvironmentSpecular::Dfg : EnvironmentSpecular::None;
    const Observation seen = observe(subject);
    CHECK(seen.strays == std::vector<std::string>{});
    const auto holds = [&](std::string_view label) {
      return std::any_of(seen.objects.begin(), seen.objects.end(), [&](const std::string& o) { return o.starts_with(fmt::format("texture '{}'", label)); });
    };
    CHECK(holds("environment cube") == lights);
    CHECK(holds("environment picture") == !lights);
  }
}

// Normal maps carry an occlusion map in their third channel, whether the frame takes occlusion or not.
TEST_CASE("zero cost: an occlusion map that nothing takes changes no normal", "[zero_cost]") {
  for (const Path path : {Path::Deferred, Path::Forward}) {
    CAPTURE(int(path));
    Subject subject = stand();
    subject.quality.path = path;
    Material& ball = *subject.scene.materials.edit(subject.scene.materials.at(1));
    // Flat, which is exact with z read and with z computed.
    ball.mapB = subject.scene.textures.add(painted(MapKind::NormalRoughness, 4, [](float, float) { return vec4(128 / 255.0f, 128 / 255.0f, 1, 1); }));
    const Observation without = observe(subject);
    const Id<Texture> map = subject.scene.textures.add(painted(MapKind::Occlusion, 4, [](float u, float) { return vec4(u, 1, 0, 0); }));
    subject.scene.materials.edit(subject.scene.materials.at(1))->mapC = map;
    const Observation with = observe(subject);
    CHECK(!with.plan.on("baked_occlusion"));
    CHECK(largestDifference(with.picture, without.picture) <= 1);
  }
}

TEST_CASE("zero cost: off is lossless", "[zero_cost][sweep]") {
  for (const EffectInfo& effect : effectList()) {
    if (effect.calledBy != CalledBy::Scene || !chosen(effect.name)) continue;
    const EffectCase& row = *caseOf(effect.name);
    const auto compare = [&](Subject& subject, const Observation& off) {
      INFO(effect.name << " forced on in " << subject.name);
      REQUIRE(!off.plan.on(effect.name));
      const Observation forced = observe(subject, {.forced = {std::string(effect.name)}});
      CHECK(forced.plan.on(effect.name));
      CHECK(largestDifference(off.picture, forced.picture) <= 1);
    };
    for (const std::string_view name : kSubjects) {
      Subject subject = subjectNamed(name);
      const Observation& off = observedOff(row, std::string(name), subject);
      compare(subject, off);
    }
    // Beside every other effect.
    for (const EffectCase& other : effectCases()) {
      if (other.effect == row.effect) continue;
      Subject subject = stand();
      other.off(subject);
      other.on(subject);
      subject.name = fmt::format("the stand with {}", other.effect);
      const Observation& off = observedOff(row, subject.name, subject);
      if (subject.output == Output::Display) compare(subject, off);
    }
  }
}
