// The table's rows for functions of numbers: conversions, lobes, distributions, normalizations, visibility.
#include <cfloat>

#include "shading/test_rungs.h"
#include "text_bounds.h"
#include "text_domains.h"

namespace burnish::test {
namespace {

double powerOf(const Case& in) { return double(in[0].y); }

/// An ulp of a cosine near 1 costs p times as much in its power.
Scale ulpsOfCosine() {
  return {" of the peak or of p ulp", [](const Row&, const Case& in, const glm::dvec4&, int) { return std::min(1.0, 1e-5 + powerOf(in) * 0x1p-23); }};
}
Scale ofPeak() {
  return {" of the peak", [](const Row& row, const Case& in, const glm::dvec4&, int k) { return row.ranges(row, in)[std::size_t(k)].hi; }};
}

/// (n·h, p, |n×h|², |r - v|²), inside the lobe; b: n·l + n·v and 1/|l + v|².
Case insideLobe(Random& random) {
  const float p = kPower.ordinary(random), x = std::min(1.0f, uniform(random, 0, 12) / (p + 2)), s = uniform(random, 0.5f, 2), c = std::sqrt(1 - x);
  return {glm::vec4(c, p, x, std::min(2.0f, uniform(random, 0, 24) / (0.25f * p + 1))), glm::vec4(c * s, 1 / (s * s), 0, 0)};
}
const Domain kLobe{"lobes", insideLobe, numbers("", {kCosine, kPower, kSin2, kAny, kAny, kAny}).adverse};
const Domain kConversion = numbers("conversions", {kUnit, kAlpha, kPower});
const Domain kDistributions = numbers("distributions", {kSin2, kAlpha, kUnit, kPower});
const Domain kNormalizations = numbers("normalizations", {kZero, kPower});
const Domain kVisibility = numbers("visibility", {kCosine, kCosine, kAlpha, kCosine, kCosine});
const Domain kMasking = numbers("masking", {kCosine, kCosine, kAlphaUnit, kCosine, kCosine});
const Domain kPixels = numbers("pixels", {kUnit, kAny, kAny, kAny, kAny, kAny, kAny});
const Domain kLogarithms = numbers("logarithms", {kUnit, kPower});

/// a: heights (m) over the reference, way, clear part; b: extinction, falloff, cosine, g. Half of the ways are level or nearly so.
Case throughFog(Random& random) {
  const float way = std::exp2(uniform(random, -4, 20)), slope = random() & 1 ? uniform(random, -1, 1) : std::exp2(-uniform(random, 4, 30));
  const float falloff = random() % 4 ? std::exp2(uniform(random, -16, 0)) : 0.0f, from = std::min(uniform(random, -5, 5) / std::max(falloff, 0.01f), 1e4f);
  const float to = std::max(from + slope * way, -5 / std::max(falloff, 1e-6f));
  return {glm::vec4(from, to, way, random() & 1 ? 0.0f : uniform(random, 0, 0.5f) * way), glm::vec4(std::exp2(uniform(random, -20, 0)), falloff, uniform(random, -1, 1), uniform(random, -0.9f, 0.9f))};
}
Case hardFog(Random& random) {
  return {glm::vec4(kAny.adverse(random), kAny.adverse(random), std::abs(kAny.adverse(random)), std::abs(kAny.adverse(random))),
          glm::vec4(std::abs(kAny.adverse(random)), std::abs(kAny.adverse(random)), std::min(kUnit.adverse(random) * 2 - 1, 1.0f), kUnit.adverse(random) * 1.9f - 0.95f)};
}
const Domain kFog{"fog", throughFog, hardFog};

/// A direction's components along tangent and bitangent, and two widths.
const Domain kTwoWidths = numbers("two widths", {kAny, kAny, kAlpha, kAlpha, kUnit});

}  // namespace

void addConversions(std::vector<Row>& rows) {
  rows.push_back({"alphaFromRoughness, alphaFromPower, sigmaFromAlpha, phongFromBlinnPhong", {}, &kConversion,
                  TEXT(vec4(alphaFromRoughness(a.x), alphaFromPower(a.z), sigmaFromAlpha(a.y), phongFromBlinnPhong(a.z))), {}, 0, ulp(), 3,
                  ranges({0, 1}, {0, 1}, {-FLT_MAX, FLT_MAX}, {0, FLT_MAX})});
  rows.push_back({"blinnPhongFromPhong, ggxFromBeckmann, beckmannFromGgx, storedAlpha", {}, &kConversion,
                  TEXT(vec4(blinnPhongFromPhong(phongFromBlinnPhong(a.z)), ggxFromBeckmann(a.x), beckmannFromGgx(a.x), storedAlpha(a.x))), {}, 0, ulp(), 3,
                  ranges({0, FLT_MAX}, {0, 1.2937}, {0, 1}, {4e-4, 1})});
  rows.push_back({"powerFromAlpha", {}, &kConversion, TEXT(vec4(powerFromAlpha(a.y), R(0.0), R(0.0), R(0.0))), {}, 0,
                  {" ulp of p + 2", [](const Row&, const Case&, const glm::dvec4& exact, int) { return (exact.x + 2) * 0x1p-23; }}, 3, ranges({0, 2e12})});
  rows.push_back({"encodeAlpha, decodeAlpha", {}, &kConversion, TEXT(vec4(encodeAlpha(a.y), decodeAlpha(a.x), R(0.0), R(0.0))), {}, 0, absolute(), 8e-7, ranges({-1e-6, 1}, {4e-4, 1})});
  rows.push_back({"filteredAlpha", {rungName("specular-antialiasing", 1)}, &kPixels, TEXT(vec4(filteredAlpha(a.x, vec3(a.y, a.z, a.w), vec3(b.x, b.y, b.z)), R(0.0), R(0.0), R(0.0))), {}, 0, absolute(), 5e-7,
                  [](const Row&, const Case& in) { return Ranges{{{std::max(0.0, double(in[0].x) - 1e-6), std::min(1.0, std::sqrt(double(in[0].x) * double(in[0].x) + 0.18))}}}; }});
  rows.push_back({"logOneMinus, oneMinusExp", {}, &kLogarithms, TEXT(vec4(logOneMinus(a.x), oneMinusExp(a.y), R(0.0), R(0.0))), {}, 0, relative(), 1e-6,
                  ranges({-69.08, 0}, {0, 1})});  // ln BURNISH_GUARD_LOG
}

void addLobes(std::vector<Row>& rows) {
  const auto unit = ranges({0, 1});
  rows.push_back({"lobePow", {rungName("lobe", LOBE_POW)}, &kLobe, TEXT(vec4(lobePow(a.x, a.y), R(0.0), R(0.0), R(0.0))), {}, 0, ulpsOfCosine(), {3, 0.05}, unit});
  rows.push_back({"lobeExp2", {rungName("lobe", LOBE_EXP2)}, &kLobe, TEXT(vec4(lobeExp2(b.x, b.y, a.y), R(0.0), R(0.0), R(0.0))), {}, 0, ulpsOfCosine(), 2, unit});
  rows.push_back({"lobeStable, lobePhong", {rungName("lobe", LOBE_STABLE)}, &kLobe, TEXT(vec4(lobeStable(a.z, a.y), lobePhong(a.w, phongFromBlinnPhong(a.y)), R(0.0), R(0.0))), {}, 0,
                  absolute(), 1e-6, ranges({0, 1}, {0, 1})});
  for (int lobe = LOBE_POW; lobe <= LOBE_STABLE; ++lobe) {
    // From directions: their own rounding turns h.
    Row row{"lobeRung, phongRung: " + rungName("lobe", lobe), {rungName("lobe", lobe)}, &kShading,
            TEXT(vec4(lobeRung(surfaceCase(a, c, d), anglesOf(surfaceCase(a, c, d), vec3(b)), powerFromAlpha(a.w), rung), phongRung(surfaceCase(a, c, d), anglesOf(surfaceCase(a, c, d), vec3(b)), rung), R(0.0), R(0.0))),
            {}, lobe, absolute(), 5e-4, ranges({0, 1}, {0, 1})};
    if (lobe != LOBE_STABLE) {
      row.bound = 8;  // the cosine comes from six products, a root and a reciprocal
      row.scale = {" of the peak or of p ulp", [](const Row&, const Case& in, const glm::dvec4&, int) { return std::min(1.0, 1e-5 + shading::f64::powerFromAlpha(double(in[0].w)) * 0x1p-23); }};
    }
    rows.push_back(row);
  }

  rows.push_back({"D_blinnPhong", {rungName("distribution", DISTRIBUTION_BLINN_PHONG)}, &kDistributions, TEXT(vec4(D_blinnPhong(a.z, a.w), R(0.0), R(0.0), R(0.0))), {}, 0, relative(), 1e-6,
                  [](const Row&, const Case& in) { return Ranges{{{0, (double(in[0].w) + 2) / (2 * kPi)}}}; }});
  rows.push_back({"D_beckmann, D_ggx", {rungName("distribution", DISTRIBUTION_BECKMANN), rungName("distribution", DISTRIBUTION_GGX)}, &kDistributions,
                  TEXT(vec4(D_beckmann(a.x, a.y), D_ggx(a.x, a.y), R(0.0), R(0.0))), {}, 0, ofPeak(), 2e-6, [](const Row&, const Case& in) {
                    return Ranges{{{0, peakOf(DISTRIBUTION_BECKMANN, double(in[0].y))}, {0, peakOf(DISTRIBUTION_GGX, double(in[0].y))}}};
                  }});
  rows.push_back({"alphaAlong, alphaToward, twoWidthsScale, alphaOfStrength", {rungName("anisotropy", 1)}, &kTwoWidths,
                  TEXT(vec4(alphaAlong(a.x, a.y, a.z, a.w), alphaToward(a.x, a.y, a.z, a.w), twoWidthsScale(alphaAlong(a.x, a.y, a.z, a.w), a.z, a.w), alphaOfStrength(unitClamp(a.z), b.x))), {}, 0, relative(), 4e-6,
                  [](const Row&, const Case& in) {
                    const double ax = std::clamp(double(in[0].z), 1e-6, 1.0), ay = std::clamp(double(in[0].w), 1e-6, 1.0), low = std::min(ax, ay), high = std::max(ax, ay);
                    // Components past 1e12 overflow where they are divided by a width: the narrowest that can be, then.
                    return Ranges{{{0, high * (1 + 1e-6)}, {low * (1 - 1e-6), high * (1 + 1e-6)}, {0, high / low * (1 + 1e-6)}, {0, 1 + 1e-6}}};
                  }});
  for (int n = NORMALIZATION_NONE; n <= NORMALIZATION_EXACT; ++n) {
    Row row{rungName("normalization", n), {rungName("normalization", n)}, &kNormalizations, TEXT(vec4(normalizationRung(a.y, rung), dfgScale(a.y, rungs), R(0.0), R(0.0))),
            defaultRungs(GEOMETRY_VOID), n, relative(), 2e-6, [](const Row& r, const Case& in) {
              const double p = powerOf(in), most = r.rung == NORMALIZATION_NONE ? 1 : r.rung < NORMALIZATION_PLUS_2 ? 0.0397436 * p + 0.3183 : (p + 8) / (8 * kPi);
              // Over the exact one, which is 1/pi at p = 0: 1.0752 for (p + 8)/8 pi.
              return Ranges{{{0, most}, {0, r.rung == NORMALIZATION_NONE ? kPi : 1.0753}}};
            }};
    row.rungs.normalization = n;
    rows.push_back(row);
  }

  // Heights are differences of two numbers: their rounding counts falloff times as much.
  rows.push_back({"fogDepth, fogThrough, fogTaken, phaseHenyeyGreenstein", {}, &kFog,
                  TEXT(vec4(fogDepth(a.x, a.y, a.z, a.w, b.x, b.y), fogThrough(fogDepth(a.x, a.y, a.z, a.w, b.x, b.y)), fogTaken(fogDepth(a.x, a.y, a.z, a.w, b.x, b.y)), phaseHenyeyGreenstein(b.z, b.w))), {}, 0,
                  {" of what it is, by the rounding of heights", [](const Row&, const Case& in, const glm::dvec4& exact, int k) {
                     const double heights = 1 + double(in[1].y) * (std::abs(double(in[0].x)) + std::abs(double(in[0].y)));
                     return (k == 0 ? std::max(exact.x, 1e-30) : k == 3 ? exact.w : 1.0) * heights;
                   }}, {8e-6, 2e-6}, ranges({0, 1.0001e18}, {0, 1}, {0, 1 + 1e-6}, {0, 63})});
  rows.push_back({"visibility terms", {}, &kVisibility, TEXT(vec4(V_schlickSmith(a.x, a.y, a.z), V_smithGgx(a.x, a.y, a.z), V_smithBeckmann(a.x, a.y, a.z), V_vCavity(a.x, a.y, a.w, b.x))), {}, 0,
                  relative(), 1e-6, within(0, 0.5e12)});  // over BURNISH_GUARD_VISIBILITY
  // G = 4 n·l n·v V is a share of the facets.
  rows.push_back({"masking", {}, &kMasking,
                  TEXT(vec4(V_schlickSmith(a.x, a.y, a.z), V_smithGgx(a.x, a.y, a.z), V_smithBeckmann(a.x, a.y, a.z), V_vCavity(a.x, a.y, a.w, b.x)) * (R(4.0) * unitClamp(a.x) * unitClamp(a.y))), {}, 0,
                  absolute(), 1e-6, within(0, 1 + 1.4e-4)});
  rows.push_back({"V_void, V_kelemen, lambdaBeckmann", {}, &kMasking, TEXT(vec4(V_void(), V_kelemen(a.x), lambdaBeckmann(unitClamp(a.x), a.z), R(0.0))), {}, 0, absolute(), 2e-7,
                  ranges({0.25, 0.25}, {-FLT_MAX, FLT_MAX}, {-1e-4, 1 / 3.535})});
}

}  // namespace burnish::test
