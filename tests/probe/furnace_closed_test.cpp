// Closed furnaces: every wall gives off e and reflects a share of what comes. Light converges to e/(1 - share), at the probes and on the walls as the renderer draws them.
#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr vec3 kLow(-1.5f, -1, -2), kHigh(2.5f, 1.5f, 1);
constexpr double kEmission = 3;

/// Diffuse alone: no reflections of the surroundings, and a diffuse rung that leaves nothing to the lobe.
Quality matte() {
  Quality q;
  q.environmentSpecular = EnvironmentSpecular::None;
  q.diffuse = Diffuse::Lambert;
  return q;
}

struct Furnace {
  Scene scene;
  ProbeSet places;
  explicit Furnace(const Material& wall) {
    addRoom(scene, kLow, kHigh, wall);
    places.reflections.push_back(probeIn(kLow, kHigh, {0.3, 0.2, -0.4}));
  }
};

Material wallOf(double albedo) {
  Material m;
  m.albedo = vec3(float(albedo));
  m.emission = vec3(float(kEmission));
  m.substance = 0.4f;
  return m;
}

/// The reflected share as the G-buffer holds it: the root in 8 bits (docs/shading.md, section 2).
double stored(double albedo) {
  const double root = std::round(std::sqrt(albedo) * 255) / 255;
  return root * root;
}

}  // namespace

TEST_CASE("furnace: a closed room of diffuse emitters", "[furnace]") {
  BakeOptions options;
  options.quality = matte();
  options.size = 16;
  for (const double albedo : {0.2, 0.5, 0.8, 0.9}) {
    Furnace furnace(wallOf(albedo));
    Report report;
    Observatory o(probe::limited(furnace.scene, options.albedoLimit, options.quality, report), options.quality);
    CHECK(report.empty());
    Bake bake;
    std::vector<double> light;
    while (bake.bounce(o, furnace.places, options)) {
      light.push_back(bake.set.reflections[0].irradiance[0][0]);
      // Bounce k has the first k terms of e Σ ρ^i. Cubes that light are stored in half floats; irradiance is not.
      double sum = 0, term = kEmission;
      for (std::size_t i = 0; i < light.size(); ++i, term *= stored(albedo)) sum += term;
      CHECK(light.back() == Approx(sum).epsilon(1e-3));
    }
    CHECK(bake.error.empty());
    REQUIRE(bake.bounces.size() >= 3);
    const double truth = kEmission / (1 - albedo);
    for (const IrradianceSh& sh : {bake.set.reflections[0].irradiance})
      for (int c = 0; c < 3; ++c) CHECK(sh[0][std::size_t(c)] == Approx(truth).epsilon(0.02));
    double low = 1e9, high = 0;
    eachTexel(bake.lights[0].radiance.levels[0], [&](int, int, int, const dvec3&, const dvec3& l) { low = std::min(low, l.x), high = std::max(high, l.x); });
    CHECK(low > truth * 0.98);
    CHECK(high < truth * 1.02);
    // The estimate against what is missing of the sum that the stored albedo has.
    const double limit = kEmission / (1 - stored(albedo));
    for (std::size_t k = 1; k < light.size(); ++k) {
      const double missing = (limit - light[k]) / light[k];
      CHECK(bake.bounces[k].rest == Approx(missing).epsilon(0.02).margin(2e-4));
    }
    CHECK(bake.bounces.back().rest <= 0.01);
    // The walls as rendered.
    Stage stage;
    Scene lit = furnace.scene;
    lit.probes = bake.set;
    const Picture p = stage.linear(lit, lookAt({-1, 0.3, 0.5}, {2, 0, -1.5}, {0, 1, 0}, 1.2f), {64, 48}, options.quality);
    double worst = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) worst = std::max(worst, std::abs(p.at(x, y).y / truth - 1));
    CHECK(worst < 0.02);
    std::cout << fmt::format("  furnace, albedo {}: {} bounces, probe {:+.2f} %, walls within {:.2f} %, rest {:.4f} estimated, {:.4f} missing\n", albedo, bake.bounces.size(), 100 * (light.back() / truth - 1),
                             100 * worst, bake.bounces.back().rest, (limit - light.back()) / light.back());
  }
}

TEST_CASE("furnace: walls that reflect all of it are held at the limit, and without one light grows", "[furnace]") {
  BakeOptions options;
  options.quality = matte();
  options.size = 16;
  options.bounces = 6;
  Furnace furnace(wallOf(1));
  {
    Report report;
    Observatory o(probe::limited(furnace.scene, options.albedoLimit, options.quality, report), options.quality);
    CHECK(report.warnings().size() == 1);  // six walls of materials without a name
    Bake bake;
    bake.run(o, furnace.places, options);
    CHECK(bake.error.empty());
    CHECK(bake.bounces.back().ratio == Approx(stored(0.98)).epsilon(1e-3));
    // The estimate knows of all the light that is still to come.
    CHECK(bake.bounces.back().rest == Approx((kEmission / (1 - stored(0.98)) - bake.bounces.back().light) / bake.bounces.back().light).epsilon(0.05));
  }
  {
    // White, and beside that a lobe that diffuse does not know of: 1 + 0.0196 + 0.98/21 in all.
    options.quality.environmentSpecular = EnvironmentSpecular::Dfg;
    Observatory o(furnace.scene, options.quality);
    Bake bake;
    bake.run(o, furnace.places, options);
    CHECK(bake.error.find("light grows") != std::string::npos);
    CHECK(bake.bounces.size() == 3);
  }
}

TEST_CASE("furnace: the estimate of the rest, where light is not even", "[furnace]") {
  // A ceiling that shines, walls of three colours, two probes with boxes of their own, one of them in a corner: each channel fades at its own pace.
  BakeOptions options;
  options.size = 32;
  options.until = 1e-5;
  std::array<Material, 6> walls;
  for (int w = 0; w < 6; ++w) walls[std::size_t(w)].albedo = vec3(0.3f + 0.1f * float(w), 0.8f, 0.5f);
  walls[3].emission = vec3(10, 8, 5);
  Furnace furnace(Material{});
  furnace.scene = Scene{};
  addRoom(furnace.scene, kLow, kHigh, walls);
  furnace.places.reflections.push_back(probeIn(kLow, vec3(-0.5f, 0.2f, -1), {-1.4, -0.9, -1.9}));
  Observatory o(furnace.scene, options.quality);
  Bake bake;
  std::vector<std::vector<IrradianceSh>> light;
  while (bake.bounce(o, furnace.places, options)) light.push_back({bake.lights[0].irradiance, bake.lights[1].irradiance});
  REQUIRE(bake.error.empty());
  REQUIRE(light.size() > 8);
  double least = 9, most = 0, stopped = 0;
  for (std::size_t k = 2; k < light.size() && bake.bounces[k].rest > 1e-3; ++k) {
    const probe::Change missing = probe::changeOf(light[k], light.back());
    const double factor = bake.bounces[k].rest / (missing.share * missing.light / bake.bounces[k].light);
    least = std::min(least, factor);
    most = std::max(most, factor);
    if (stopped == 0 && bake.bounces[k].rest <= BakeOptions{}.until) stopped = factor;
  }
  std::cout << fmt::format("  furnace, one bright wall: {} bounces, from the third on the rest is estimated {:.2f} to {:.2f} times what is missing, {:.2f} times where a bake ends\n", bake.bounces.size(), least, most,
                           stopped);
  // What fades slowest is not yet what most of the light is: q grows from bounce to bounce.
  CHECK(least > 0.5);
  CHECK(most < 1.1);
  CHECK(stopped == Approx(1).epsilon(0.1));
}

TEST_CASE("furnace: white walls give back no more than the limit, whatever the rungs", "[furnace][sweep]") {
  Quality standard, lambert, seed, whole;
  lambert.diffuse = Diffuse::Lambert;
  REQUIRE(setPreset(seed, "seed"));
  whole.compensation = Compensation::MultipleScattering;
  whole.diffuse = Diffuse::Coupled;
  BakeOptions options;
  options.size = 16;
  options.bounces = 4;
  // Albedo is held in roots of 8 bits, which are off by half a step, 0.4 % near 1.
  const double rounding = 0.004;
  double most = 0;
  for (const Quality& q : {standard, lambert, seed, whole})
    for (const float substance : {0.0f, 1.0f / 3, 0.6f, 1.0f})
      for (const float roughness : {0.1f, 1.0f}) {
        Material white = wallOf(1);
        white.substance = substance;
        white.roughness = roughness;
        Furnace furnace(white);
        options.quality = q;
        Report report;
        Observatory o(probe::limited(furnace.scene, options.albedoLimit, q, report), q);
        Bake bake;
        bake.run(o, furnace.places, options);
        CAPTURE(int(q.diffuse), int(q.compensation), substance, roughness);
        CHECK(bake.error.empty());
        CHECK(report.warnings().size() == 1);
        CHECK(bake.bounces.back().ratio < 0.98 + rounding);
        // Smooth walls lose nothing: the limit takes no more than it has to. (From the probe's place most of them are seen at an angle, at which Fresnel's share is not yet its mean.)
        if (roughness < 0.5f && q.diffuse == Diffuse::Coupled) CHECK(bake.bounces.back().ratio > 0.98 - 0.015);
        most = std::max(most, bake.bounces.back().ratio);
      }
  std::cout << fmt::format("  furnace of white walls, limit 0.98: q is {:.4f} at most\n", most);
}
