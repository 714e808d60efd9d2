// The library of named substances: order, look-up, and its conductors against their optical constants.
#include <burnish/material.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace burnish;

TEST_CASE("Substances are sorted, sourced and plausible", "[material]") {
  const auto all = substances();
  REQUIRE(all.size() >= 60);
  CHECK(std::is_sorted(all.begin(), all.end(), [](const Substance& a, const Substance& b) { return a.name < b.name; }));
  for (const Substance& s : all) {
    INFO(s.name);
    CHECK(s.source.size() > 6);
    CHECK(findSubstance(s.name) == &s);
    for (int c = 0; c < 3; ++c) {
      CHECK(s.f0[c] > (s.conductor ? 0.3f : 0.015f));
      CHECK(s.f0[c] <= (s.conductor ? 1.0f : 0.25f));
    }
    if (!s.conductor) {
      CHECK(s.f0.x == Approx(f0FromIor(s.ior)));
      // A named dielectric survives the 8-bit code: 0.0036 is half a step where steps are widest (F0 0.25).
      const float byte = std::round(encodeDielectric(s.f0.x) * 255);
      CHECK(decodeSubstance(byte / 255, glm::vec3(0)).f0.x == Approx(std::max(s.f0.x, 0.0196f)).margin(0.0018));
    }
  }
}

TEST_CASE("Substances are found whatever the spelling", "[material]") {
  REQUIRE(findSubstance("Cubic-Zirconia"));
  CHECK(findSubstance("cubic_zirconia") == findSubstance("CUBIC ZIRCONIA"));
  CHECK(findSubstance("aluminum") == findSubstance("aluminium"));
  CHECK(findSubstance("unobtainium") == nullptr);
  CHECK(findSubstance("") == nullptr);
  CHECK(findSubstance("water")->ior == Approx(1.333f));
  CHECK(findSubstance("ruby")->ior == Approx(1.77f));
  CHECK(findSubstance("diamond")->ior == Approx(2.417f));
}

namespace {

struct OpticalConstants {
  double nm, n, k;
};
// Johnson and Christy, Phys. Rev. B 6, 4370 (1972), room temperature.
const std::vector<OpticalConstants> kGold = {{397.4, 1.47, 1.952}, {413.3, 1.46, 1.958}, {430.5, 1.45, 1.948},
                                             {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833},
                                             {520.9, 0.62, 2.081}, {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863},
                                             {616.8, 0.21, 3.272}, {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103}};
const std::vector<OpticalConstants> kSilver = {{397.4, 0.05, 2.070}, {413.3, 0.05, 2.275}, {430.5, 0.04, 2.462},
                                               {450.9, 0.04, 2.657}, {471.4, 0.05, 2.869}, {495.9, 0.05, 3.093},
                                               {520.9, 0.05, 3.324}, {548.6, 0.06, 3.586}, {582.1, 0.05, 3.858},
                                               {616.8, 0.06, 4.152}, {659.5, 0.05, 4.483}, {704.5, 0.04, 4.838}};
const std::vector<OpticalConstants> kCopper = {{397.4, 1.32, 2.116}, {413.3, 1.28, 2.207}, {430.5, 1.25, 2.305},
                                               {450.9, 1.24, 2.397}, {471.4, 1.25, 2.483}, {495.9, 1.22, 2.564},
                                               {520.9, 1.18, 2.608}, {548.6, 1.02, 2.577}, {582.1, 0.70, 2.704},
                                               {616.8, 0.30, 3.205}, {659.5, 0.22, 3.747}, {704.5, 0.21, 4.205}};
// The same authors, Phys. Rev. B 9, 5056 (1974).
const std::vector<OpticalConstants> kIron = {
    {397, 2.24, 2.58}, {413, 2.35, 2.65}, {431, 2.48, 2.71}, {451, 2.59, 2.77}, {471, 2.67, 2.82}, {496, 2.74, 2.88},
    {521, 2.86, 2.91}, {549, 2.95, 2.93}, {582, 2.94, 2.99}, {617, 2.88, 3.05}, {659, 2.92, 3.10}, {704, 2.86, 3.19}};
// CIE standard illuminant D65, 380 to 700 nm in steps of 10.
constexpr std::array kD65 = {49.98,  54.65,  82.75,  91.49,  93.43,  86.68,  104.86, 117.01, 117.81, 114.86, 115.92,
                             108.81, 109.35, 107.80, 104.79, 107.69, 104.41, 104.05, 100.00, 96.33,  95.79,  88.69,
                             90.01,  89.60,  87.70,  83.29,  83.70,  80.03,  80.21,  82.28,  78.28,  69.72,  71.61};

double lobe(double x, double mean, double below, double above) {
  const double t = (x - mean) * (x < mean ? below : above);
  return std::exp(-0.5 * t * t);
}
// Wyman, Sloan, Shirley 2013, equation 4.
glm::dvec3 observer(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

double reflectance(const std::vector<OpticalConstants>& metal, double nm) {
  const auto above =
      std::find_if(metal.begin() + 1, metal.end() - 1, [nm](const OpticalConstants& o) { return o.nm >= nm; });
  const OpticalConstants &a = *(above - 1), &b = *above;
  const double t = std::clamp((nm - a.nm) / (b.nm - a.nm), 0.0, 1.0), n = a.n + t * (b.n - a.n),
               k = a.k + t * (b.k - a.k);
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

glm::dvec3 rec709(const std::vector<OpticalConstants>& metal) {
  const glm::dmat3 fromXyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560,
                           1.0572252);
  glm::dvec3 color(0), white(0);
  for (int nm = 380; nm <= 700; nm += 2) {
    const std::size_t at = std::size_t(nm - 380) / 10;
    const double light =
        at + 1 < kD65.size() ? kD65[at] + (kD65[at + 1] - kD65[at]) * double((nm - 380) % 10) / 10 : kD65[at];
    color += light * reflectance(metal, nm) * observer(nm);
    white += light * observer(nm);
  }
  return (fromXyz * color) / (fromXyz * white);
}

}  // namespace

TEST_CASE("Conductors follow from their optical constants", "[material]") {
  const std::pair<const char*, const std::vector<OpticalConstants>*> metals[] = {
      {"gold", &kGold}, {"silver", &kSilver}, {"copper", &kCopper}, {"iron", &kIron}};
  for (const auto& [name, table] : metals) {
    INFO(name);
    const glm::dvec3 expected = glm::clamp(rec709(*table), 0.0, 1.0);
    for (int c = 0; c < 3; ++c) CHECK(double(findSubstance(name)->f0[c]) == Approx(expected[c]).margin(0.002));
  }
}
