// H29 of docs/hard_cases.md: a white furnace from end to end. White surroundings are captured and prefiltered, and light balls through a probe's box and the quantised G-buffer: each pixel shows the
// directional albedo of its rungs, by quadrature in double.
#include "probe/probes.h"
#include "stability/white_furnace.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr float kWhite = 700;  // cd/m²
constexpr int kCell = 32;      // pixels a ball
constexpr double kBound = 0.02;

const std::vector<stability::FurnacePaint> kPaints = {{0, 1}, {1 / 3.0, 1}, {0.4, 1}, {1, 1}, {0, 0.5}, {1 / 3.0, 0.5}, {0.4, 0.2}, {0.7, 0.5}, {1, 0.5}, {1 / 3.0, 0.05}};
const std::vector<double> kRoughness = {0.05, 0.2, 0.4, 0.6, 0.8, 1};

ProbeSet capturedWhite(vec3 low, vec3 high) {
  Scene white;
  white.environment.color = vec3(kWhite);
  ProbeSet places;
  // Off the middle of the box: lookups are re-aimed.
  places.reflections.push_back(probeIn(low, high, dvec3(low) * 0.7 + dvec3(high) * 0.3));
  Observatory o(std::move(white));
  BakeOptions options;
  options.size = 32;
  options.bounces = 1;
  Bake bake;
  bake.run(o, places, options);
  return bake.set;
}

stability::FurnaceFound furnace(const ProbeSet& probes, const Quality& q) {
  Stage stage;
  const auto draw = [&](const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality) -> Result<Image> { return stage.linear(scene, view, size, quality).image; };
  auto found = stability::whiteFurnace(draw, {kPaints, kRoughness, kCell, double(kWhite)}, q, [&](Scene& scene) {
    scene.environment.color = vec3(kWhite / 10);  // what gets past the box shows
    scene.probes = probes;
  });
  if (!found) FAIL(found.error().message());
  return *found;
}

void check(const char* name, const Quality& q, bool unity = false, double sampling = 0) {
  const vec3 low(-1, -2, -3), high(2 * float(kPaints.size()) + 2, 2 * float(kRoughness.size()) + 1, 4);
  const stability::FurnaceFound r = furnace(capturedWhite(low, high), q);
  std::cout << fmt::format("  white furnace, {}: {} pixels within {:+.2f} % of their albedo ({}), {} by more than 2 %{}\n", name, r.pixels, 100 * r.worst, r.where, r.off, unity ? fmt::format(", white ones within {:+.2f} % of 1", 100 * r.unity) : "");
  CHECK(r.pixels > 40000);
  CHECK(std::abs(r.worst) < kBound + sampling);
  if (unity) CHECK(std::abs(r.unity) < kBound);
  CHECK(double(r.off) <= (sampling > 0 ? 0.005 : 0) * double(r.pixels));
}

}  // namespace

TEST_CASE("white furnace: through capture, filter, box and G-buffer, the default preset", "[h29]") { check("default", Quality{}); }

TEST_CASE("white furnace: with compensation and coupled diffuse nothing is lost", "[h29]") {
  Quality q;
  q.compensation = Compensation::MultipleScattering;
  q.diffuse = Diffuse::Coupled;
  check("compensated", q, true);
}

TEST_CASE("white furnace: the seed preset", "[h29][sweep]") {
  Quality q;
  REQUIRE(setPreset(q, "seed"));
  check("seed", q);
}

TEST_CASE("white furnace: the exact preset", "[h29][sweep]") {
  Quality q;
  REQUIRE(setPreset(q, "exact"));
  // The lobe is summed over 256 samples. Toward grazing, where some of them fall below the horizon, their number is off by a standard error of 1/sqrt(256) of its spread: held at that here.
  check("exact", q, false, 1 / 16.0 - kBound);
}
