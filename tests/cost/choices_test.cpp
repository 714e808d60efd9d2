// The choices that are no terms: which the scene exercises, and that their errors have the order that geometry and formats give them.
#include "cost/choices_fixture.h"

using namespace burnish;
using namespace burnish::test;

namespace {

std::string idleReason(const cost::Choices& c, std::string_view name) {
  for (const auto& [what, why] : c.idle)
    if (what == name) return why;
  return {};
}

/// A glossy ball on a floor, in the light of a sun that casts shadows.
void fillSunny(ChoiceStage& s) {
  Material floor, ball;
  floor.albedo = {0.6f, 0.5f, 0.4f};
  ball.albedo = {0.2f, 0.3f, 0.7f};
  ball.roughness = 0.25f;
  place(s.scene, box({-6, -0.9f, -6}, {6, -0.8f, 3}), floor);
  place(s.scene, sphere(0.8f, 32, 64), ball);
  Light sun = light(LightKind::Directional, {1, 0.95f, 0.9f}, 12);
  sun.castsShadow = true;
  addLight(s.scene, sun, {}, {-0.4, -1, -0.6});
  s.view = lookAt({0, 1.2, 5}, {0, -0.2, 0}, {0, 1, 0}, 0.6f);
  s.options.size = {96, 72};
  s.options.rounds = 3;
}

}  // namespace

TEST_CASE("choices: formats, sizes and layouts of a sunny scene, in the order of their errors", "[choices]") {
  ChoiceStage s;
  fillSunny(s);
  const cost::Choices c = s.choices({"normal-storage", "light-buffer", "resolution-scale", "shadow-resolution", "shadow-cascades"});
  REQUIRE(c.terms.size() == 5);
  for (const TermCost& t : c.terms) {
    print(t);
    CHECK(t.choice);
    CHECK(!t.calledBy.empty());
    int inForce = 0;
    for (const RungCost& r : t.rungs) {
      INFO(t.name << "=" << r.name);
      inForce += r.inForce;
      CHECK((r.frameMs.median > 0 && r.frameMs.low <= r.frameMs.median && r.frameMs.median <= r.frameMs.high));
      CHECK(r.passMs.median > 0);
      CHECK((r.exact.rms == 0) == (r.name == t.exactRung));
      CHECK(r.exact.skipped == 0);
      CHECK((r.picture.width == 96 && r.difference.channels == 1 && r.truth.rms == 0));
    }
    CHECK(inForce == 1);
  }
  // Four thirds of a decade of the normal's step an axis; the last one's difference to the forward path is the maps' and the lobe's own rounding.
  const TermCost& normals = c.terms[0];
  CHECK(normals.exactRung == "forward");
  CHECK(rungNamed(normals, "oct-12").exact.rms < rungNamed(normals, "oct-8").exact.rms);
  CHECK(rungNamed(normals, "oct-16").exact.rms < rungNamed(normals, "oct-12").exact.rms);
  const TermCost& light = c.terms[1];
  // A step is 1/64 of the value and 1/1024; cut off or rounded, the rms is under a step and over a twentieth of it.
  CHECK((rungNamed(light, "r11g11b10").exact.rms < 1.0 / 32 && rungNamed(light, "r11g11b10").exact.rms > 1.0 / 64 / 20));
  CHECK((rungNamed(light, "rgba16f").exact.rms < 1.0 / 1024 && rungNamed(light, "rgba16f").exact.rms > 1.0 / 1024 / 20));
  const TermCost& scale = c.terms[2];
  CHECK(rungNamed(scale, "0.5").exact.rms > rungNamed(scale, "0.75").exact.rms);
  CHECK(rungNamed(scale, "0.5").frameMs.median < rungNamed(scale, "1").frameMs.median);
  const TermCost& shadows = c.terms[3];
  CHECK(rungNamed(shadows, "256").exact.rms > rungNamed(shadows, "1024").exact.rms);
  CHECK(rungNamed(shadows, "1024").exact.rms > rungNamed(shadows, "2048").exact.rms);
  CHECK(rungNamed(c.terms[4], "1").exact.rms > 0);
  // Each but those in force is a point for the front.
  std::size_t settings = 0;
  for (const TermCost& t : c.terms) settings += t.rungs.size() - 1;
  CHECK(c.points.size() == settings);
  for (const auto& [point, ratio] : c.points) {
    CHECK(point.settings.size() == 1);
    CHECK(ratio.count > 0);
  }
}

TEST_CASE("choices: what the scene does not exercise has a reason, and only what is asked for is measured", "[choices]") {
  ChoiceStage s;
  addLight(s.scene, light(LightKind::Directional, vec3(1), 3), {}, {-0.4, -1, -0.6});
  place(s.scene, sphere(0.8f, 16, 32), Material{});
  s.scene.environment.color = {0.5f, 0.6f, 0.8f};
  s.view = lookAt({0, 1.2, 5}, {0, -0.2, 0}, {0, 1, 0}, 0.6f);
  s.options.size = {48, 36};
  s.options.rounds = 3;
  s.options.base.exposureEv = 2.0f;
  // A colour around, nothing that casts shadows, and lighting that develops in place.
  const cost::Choices c = s.choices({"light-buffer", "shadow-resolution", "shadow-cascades", "prefilter", "resolution-scale", "probes"});
  REQUIRE(c.terms.size() == 1);
  CHECK(c.terms[0].name == "resolution-scale");
  CHECK(idleReason(c, "light-buffer") == "lighting develops in place here: the frame has no light buffer");
  CHECK(idleReason(c, "shadow-resolution") == "a light that casts shadows would call for it");
  CHECK(idleReason(c, "shadow-cascades") == "no directional light in view casts shadows");
  CHECK(idleReason(c, "prefilter") == "the surroundings are one colour: there is nothing to filter");
  CHECK(idleReason(c, "probes") == "the scene has no probes, and no rooms were found in it");
  CHECK(idleReason(c, "normal-storage").empty());
  // No time at all: nothing is measured, and it is said of each.
  const cost::Choices late = s.choices({}, 1e-9);
  CHECK(late.terms.empty());
  CHECK(idleReason(late, "normal-storage") == "the time was up");
}

TEST_CASE("choices: a mirror shows what a small cube of the surroundings blurs; filtering takes longer for a larger one", "[choices]") {
  ChoiceStage s;
  Material mirror;
  mirror.substance = 1;
  mirror.albedo = vec3(0.9f);
  mirror.roughness = 0.05f;
  place(s.scene, sphere(1, 48, 96), mirror);
  Environment& e = s.scene.environment;
  e.map = makeImage(512, 256, 3, PixelType::F32);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x)
      for (int c = 0; c < 3; ++c) e.map.f32()[3 * (y * 512 + x) + c] = (x / 8 + y / 8) % 2 ? 2.0f : 0.2f + 0.1f * float(c);
  e.background = false;
  s.view = lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f);
  s.options.size = {72, 72};
  s.options.rounds = 3;
  const cost::Choices c = s.choices({"prefilter"});
  REQUIRE(c.terms.size() == 1);
  print(c.terms[0]);
  const TermCost& t = c.terms[0];
  CHECK(rungNamed(t, "256 at 1e-04").inForce);
  CHECK(rungNamed(t, "64 at 1e-04").exact.rms > rungNamed(t, "128 at 1e-04").exact.rms);
  CHECK(rungNamed(t, "128 at 1e-04").exact.rms > rungNamed(t, "512 at 1e-04").exact.rms);
  CHECK(t.rungs.back().exact.rms == 0);
  CHECK(rungNamed(t, "64 at 1e-04").passMs.median < t.rungs.back().passMs.median);
  // The light itself is the same: the surroundings' mean on the ball.
  for (const RungCost& r : t.rungs) CHECK(std::abs(r.exact.energy) < 0.03);
}

TEST_CASE("choices: probes of a room that is found, by number and by bounces", "[choices]") {
  ChoiceStage s;
  Material wall;
  wall.albedo = vec3(0.7f);
  wall.roughness = 0.8f;
  place(s.scene, box({-2, 0, -2}, {2, 2.6f, 2}, true), wall);
  place(s.scene, box({0.4f, 0, -0.8f}, {1.2f, 0.8f, 0}), wall);
  addLight(s.scene, light(LightKind::Point, vec3(1), 30, 8), {-1, 2.2, 0.5});
  s.view = lookAt({-1.2, 1.4, 1.6}, {0.5, 0.8, -0.6}, {0, 1, 0}, 1.0f);
  s.options.size = {64, 48};
  s.options.rounds = 3;
  const cost::Choices c = s.choices({"probes"});
  if (c.terms.empty()) FAIL(idleReason(c, "probes"));
  const TermCost& t = c.terms[0];
  print(t);
  CHECK(t.calledBy == "1 room that was found");
  CHECK(t.exactRung == "1 of 1, 4 bounces");
  CHECK(rungNamed(t, "none").inForce);
  // Each bounce adds light: without probes there is none of it.
  const double none = rungNamed(t, "none").exact.energy, one = rungNamed(t, "1 of 1, 1 bounce").exact.energy, two = rungNamed(t, "1 of 1, 2 bounces").exact.energy;
  CHECK(none < one);
  CHECK(one < two);
  CHECK(two < 0);
  CHECK(rungNamed(t, "none").exact.rms > rungNamed(t, "1 of 1, 2 bounces").exact.rms);
  CHECK(rungNamed(t, "1 of 1, 1 bounce").passMs.median > 0);
}
