// The table's rows for Fresnel's reflectance, energy and diffuse reflection.
#include "shading/test_rungs.h"
#include "text_bounds.h"
#include "text_domains.h"

namespace burnish::test {
namespace {

const Domain kReflectance = numbers("Fresnel's reflectance", {kUnit, kUnit, kUnit, kCosine, kIndex, kIndex, kIndex, kZero, kExtinction, kExtinction, kExtinction});
const Domain kFresnelFunctions = numbers("Fresnel's functions", {kUnit, kCosine, kIndex, kExtinction});
const Domain kFit = numbers("fitted albedo", {kUnit, kCosine, kCosine, kAlpha});
const Domain kFromInside = numbers("from inside", {kInside, kCosine});

/// toEye above the surface; b: normal; c.x: index.
Case crossing(Random& random) {
  const glm::vec3 n = randomUnit(random), v = randomUnit(random);
  return {glm::vec4(dot(n, v) < 0 ? -v : v, 0), glm::vec4(n, 0), glm::vec4(kIndex.ordinary(random), 0, 0, 0)};
}
Case hardCrossing(Random& random) {
  const glm::vec3 n = hardUnit(random), v = hardNear(random, n);
  return {glm::vec4(dot(n, v) < 0 ? -v : v, 0), glm::vec4(n, 0), glm::vec4(kIndex.adverse(random), 0, 0, 0)};
}
const Domain kCrossing{"refraction", crossing, hardCrossing};

/// a: n·l, n·v, l·v, sigma; b.x: albedo.
Case azimuths(Random& random) {
  const float l = uniform(random, 0.05f, 0.999f), v = uniform(random, 0.05f, 0.999f), c = std::cos(uniform(random, 0, 3.1415f));
  return {glm::vec4(l, v, l * v + c * std::sqrt((1 - l * l) * (1 - v * v)), uniform(random, 0, 1)), glm::vec4(uniform(random, 0, 1), 0, 0, 0)};
}
const Domain kRoughDiffuse{"rough diffuse", azimuths, numbers("", {kCosine, kCosine, kAny, kAny, kAny}).adverse};

/// a.x: F0; b: the lobe's (scale, bias) at n·v and in the mean; c: at n·l.
Case tables(Random& random, const Domain& from, bool adverse) {
  const Case made = adverse ? from.adverse(random) : from.ordinary(random);
  return {made[3], glm::vec4(made[4].x, made[4].y, made[5].x, made[5].y), glm::vec4(made[4].z, made[4].w, 0, 0)};
}
const Domain kTables{"energy", [](Random& random) { return tables(random, kShading, false); }, [](Random& random) { return tables(random, kShading, true); }};

}  // namespace

void addFresnel(std::vector<Row>& rows) {
  for (int fresnel = FRESNEL_NONE; fresnel <= FRESNEL_CONDUCTOR; ++fresnel)
    rows.push_back({rungName("fresnel", fresnel), {rungName("fresnel", fresnel)}, &kReflectance, TEXT(vec4(fresnelRung(vec3(a), vec3(b), vec3(c), a.w, rung), fresnelDielectricPart(a.x, a.w, rung))), {}, fresnel,
                    absolute(), fresnel >= FRESNEL_DIELECTRIC ? 6e-6 : 1e-6, within(0, 1)});
  rows.push_back({"F_dielectric, dielectricReflectance, F_conductor, conductorOver", {}, &kFresnelFunctions,
                  TEXT(vec4(F_dielectric(a.x, a.y), dielectricReflectance(a.z, a.y), F_conductor(a.z, a.w, a.y), conductorOver(a.x, a.z, a.w, a.y))), {}, 0, absolute(), 6e-6, within(0, 1)});
  // Near the critical angle the root of a rounded difference: some sqrt(2^-23).
  rows.push_back({"dielectricReflectance from inside", {}, &kFromInside, TEXT(vec4(dielectricReflectance(a.x, a.y), R(0.0), R(0.0), R(0.0))), {}, 0, absolute(), 1e-3, ranges({0, 1})});
  rows.push_back({"Fresnel weights and means", {}, &kFresnelFunctions,
                  TEXT(vec4(schlickWeight(a.y), sphericalGaussianWeight(a.y), fresnelMean(a.x, FRESNEL_NONE), fresnelMean(a.x, FRESNEL_SCHLICK))), {}, 0, absolute(), 1e-6, within(0, 1)});
  const double most = std::sqrt(2.0);  // a tangent and a normal part, neither longer than 1
  rows.push_back({"refractSnell", {}, &kCrossing, TEXT(refractCase(vec3(a), vec3(b), c.x)), {}, 0, absolute(), 2e-6, ranges({-most, most}, {-most, most}, {-most, most}, {0, 1})});
}

void addDiffuse(std::vector<Row>& rows) {
  for (int diffuse = DIFFUSE_LAMBERT; diffuse <= DIFFUSE_OREN_NAYAR_ENERGY; ++diffuse) {
    Row row{rungName("diffuse", diffuse), {rungName("diffuse", diffuse)}, &kShading,
            TEXT(vec4(diffuseRung(tableCase(a, c, d, e, f), anglesOf(tableCase(a, c, d, e, f), vec3(b)), vec2(e.z, e.w), rungs), R(0.0))), defaultRungs(), diffuse,
            {" of 1/pi or of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(1 / kPi, exact[k]); }}, 2e-6, [](const Row& r, const Case& in) {
              const double most = diffuseCeiling(r.rungs, seen(in, false));
              return Ranges{{{0, most}, {0, most}, {0, most}}};
            }};
    row.rungs.diffuse = diffuse;
    // Mesa's acos errs by 1e-4 radians.
    if (diffuse == DIFFUSE_OREN_NAYAR) row.bound = {1e-3, 2e-6};
    if (diffuse == DIFFUSE_OREN_NAYAR_ENERGY) row.bound = {2e-4, 3e-6};
    rows.push_back(row);
  }
  for (int diffuse : {DIFFUSE_LAMBERT, DIFFUSE_COUPLED_FIT, DIFFUSE_OREN_NAYAR_QUALITATIVE}) {
    // sigma is the red of the material.
    Row row{"own roughness, " + rungName("diffuse", diffuse), {rungName("rough-diffuse", 1)}, &kShading,
            TEXT(vec4(diffuseRung(roughCase(a, c, d, e, f), anglesOf(roughCase(a, c, d, e, f), vec3(b)), vec2(e.z, e.w), rungs), R(0.0))), defaultRungs(), diffuse,
            {" of 1/pi or of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(1 / kPi, exact[k]); }}, {2e-4, 3e-6}, [](const Row& r, const Case& in) {
              const Seen s = seen(in, false);
              const double most = 1.05 * std::max(roughDiffuseCeiling(DIFFUSE_OREN_NAYAR_ENERGY, s.leastNol, s.nov), roughDiffuseCeiling(r.rungs.diffuse, s.leastNol, s.nov));
              return Ranges{{{0, most}, {0, most}, {0, most}}};
            }};
    row.rungs.diffuse = diffuse;
    row.rungs.roughDiffuse = 1;
    rows.push_back(row);
  }
  rows.push_back({"orenNayarEnergyAlbedo", {}, &kRoughDiffuse, TEXT(vec4(orenNayarEnergyAlbedo(a.y, a.w, b.x), R(0.0), R(0.0), R(0.0))), {}, 0, absolute(), {2e-4, 2e-6}, ranges({0, 1})});
  rows.push_back({"Fd_lambert, Fd_orenNayarQualitative, Fd_orenNayar, Fd_orenNayarEnergy", {}, &kRoughDiffuse,
                  TEXT(vec4(Fd_lambert(), Fd_orenNayarQualitative(a.x, a.y, a.z, a.w), Fd_orenNayar(a.x, a.y, a.z, a.w, b.x), Fd_orenNayarEnergy(a.x, a.y, a.z, a.w, b.x))), {}, 0, absolute(), {5e-4, 2e-6},
                  [](const Row&, const Case& in) {
                    const double l = std::clamp(double(in[0].x), 0.0, 1.0), v = std::clamp(double(in[0].y), 0.0, 1.0);
                    return Ranges{{{1 / kPi, 1 / kPi},
                                   {0, roughDiffuseCeiling(DIFFUSE_OREN_NAYAR_QUALITATIVE, l, v)},
                                   {0, roughDiffuseCeiling(DIFFUSE_OREN_NAYAR, l, v)},
                                   {0, roughDiffuseCeiling(DIFFUSE_OREN_NAYAR_ENERGY, l, v)}}};
                  }});
  rows.push_back({"fujiiRoughness, fujiiAlbedo, azimuthTerm", {}, &kRoughDiffuse, TEXT(vec4(fujiiRoughness(a.w), fujiiAlbedo(a.x, unitClamp(a.w)), azimuthTerm(unitClamp(a.x), unitClamp(a.y), a.z), R(0.0))),
                  {}, 0, absolute(), {2e-4, 1e-6}, ranges({0, 1}, {1 - 1e-6, 1 + (kPi / 2 - 2.0 / 3) / kPi}, {-2, 1})});

  for (int compensation = COMPENSATION_NONE; compensation <= COMPENSATION_MULTIPLE_SCATTERING; ++compensation) {
    Row albedo{"specularAlbedo, coupledShare: " + rungName("compensation", compensation), {}, &kTables,
               TEXT(vec4(specularAlbedo(a.x, vec2(b), vec2(b.z, b.w), rungs), coupledShare(a.x, vec2(b), vec2(c), vec2(b.z, b.w), rungs), R(0.0), R(0.0))), defaultRungs(), 0,
               {" or of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(1.0, exact[k]); }}, 1e-5, [](const Row& r, const Case& in) {
                 const glm::dvec2 mean(in[1].z, in[1].w);
                 const double left = 1 - shading::f64::specularAlbedo(double(in[0].x), mean, mean, r.rungs) - 1e-6;
                 return Ranges{{{0, 1}, {0, 1 / std::max(left, 1e-4)}}};  // BURNISH_GUARD_LOSS
               }};
    albedo.rungs.compensation = compensation;
    rows.push_back(albedo);
    Row whole{rungName("compensation", compensation), {rungName("compensation", compensation)}, &kShading,
              TEXT(vec4(vec3(shadeCase(a, b, c, d, e, vec2(f), rungs)), environmentScattered(tableCase(a, c, d, e, f), rungs).x)), albedo.rungs, 0,
              {" of the peak", [](const Row& r, const Case& in, const glm::dvec4&, int k) { return k == 3 ? 1 : shadeCeiling(r.rungs, seen(in, false), in); }}, 5e-4,
              [](const Row& r, const Case& in) {
                const double most = shadeCeiling(r.rungs, seen(in, false), in);
                return Ranges{{{0, most}, {0, most}, {0, most}, {0, 1}}};
              }};
    rows.push_back(whole);
  }
  rows.push_back({"lobeAlbedo, scatteredShare, lobeLoss, multipleScatteringLobe", {}, &kTables,
                  TEXT(vec4(lobeAlbedo(a.x, vec2(b), FRESNEL_SCHLICK), scatteredShare(a.x, vec2(b.z, b.w), FRESNEL_SCHLICK), lobeLoss(vec2(b)), multipleScatteringLobe(vec2(b), vec2(c), vec2(b.z, b.w)))), {}, 0,
                  {" or of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(1.0, exact[k]); }}, 3e-6, [](const Row&, const Case& in) {
                    const double loss = std::max(1 - double(in[1].z) - double(in[1].w) - 1e-6, 1e-4);
                    return Ranges{{{0, 1}, {0, 1}, {0, 1}, {0, 1 / (kPi * loss)}}};
                  }});
  // F0 of the dielectric part is at most 0.25, where Fresnel's reflectance rises with the angle: 1 - e <= q = 1 - F0 - 0.007, 1 - mean e >= q - (1 - F0)/21.
  rows.push_back({"coupledFitShare", {}, &kFit,
                  TEXT(vec4(coupledFitShare(R(0.25) * a.x, a.y, a.z, a.w, FRESNEL_NONE), coupledFitShare(R(0.25) * a.x, a.y, a.z, a.w, FRESNEL_SCHLICK),
                            coupledFitShare(R(0.25) * a.x, a.y, a.z, a.w, FRESNEL_SPHERICAL_GAUSSIAN), coupledFitShare(R(0.25) * a.x, a.y, a.z, a.w, FRESNEL_DIELECTRIC))),
                  {}, 0, absolute(), 1e-6, within(0, 1.05)});
  rows.push_back({"fittedAlbedo", {}, &kFit, TEXT(vec4(fittedAlbedo(a.x, a.y, a.w), R(0.0), R(0.0), R(0.0))), {}, 0, absolute(), 1e-6, ranges({0, 1})});
}

}  // namespace burnish::test
