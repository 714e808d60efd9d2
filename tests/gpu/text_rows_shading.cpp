// The table's rows for whole specular models, for the light of the surroundings and for sampling.
#include <fmt/format.h>

#include <cfloat>

#include "shading/test_rungs.h"
#include "text_bounds.h"
#include "text_domains.h"

namespace burnish::test {
namespace {

/// Of the highest value that the lobe takes at these l and v; where diffuse light is in the result, of 1/pi if that is more.
Scale ofLobe() {
  return {" of the peak", [](const Row& row, const Case& in, const glm::dvec4&, int k) {
            const bool metal = row.domain == &kMetal;
            const double most = specularCeiling(row.rungs, seen(in, metal));
            return k == 0 && !metal ? most : std::max(most, 1 / kPi);
          }};
}
/// specularRung in x, then shadeDirection.
Ranges shaded(const Row& row, const Case& in) {
  const Seen s = seen(in, false);
  const double specular = specularCeiling(row.rungs, s), most = shadeCeiling(row.rungs, s, in);
  return {{{0, specular}, {0, most}, {0, most}, {0, most}}};
}
Ranges shadedMetal(const Row& row, const Case& in) {
  const double most = shadeCeiling(row.rungs, seen(in, true), in);
  return {{{0, most}, {0, most}, {0, most}}};
}

std::vector<std::string> coverage(const shading::Rungs& k) {
  std::vector<std::string> names{rungName("specular", k.specular)};
  if (k.specular != SPECULAR_MICROFACET) return names;
  names.push_back(rungName("distribution", k.distribution));
  names.push_back(rungName("geometry", k.geometry));
  if (k.geometry == GEOMETRY_VOID && k.distribution == DISTRIBUTION_BLINN_PHONG) names.push_back(rungName("normalization", k.normalization));
  return names;
}

const Domain kHarmonics{"spherical harmonics",
                        [](Random& random) {
                          Case made = numbers("", {kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny}).ordinary(random);
                          made[0] = glm::vec4(randomUnit(random), made[0].w);
                          return made;
                        },
                        [](Random& random) {
                          Case made{};
                          for (glm::vec4& v : made)
                            for (int i = 0; i < 4; ++i) v[i] = kCoefficient.adverse(random);
                          made[0] = glm::vec4(hardUnit(random), made[0].w);
                          return made;
                        }};
const Domain kBoxes = numbers("boxes of colours", {kUnit, kUnit, kUnit, kUnit, kUnit, kUnit, kUnit, kUnit, kUnit});
const Domain kOcclusion = numbers("occlusion", {kCosine, kCosine, kAlpha});
/// a: normal; b: to the eye; c: a direction of the screen; d: an occluder's place.
const Domain kSlices{"slices of the hemisphere",
                     [](Random& random) {
                       for (;;) {
                         const glm::vec3 n = randomUnit(random), v = randomUnit(random), t = randomUnit(random);
                         const glm::vec3 d = randomUnit(random) * uniform(random, 0.05f, 2);
                         const glm::vec3 across = glm::normalize(glm::cross(v, t));
                         // Where the normal's projection is a direction, and the occluder on the slice's side.
                         if (glm::dot(n, v) > 0.2f && std::abs(glm::dot(v, t)) < 0.9f && glm::dot(d, glm::cross(across, v)) > 0.03f) return Case{glm::vec4(n, 0), glm::vec4(v, 0), glm::vec4(t, 0), glm::vec4(d, 0)};
                       }
                     },
                     [](Random& random) {
                       const glm::vec3 v = hardUnit(random);
                       glm::vec3 t = hardUnit(random);
                       while (std::abs(glm::dot(t, v)) > 0.999f) t = randomUnit(random);
                       return Case{glm::vec4(hardNear(random, v), 0), glm::vec4(v, 0), glm::vec4(t, 0), glm::vec4(hardUnit(random) * std::pow(10.0f, uniform(random, -20, 9)), 0)};
                     }};
/// a: a place in a lattice, and a height; b: a plane; c: a way to it; d: where between texels.
const Domain kLattice = numbers("lattices", {kAny, kAny, kAny, kAny, kUnit, kUnit, kUnit, kUnit, kUnit, kUnit, kUnit, kZero, kUnit, kUnit});
const Domain kTable = numbers("tables of albedo", {kCosine, kAlpha, kUnit});
const Domain kSampling = numbers("sampling", {kRandom, kRandom, kAlpha, kSin2, kAlpha, kInteger});
const Domain kLight = numbers("lights", {kDistance2, kUnit, kUnit, kZero, kAny, kAny, kAny});
const Domain kMaps = numbers("maps", {kUnit, kUnit, kUnit, kUnit, kAny, kAny, kAny});
const Domain kBytes = numbers("bytes", {kByte, kByte, kByte});
const Domain kRadiances = numbers("radiance", {kRadiance, kRadiance, kRadiance});
const Domain kDetails = numbers("details", {kAny, kAny, kAny, kAlpha, kAny, kAny, kAny, kUnit});
const Domain kDirections{"directions", [](Random& random) { return Case{glm::vec4(randomUnit(random), 0)}; }, [](Random& random) { return Case{glm::vec4(hardUnit(random), 0)}; }};
const Domain kVectors = {"vectors", [](Random& random) { return Case{glm::vec4(randomUnit(random) * uniform(random, 0.1f, 10), 0)}; }, numbers("", {kAny, kAny, kAny}).adverse};

double densityCeiling(int family, double alpha) {
  const double a = std::clamp(alpha, 1e-6, 1.0);
  return family == LOBE_FAMILY_PHONG ? (shading::f64::powerFromAlpha(a) / 4 + 1) / (2 * kPi) : peakOf(family, a);
}

}  // namespace

void addSpecular(std::vector<Row>& rows) {
  for (const shading::Rungs& k : specularRungs())
    rows.push_back({nameOf(k), coverage(k), &kShading,
                    TEXT(vec4(specularRung(surfaceCase(a, c, d), anglesOf(surfaceCase(a, c, d), vec3(b)), rungs), vec3(shadeCase(a, b, c, d, e, vec2(f), rungs)))), k, 0, ofLobe(), 5e-4, shaded});
  const auto metal = [&](std::string name, const shading::Rungs& k, std::vector<std::string> covers) {
    rows.push_back({std::move(name), std::move(covers), &kMetal, TEXT(vec4(shadeDirection(metalCase(a, c, d, e, f), vec3(b), vec2(R(0.5), R(0.1)), rungs), R(0.0))), k, 0, ofLobe(), 3e-4, shadedMetal});
  };
  for (shading::Rungs k : specularRungs()) {
    k.anisotropic = 1;
    if (hasTwoWidths(k) && k.normalization == NORMALIZATION_EXACT) metal("two widths, " + nameOf(k), k, {rungName("specular", k.specular), rungName("anisotropy", 1)});
  }
  for (int fresnel = FRESNEL_NONE; fresnel <= FRESNEL_CONDUCTOR; ++fresnel) {
    shading::Rungs k = defaultRungs();
    k.fresnel = fresnel;
    metal("shadeDirection, " + rungName("fresnel", fresnel), k, {rungName("fresnel", fresnel)});
  }
  rows.push_back({"anglesOf", {}, &kShading,
                  TEXT(vec4(anglesOf(surfaceCase(a, c, d), vec3(b)).inverse, anglesOf(surfaceCase(a, c, d), vec3(b)).sin2, anglesOf(surfaceCase(a, c, d), vec3(b)).loh, anglesOf(surfaceCase(a, c, d), vec3(b)).nol)),
                  {}, 0, {" or of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(1.0, exact[k]); }}, 4e-6,
                  // 1/|l + v|², held; |t| is at most 3: what takes sin² takes it into [0, 1].
                  ranges({0.25 - 1e-6, 1e7}, {0, 9e7}, {0.5 * std::sqrt(1e-7), 1 + 1e-6}, {-1 - 1e-6, 1 + 1e-6})});
  rows.push_back({"makeSurface", {}, &kShading, TEXT(vec4(surfaceCase(a, c, d).n, surfaceCase(a, c, d).nov)), {}, 0, absolute(), 5e-7, ranges({-1, 1}, {-1, 1}, {-1, 1}, {0, 1})});
  rows.push_back({"substanceF0, substanceDielectricF0", {}, &kMaps, TEXT(vec4(substanceF0(a.w, vec3(a)), substanceDielectricF0(a.w))), {}, 0, absolute(), 1e-6, within(0, 1)});
  rows.push_back({"substanceDiffuse, substanceMetalness", {}, &kMaps, TEXT(vec4(substanceDiffuse(a.w, vec3(a)), substanceMetalness(a.w))), {}, 0, absolute(), 1e-6, within(0, 1)});
  rows.push_back({"encodeAlbedo", {}, &kMaps, TEXT(vec4(encodeAlbedo(vec3(b)), R(0.0))), {}, 0, absolute(), 1e-6, within(0, 1)});
  rows.push_back({"decodeAlbedo", {}, &kMaps, TEXT(vec4(decodeAlbedo(vec3(a)), R(0.0))), {}, 0, ulp(), 3, within(0, 1)});
  rows.push_back({"octahedralEncode, octahedralDecode", {}, &kVectors, TEXT(vec4(octahedralDecode(octahedralEncode(vec3(a))), R(0.0))), {}, 0, absolute(), 1e-6, within(-1, 1)});
  rows.push_back({"unpackNormal", {}, &kBytes, TEXT(vec4(unpackNormal(vec3(a)), R(0.0))), {}, 0, absolute(), 2e-6, within(-1, 1)});
  rows.push_back({"unpackNormal8", {}, &kBytes, TEXT(vec4(unpackNormal8(vec2(a.x, a.y)), R(0.0))), {}, 0, absolute(), 2e-6, within(-1, 1)});
  rows.push_back({"unpackNormal16, unpackOctahedral", {}, &kMaps, TEXT(vec4(unpackNormal16(vec2(b.x, b.y)), R(0.0))), {}, 0, absolute(), 1e-4, within(-1, 1)});  // a tie between two codes is a step
  // A step of the tangent's code is 4.8e-5 radians, and the normal's a step of its own.
  rows.push_back({"packDetail, unpackTangent", {}, &kDetails, TEXT(detailCase(vec3(a), vec3(b), unitClamp(a.w), b.w)), {}, 0, absolute(), 2e-4, ranges({0, 1 + 1e-5}, {4e-4 * (1 - 1e-5), 1 + 1e-5}, {0, 1}, {-1e-5, 1e-5})});
  rows.push_back({"packNormal8, packNormal16, packOctahedral", {}, &kVectors, TEXT(vec4(packNormal8(vec3(a)).x, packNormal8(vec3(a)).y, packNormal16(vec3(a)).x, packNormal16(vec3(a)).y)), {}, 0, absolute(), 1.01 / 255, within(0, 1)});
  rows.push_back({"packNormal", {}, &kVectors, TEXT(vec4(packNormal(vec3(a)), R(0.0))), {}, 0, absolute(), 1.01, within(0, 1)});  // a step of the code moves a byte by its whole range
}

void addSurroundings(std::vector<Row>& rows) {
  for (int i = ENVIRONMENT_SPECULAR_NONE; i <= ENVIRONMENT_SPECULAR_SAMPLED; ++i)
    rows.push_back({rungName("environment-specular", i), {rungName("environment-specular", i)}, &kShading,
                    TEXT(vec4(environmentReflectance(tableCase(a, c, d, e, f), rung, FRESNEL_SCHLICK), ambientShare(tableCase(a, c, d, e, f), rung, rungs))), defaultRungs(), i, absolute(), 1e-6,
                    within(0, 1)});
  for (int i = AMBIENT_NONE; i <= AMBIENT_SH_L2; ++i)
    rows.push_back({rungName("ambient", i), {rungName("ambient", i)}, &kHarmonics,
                    TEXT(vec4(irradianceSh(vec3(a), vec3(b), vec3(c), vec3(d), vec3(e), vec3(f), vec3(b.w, c.w, d.w), vec3(a.w, e.w, f.w), vec3(b.y, c.z, d.x), vec3(e.z, f.x, b.x), rung), R(0.0))), {}, i,
                    {" of the coefficients' sum", [](const Row& row, const Case& in, const glm::dvec4&, int k) { return std::max(row.ranges(row, in)[std::size_t(k)].hi, 1e-30); }}, 1e-6,
                    [](const Row&, const Case& in) {
                      // The basis is at most 1, and 2 for 3z² - 1.
                      const glm::dvec4 a(in[0]), b(in[1]), c(in[2]), d(in[3]), e(in[4]), f(in[5]);
                      const glm::dvec3 sum = glm::abs(glm::dvec3(b)) + glm::abs(glm::dvec3(c)) + glm::abs(glm::dvec3(d)) + glm::abs(glm::dvec3(e)) + glm::abs(glm::dvec3(f)) +
                                             glm::abs(glm::dvec3(b.w, c.w, d.w)) + 2.0 * glm::abs(glm::dvec3(a.w, e.w, f.w)) + glm::abs(glm::dvec3(b.y, c.z, d.x)) + glm::abs(glm::dvec3(e.z, f.x, b.x));
                      return Ranges{{{-sum.x, sum.x}, {-sum.y, sum.y}, {-sum.z, sum.z}}};
                    }});
  const auto boxCeiling = [](const Row&, const Case& in) {
    // Bands as above, by 4/3 and 5/2; a weight is at most (1 + 9/4 + 2)/12.
    const glm::dvec3 b = glm::abs(glm::dvec3(in[1])), c = glm::abs(glm::dvec3(in[2])), d = glm::abs(glm::dvec3(in[3])), e = glm::abs(glm::dvec3(in[4]));
    const glm::dvec3 most = 0.4375 * (b + 4.0 / 3 * (c + d + e) + 2.5 * (c + d + 2.0 * e + b + c)) * (1 + 1e-6);
    return Ranges{{{-most.x, most.x}, {-most.y, most.y}, {-most.z, most.z}}};
  };
  for (const int tap : {0, 5, 11})
    rows.push_back({rungName("ambient", AMBIENT_BOX) + fmt::format(", direction {}", tap), {rungName("ambient", AMBIENT_BOX)}, &kHarmonics, TEXT(vec4(ambientBoxCase(vec3(a), rung, vec3(b), vec3(c), vec3(d), vec3(e)), R(0.0))), {}, tap,
                    {" of the coefficients' sum", [](const Row& row, const Case& in, const glm::dvec4&, int k) { return std::max(row.ranges(row, in)[std::size_t(k)].hi, 1e-30); }}, 1e-6, boxCeiling});
  rows.push_back({"gridCell, gridShare, gridInFront, gridBefore, gridSees, gridTrust", {}, &kLattice, TEXT(gridCase(vec3(a), a.w, b, vec3(c), vec2(d.x, d.y))), {}, 0, absolute(), 3e-5, within(0, 1 + 1e-6)});
  rows.push_back({"distanceTexel, distanceDirection", {}, &kVectors, TEXT(vec4(distanceDirection(distanceTexel(vec3(a), R(16.0)).x, distanceTexel(vec3(a), R(16.0)).y, R(16.0)), R(0.0))), {}, 0, absolute(), 2e-6, within(-1, 1)});
  for (int i = SPECULAR_OCCLUSION_NONE; i <= SPECULAR_OCCLUSION_LAGARDE; ++i)
    rows.push_back({rungName("specular-occlusion", i), {rungName("specular-occlusion", i)}, &kOcclusion, TEXT(vec4(specularOcclusion(a.x, a.y, a.z, rung), R(0.0), R(0.0), R(0.0))), {}, i, absolute(),
                    1.2e-6, ranges({0, 1})});
  rows.push_back({"occlusionSlice, occlusionSide, addOccluder, occlusionSeeable, occlusionArc", {}, &kSlices, TEXT(occlusionCase(vec3(a), vec3(b), vec3(c), vec3(d))), {}, 0, absolute(), {1e-3, 4e-4},  // the arc cosine near 1
                 
                  ranges({0, kPi / 2 + 1e-5}, {-1e-5, kPi / 2 + 1e-3}, {0, 1 + 1e-6}, {-1 - 1e-6, 1 + 1e-6})});
  rows.push_back({"dfgColumn, dfgRow, dfgCoordinate", {}, &kTable, TEXT(vec4(dfgColumn(a.x), dfgRow(a.y), dfgCoordinate(a.x, a.z, vec2(R(64.0), R(32.0))))), {}, 0, absolute(), 5e-7,
                  ranges({-1e-6, 1}, {-1.7e-4, 1}, {0, 1}, {0, 1})});  // alpha under BURNISH_ALPHA_MIN lies before the first row
  rows.push_back({"dfgMeanCoordinate, environmentLevel, environmentRoughness", {}, &kTable,
                  TEXT(vec4(dfgMeanCoordinate(a.z, vec2(R(64.0), R(32.0))), environmentLevel(a.z, R(8.0)) * R(0.125), environmentRoughness(R(8.0) * a.z, R(8.0)))), {}, 0, absolute(), 5e-7, within(-1e-6, 1)});
  rows.push_back({"distanceAttenuation, spotAttenuation", {}, &kLight, TEXT(vec4(distanceAttenuation(a.x, R(1.0) / a.x, a.y, a.z), spotAttenuation(b.x, b.y, b.z), R(0.0), R(0.0))), {}, 0,
                  {" of the inverse square", [](const Row&, const Case& in, const glm::dvec4&, int k) { return k == 0 ? 1 / double(in[0].x) : 1; }}, 1e-6,
                  [](const Row&, const Case& in) { return Ranges{{{0, 1 / double(in[0].x)}, {0, 1}}}; }});
  const auto tone = [&](const char* name, const Text& text, double bound) { rows.push_back({name, {}, &kRadiances, text, {}, 0, absolute(), bound, within(0, 1)}); };
  tone("tonemapNone", TEXT(vec4(tonemapNone(vec3(a)), R(0.0))), 1e-6);
  tone("tonemapNeutral", TEXT(vec4(tonemapNeutral(vec3(a)), R(0.0))), 6e-7);
  tone("tonemapAces", TEXT(vec4(tonemapAces(vec3(a)), R(0.0))), 2e-6);
  tone("tonemapAgx", TEXT(vec4(tonemapAgx(vec3(a)), R(0.0))), 6e-5);
  rows.push_back({"lumaFromRgb, rgbFromLuma", {}, &kMaps, TEXT(vec4(rgbFromLuma(lumaFromRgb(vec3(a))), R(0.0))), {}, 0, absolute(), 5e-7, within(-1e-6, 1 + 1e-6)});
  rows.push_back({"compressLight, lumaOf", {}, &kRadiances, TEXT(vec4(compressLight(vec3(a)), R(0.0))), {}, 0, absolute(), 2e-5, within(0, 2 / 0.0722)});
  rows.push_back({"expandLight", {}, &kMaps, TEXT(vec4(expandLight(vec3(a) * R(1.5)), R(0.0))), {}, 0, absolute(), 5e-6, within(0, 2.01)});
  rows.push_back({"clippedToward", {}, &kBoxes, TEXT(vec4(clippedToward(vec3(a.x, a.y, a.z), vec3(a.w, b.x, b.y), vec3(b.z, b.w, c.x)), R(0.0))), {}, 0, absolute(), 1e-6, within(-1e-6, 1 + 1e-6)});
  rows.push_back({"clipBox", {}, &kBoxes, TEXT(vec4(clipBox(vec3(a.x, a.y, a.z), vec3(a.w, b.x, b.y)), R(0.0))), {}, 0, absolute(), 1e-6, within(0, 1.26)});
  rows.push_back({"catmullRom", {}, &kMaps, TEXT(catmullRom(a.x)), {}, 0, absolute(), 5e-7, within(-0.0742, 1 + 1e-6)});
  rows.push_back({"srgbFromLinear, srgbFromLinearFast, linearFromSrgb", {}, &kMaps, TEXT(vec4(srgbFromLinear(a.x), srgbFromLinearFast(a.y), linearFromSrgb(a.z), R(0.0))), {}, 0, absolute(), 2e-6, within(0, 1 + 0.1 / 255)});
}

void addSampling(std::vector<Row>& rows) {
  // Environment-specular=sampled draws from these.
  for (int family = LOBE_FAMILY_BLINN_PHONG; family <= LOBE_FAMILY_PHONG; ++family) {
    const char* names[] = {"Blinn-Phong", "Beckmann", "GGX", "Phong"};
    rows.push_back({std::string("sampleLobe, lobeDensity: ") + names[family], {rungName("environment-specular", ENVIRONMENT_SPECULAR_SAMPLED)}, &kSampling,
                    TEXT(vec4(sampleLobe(a.x, a.y, a.z, rung), lobeDensity(a.w, a.z, rung))), {}, family,
                    {" of the lobe's width or peak", [](const Row& row, const Case& in, const glm::dvec4&, int k) { return k == 3 ? densityCeiling(row.rung, double(in[0].z)) : k == 2 ? 1 : double(in[0].z); }},
                    family == LOBE_FAMILY_PHONG ? 1e-4 : family == LOBE_FAMILY_GGX ? 3e-5 : 8e-6,  // near the horizon the cosine is the root of a rounded difference
                    [](const Row& row, const Case& in) { return Ranges{{{-1, 1}, {-1, 1}, {0, 1}, {0, densityCeiling(row.rung, double(in[0].z))}}}; }});
  }
  for (int family = LOBE_FAMILY_BLINN_PHONG; family < LOBE_FAMILY_PHONG; ++family)
    rows.push_back({fmt::format("sampleTwoWidths, cosineDensity: family {}", family), {}, &kSampling, TEXT(vec4(sampleTwoWidths(a.x, a.y, a.z, b.x, rung), cosineDensity(a.w))), {}, family, absolute(), family == LOBE_FAMILY_GGX ? 3e-5 : 8e-6,
                    ranges({-1, 1}, {-1, 1}, {0, 1}, {0, 1 / kPi})});
  rows.push_back({"sampleCosine, radicalInverse", {}, &kSampling, TEXT(vec4(sampleCosine(a.x, a.y), radicalInverse(int(b.y)))), {}, 0, absolute(), 2e-6, ranges({-1, 1}, {-1, 1}, {0, 1}, {0, 1 - 0x1p-25})});
  rows.push_back({"basisFrom, tangent", {}, &kDirections, TEXT(basisCase(vec3(a), false)), {}, 0, absolute(), 5e-7, within(-1, 1)});
  rows.push_back({"basisFrom, bitangent", {}, &kDirections, TEXT(basisCase(vec3(a), true)), {}, 0, absolute(), 5e-7, within(-1, 1)});
}

}  // namespace burnish::test
