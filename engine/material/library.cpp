// The library of named substances. Nobody paints substance by hand: a name gives the number, and the number says where
// it comes from.
//
// Dielectrics: the index of refraction at 589 nm. Conductors: reflectance at normal incidence, ((n-1)² + k²) / ((n+1)²
// + k²), from the optical constants named in the row (as collected by refractiveindex.info, public domain), integrated
// from 380 to 700 nm over illuminant D65 with the CIE 1931 observer (the fit of Wyman, Sloan and Shirley, "Simple
// Analytic Approximations to the CIE XYZ Color Matching Functions", 2013), brought to linear Rec.709 and clamped to [0,
// 1] (gold's red is 1.04: it lies outside the gamut).
//
// eta and k of a conductor are effective values, one pair for each of red, green and blue. The same integral over the
// reflectance at an angle gives a channel's curve; eta is the index whose exact curve (unpolarised conductor Fresnel)
// errs least from it between 0 and 89 degrees, k follows from eta and F0, F0 = ((eta-1)² + k²) / ((eta+1)² + k²), so
// that normal incidence is the row's F0. Where F0 is above 0.999 (gold's red, clamped) k is that of 0.999: no finite k
// reflects all. The curves are off by at most 0.0071 (gold's red at 89 degrees, for the clamp; brass 0.0039, copper
// 0.0031, the others but platinum 0.0013). The mean of n over the channel's sensitivity in place of the fit errs by up to 0.039
// (copper's red, where n changes sixfold), Schlick's curve by up to 0.21 (tungsten, toward grazing). Platinum's f0
// comes without n and k: its eta is from those of another author, whose F0 is within 0.0063.
//
// tests/unit/material_conductors_test.cpp does the integrals and the fit again.
#include "material/library.h"

#include <burnish/material.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace burnish {
namespace {

constexpr Substance dielectric(std::string_view name, float ior, std::string_view source) {
  const float f0 = f0FromIor(ior);
  return {.name = name, .ior = ior, .f0 = {f0, f0, f0}, .source = source};
}

constexpr double root(double x) {  // Newton; std::sqrt is not constexpr
  double r = std::max(x, 1.0);
  for (int i = 0; i < 40; ++i) r = (r + x / r) / 2;
  return r;
}
/// ((n-1)² + k²) / ((n+1)² + k²) = F0 solved for k.
constexpr float extinction(double n, double f0) {
  const double held = std::min(f0, 0.999);
  return float(root((held * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - held)));
}
constexpr Substance conductor(std::string_view name, glm::vec3 f0, glm::vec3 eta, std::string_view source) {
  const glm::vec3 k(extinction(eta.x, f0.x), extinction(eta.y, f0.y), extinction(eta.z, f0.z));
  return {.name = name, .conductor = true, .f0 = f0, .eta = eta, .k = k, .source = source};
}

constexpr std::array kSubstances = {
    // clang-format off
    dielectric("acrylic", 1.491f, "PMMA, Sultanova et al. 2009"),
    conductor("aluminium", {0.908f, 0.916f, 0.922f}, {1.487f, 0.987f, 0.603f}, "n, k of Rakić 1995"),
    dielectric("amber", 1.54f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("amethyst", 1.544f, "quartz, Ghosh 1999"),
    dielectric("aquamarine", 1.577f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    conductor("brass", {0.908f, 0.779f, 0.423f}, {0.460f, 0.522f, 1.124f}, "n, k of Querry 1985, 70 % Cu, 30 % Zn"),
    dielectric("calcite", 1.658f, "marble and limestone; Ghosh 1999, ordinary ray"),
    dielectric("cellulose", 1.53f, "cotton, paper and wood fibres, Polymer Data Handbook"),
    conductor("chromium", {0.550f, 0.556f, 0.554f}, {3.246f, 3.114f, 2.284f}, "n, k of Johnson and Christy 1974"),
    conductor("cobalt", {0.683f, 0.655f, 0.616f}, {2.253f, 2.036f, 1.712f}, "n, k of Johnson and Christy 1974"),
    conductor("copper", {0.929f, 0.624f, 0.522f}, {0.224f, 1.041f, 1.295f}, "n, k of Johnson and Christy 1972"),
    dielectric("cornea", 1.376f, "Patel et al. 1995"),
    dielectric("crown glass", 1.517f, "Schott N-BK7 data sheet"),
    dielectric("cubic zirconia", 2.16f, "Wood and Nassau 1982"),
    dielectric("diamond", 2.417f, "Peter 1923"),
    dielectric("emerald", 1.58f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("ethanol", 1.361f, "CRC Handbook of Chemistry and Physics, 20 °C"),
    dielectric("flint glass", 1.728f, "Schott SF10 data sheet"),
    dielectric("fused quartz", 1.458f, "Malitson 1965"),
    dielectric("garnet", 1.77f, "almandine to pyrope, Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("glass", 1.5f, "soda-lime window glass is 1.52 (Rubin 1985); 1.5 gives glTF's F0 0.04"),
    conductor("gold", {1.000f, 0.729f, 0.364f}, {0.358f, 0.496f, 1.468f}, "n, k of Johnson and Christy 1972"),
    dielectric("hair", 1.55f, "Marschner et al. 2003"),
    dielectric("ice", 1.31f, "Warren and Brandt 2008; its F0 of 0.018 is held at the codec's 0.0196"),
    conductor("iron", {0.529f, 0.513f, 0.494f}, {2.922f, 2.919f, 2.546f}, "n, k of Johnson and Christy 1974"),
    dielectric("ivory", 1.54f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("jade", 1.66f, "jadeite, Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("lapis lazuli", 1.5f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("lead crystal", 1.545f, "24 % PbO crystal glass, EU directive 69/493/EEC"),
    conductor("mercury", {0.781f, 0.779f, 0.778f}, {2.037f, 1.522f, 1.023f}, "n, k of Inagaki et al. 1981"),
    dielectric("milk", 1.35f, "Jääskeläinen et al. 2001"),
    dielectric("moissanite", 2.65f, "silicon carbide, Shaffer 1971"),
    conductor("nickel", {0.696f, 0.641f, 0.563f}, {2.030f, 1.904f, 1.728f}, "n, k of Johnson and Christy 1974"),
    dielectric("obsidian", 1.5f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("olive oil", 1.467f, "CRC Handbook of Chemistry and Physics"),
    dielectric("opal", 1.45f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    conductor("palladium", {0.732f, 0.697f, 0.652f}, {1.792f, 1.623f, 1.395f}, "n, k of Johnson and Christy 1974"),
    dielectric("pearl", 1.6f, "Read, Gemmology (3rd ed.), table of refractive indices (1.53 to 1.69)"),
    dielectric("peridot", 1.67f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("pet", 1.575f, "polyethylene terephthalate, Polymer Data Handbook"),
    dielectric("plastic", 1.5f, "glTF 2.0: F0 0.04; common polymers lie between 1.41 and 1.59"),
    conductor("platinum", {0.672f, 0.637f, 0.585f}, {2.352f, 2.070f, 1.826f}, "Lagarde 2011 (Feeding a physically based shading model), from Palik; eta of Rakić et al. 1998"),
    dielectric("polycarbonate", 1.585f, "Sultanova et al. 2009"),
    dielectric("polystyrene", 1.592f, "Sultanova et al. 2009"),
    dielectric("ptfe", 1.35f, "Polymer Data Handbook"),
    dielectric("quartz", 1.544f, "Ghosh 1999, ordinary ray"),
    dielectric("rubber", 1.519f, "natural rubber, Polymer Data Handbook"),
    dielectric("ruby", 1.77f, "corundum, Malitson and Dodge 1972, ordinary ray"),
    dielectric("rutile", 2.61f, "titanium dioxide, DeVore 1951, ordinary ray"),
    dielectric("salt", 1.544f, "sodium chloride, Li 1976"),
    dielectric("sapphire", 1.768f, "corundum, Malitson and Dodge 1972, ordinary ray"),
    dielectric("silicone", 1.41f, "PDMS, Polymer Data Handbook"),
    conductor("silver", {0.989f, 0.984f, 0.978f}, {0.056f, 0.055f, 0.043f}, "n, k of Johnson and Christy 1972"),
    dielectric("skin", 1.4f, "Ding et al. 2006 (1.38 to 1.45 over the visible range)"),
    dielectric("spinel", 1.718f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    conductor("steel", {0.669f, 0.639f, 0.598f}, {2.404f, 2.023f, 1.651f}, "n, k of Karlsson and Ribbing 1982, austenitic stainless steel"),
    conductor("titanium", {0.618f, 0.580f, 0.543f}, {2.743f, 2.509f, 2.239f}, "n, k of Johnson and Christy 1974"),
    dielectric("topaz", 1.62f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("tourmaline", 1.63f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    conductor("tungsten", {0.516f, 0.496f, 0.467f}, {3.634f, 3.495f, 3.315f}, "n, k of Weaver et al. 1975"),
    dielectric("turquoise", 1.61f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    dielectric("water", 1.333f, "CRC Handbook of Chemistry and Physics, 20 °C"),
    dielectric("wax", 1.44f, "paraffin, CRC Handbook of Chemistry and Physics"),
    conductor("zinc", {0.875f, 0.869f, 0.855f}, {1.209f, 0.914f, 0.660f}, "n, k of Werner et al. 2009"),
    dielectric("zircon", 1.95f, "Read, Gemmology (3rd ed.), table of refractive indices"),
    // clang-format on
};

struct Alias {
  std::string_view name, of;
};
constexpr Alias kAliases[] = {{"aluminum", "aluminium"},      {"chrome", "chromium"}, {"corundum", "sapphire"},
                              {"cotton", "cellulose"},        {"pmma", "acrylic"},    {"paper", "cellulose"},
                              {"stainless steel", "steel"},   {"marble", "calcite"},  {"teflon", "ptfe"},
                              {"titanium dioxide", "rutile"}, {"wood", "cellulose"}};

constexpr char fold(char c) {
  if (c == '-' || c == '_') return ' ';
  return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}
bool same(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return fold(x) == fold(y); });
}

// Levenshtein distance of folded names, one row at a time.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (fold(a[i - 1]) == fold(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view material::nearestSubstance(std::string_view name) {
  constexpr std::size_t kLongest = 40;
  if (name.size() > kLongest) return {};
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  const auto consider = [&](std::string_view known) {
    if (const std::size_t d = distance(name, known); d < least) least = d, best = known;
  };
  for (const Substance& s : kSubstances) consider(s.name);
  for (const Alias& alias : kAliases) consider(alias.name);
  return best;
}

std::span<const Substance> substances() { return kSubstances; }

const Substance* findSubstance(std::string_view name) {
  for (const Alias& alias : kAliases)
    if (same(alias.name, name)) name = alias.of;
  for (const Substance& s : kSubstances)
    if (same(s.name, name)) return &s;
  return nullptr;
}

}  // namespace burnish
