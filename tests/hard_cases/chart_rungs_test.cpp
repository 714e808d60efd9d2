// The sphere chart: what each rung gets wrong against the exact rung of its term has the sign and size that a double quadrature, or the oracle at every pixel, predicts.
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string_view>

#include "hard_cases/chart.h"
#include "plan/rungs.h"
#include "reference/oracle.h"

using namespace burnish;
using namespace burnish::test;
namespace f64 = burnish::shading::f64;

namespace {

/// Rungs of light from lights: term and rung.
struct Choice {
  std::size_t term, rung;
};
std::size_t termNamed(std::string_view name) {
  for (std::size_t t = 0; t < terms().size(); ++t)
    if (terms()[t].name == name) return t;
  FAIL("no term " << name);
  return 0;
}
/// The last rung that the chart's materials exercise.
std::size_t exactRung(std::size_t term) {
  std::size_t last = terms()[term].rungs.size() - 1;
  while (last > 0 && terms()[term].rungs[last].forwardOnly) --last;
  return last;
}

std::vector<Choice> choices() {
  std::vector<Choice> all;
  for (const char* name : {"specular", "distribution", "geometry", "lobe", "fresnel", "diffuse", "compensation"}) {
    const std::size_t t = termNamed(name);
    for (std::size_t r = 0; r < exactRung(t); ++r) all.push_back({t, r});
  }
  return all;
}

}  // namespace

TEST_CASE("sphere chart: each rung's error against the exact one, substance by roughness, in the light of three suns", "[rung-errors]") {
  struct Ball {
    double substance, albedo, roughness;
  };
  std::vector<Ball> balls;
  for (const double substance : {1 / 3.0, 0.7, 1.0})
    for (const double roughness : {0.2, 0.5, 1.0}) balls.push_back({substance, 0.6, roughness});
  std::vector<Material> materials;
  for (const Ball& b : balls) {
    Material m;
    m.albedo = vec3(float(b.albedo));
    m.substance = float(b.substance);
    m.roughness = float(b.roughness);
    materials.push_back(m);
  }
  Chart chart(materials, 40);
  std::vector<reference::OracleLight> suns;
  for (const dvec3& to : {dvec3(0.3, 0.4, 1), dvec3(-1, 0.2, 0.3), dvec3(0.2, -1, -0.15)}) {
    suns.push_back({glm::normalize(to), dvec3(10.0)});
    addLight(chart.scene, light(LightKind::Directional, vec3(1), 10), {}, -to);
  }
  Stage stage;
  // What a picture and the oracle give for each ball: sums over the same pixels.
  const auto sums = [&](const Quality& q, std::vector<double>& shown, std::vector<double>& truth) {
    const Picture p = stage.linear(chart.scene, chart.view, chart.size, q);
    const shading::Rungs rungs = plan::rungsOf(q);
    shown.assign(balls.size(), 0), truth.assign(balls.size(), 0);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const double alpha = balls[i].roughness * balls[i].roughness;
      const auto energy = needsAlbedoTable(rungs) ? std::make_unique<reference::LobeEnergy>(rungs, alpha, 96) : nullptr;
      chart.each(i, 0.15, [&](int x, int y, const dvec3& n) {
        shown[i] += p.at(x, y).x;
        const f64::Surface m = reference::surfaceOf({n, {0, 0, 1}, dvec3(balls[i].albedo), balls[i].substance, alpha}, energy.get());
        for (const reference::OracleLight& sun : suns) truth[i] += f64::shadeDirection(m, sun.toLight, energy ? energy->at(glm::dot(m.n, sun.toLight)) : glm::dvec2(0), rungs).x * sun.irradiance.x;
      });
    }
  };
  std::optional<std::size_t> term;
  std::vector<double> exactShown, exactTruth;
  for (const Choice& c : choices()) {
    Quality q = forwardOf(Geometry::Kelemen);
    if (term != c.term) {
      setRung(q, c.term, exactRung(c.term));
      sums(q, exactShown, exactTruth);
      term = c.term;
    }
    setRung(q, c.term, c.rung);
    std::vector<double> shown, truth;
    sums(q, shown, truth);
    std::string line = fmt::format("  {}={} against {}:", terms()[c.term].name, terms()[c.term].rungs[c.rung].name, terms()[c.term].rungs[exactRung(c.term)].name);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const double off = shown[i] / exactShown[i] - 1, wanted = truth[i] / exactTruth[i] - 1;
      line += fmt::format(" {:+.1f}", 100 * off);
      INFO(line << " % of light, " << 100 * wanted << " % by the oracle");
      CHECK(std::abs(off - wanted) < 0.005 * (1 + std::abs(wanted)));
      if (std::abs(wanted) > 0.02) CHECK((off > 0) == (wanted > 0));
    }
    std::cout << line << " % of light\n";
  }
}

TEST_CASE("sphere chart: reflections of even surroundings by the rung, against the lobe's own albedo", "[rung-errors]") {
  // Against quadrature: Schlick's rung glows at rough edges, the rough one less, none loses all.
  std::vector<Material> materials;
  const std::vector<double> roughness = {0.2, 0.5, 1.0};
  for (const double r : roughness) {
    Material m;
    m.albedo = vec3(0);  // black plastic
    m.roughness = float(r);
    materials.push_back(m);
  }
  Chart chart(materials, 64);
  chart.scene.environment.color = vec3(1);
  Stage stage;
  const double f0 = f64::substanceF0(double(Material{}.substance), dvec3(0)).x;
  for (const EnvironmentSpecular rung : {EnvironmentSpecular::Schlick, EnvironmentSpecular::RoughSchlick}) {
    Quality q = forwardOf(Geometry::Kelemen);
    q.environmentSpecular = rung;
    const Picture p = stage.linear(chart.scene, chart.view, chart.size, q);
    const shading::Rungs rungs = plan::rungsOf(q);
    for (std::size_t i = 0; i < roughness.size(); ++i)
      for (const double nov : {0.9, 0.5, 0.2}) {
        const glm::dvec2 e = reference::lobeAlbedo(rungs, nov, roughness[i] * roughness[i]);
        const double exact = f0 * e.x + e.y, most = rung == EnvironmentSpecular::Schlick ? 1 : std::max(1 - roughness[i], f0), formula = f0 + (most - f0) * std::pow(1 - nov, 5);
        const double off = chart.redAt(p, i, nov) - exact, wanted = formula - exact;
        std::cout << fmt::format("  environment-specular={}, roughness {}, n.v {}: off by {:+.4f} ({:+.4f} by quadrature)\n", terms()[termNamed("environment-specular")].rungs[std::size_t(rung)].name, roughness[i], nov, off, wanted);
        CHECK(off == Approx(wanted).margin(0.004));
        if (std::abs(wanted) > 0.008) CHECK((off > 0) == (wanted > 0));
      }
  }
}
