// Rungs of the surroundings' light by hand, and roughness where alpha belongs or the other way round (H15 of the hard
// cases): each value below changes when they are swapped.
#include <catch2/catch.hpp>

#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec2;
using glm::dvec3;
namespace f64 = burnish::shading::f64;

namespace {

f64::Surface surface(double alpha, double nov = 0.5, double substance = 1.0 / 3) {
  f64::Surface m = f64::makeSurface({0, 0, 1}, viewAt(nov), dvec3(0.8, 0.5, 0.2), substance, alpha);
  m.dfg = dvec2(0.7, 0.1);
  m.dfgMean = dvec2(0.8, 0.05);
  return m;
}

}  // namespace

TEST_CASE("surroundings: what the surface reflects, by rung") {
  // r = 0.25, alpha = 0.0625; n·v = 0.5: (1 - n·v)^5 = 1/32.
  const f64::Surface m = surface(0.0625);
  const auto reflectance = [&](int rung) { return f64::environmentReflectance(m, 0.04, rung, FRESNEL_SCHLICK); };
  CHECK(reflectance(ENVIRONMENT_SPECULAR_NONE) == 0);
  CHECK(reflectance(ENVIRONMENT_SPECULAR_SCHLICK) == Approx(0.04 + 0.96 / 32));
  CHECK(reflectance(ENVIRONMENT_SPECULAR_ROUGH_SCHLICK) == Approx(0.04 + (0.75 - 0.04) / 32));  // 1 - r, not 1 - alpha
  CHECK(reflectance(ENVIRONMENT_SPECULAR_DFG) == Approx(0.04 * 0.7 + 0.1));
  CHECK(f64::environmentReflectance(m, 0.04, ENVIRONMENT_SPECULAR_DFG, FRESNEL_NONE) == Approx(0.04 * 0.8));
  // Lagarde's maximum: rough gold keeps its F0.
  CHECK(f64::environmentReflectance(surface(0.81), 0.8, ENVIRONMENT_SPECULAR_ROUGH_SCHLICK, FRESNEL_SCHLICK) ==
        Approx(0.8));
  const dvec3 three = f64::environmentReflectance(m, ENVIRONMENT_SPECULAR_DFG, FRESNEL_SCHLICK);
  for (int i = 0; i < 3; ++i) CHECK(three[i] == Approx(m.f0[i] * 0.7 + 0.1));
}

TEST_CASE("surroundings: what is left for diffuse, and what scatters again") {
  const f64::Surface m = surface(0.25, 0.5, 0.7);  // between dielectric and metal: the dielectric part is water's
  shading::Rungs k = defaultRungs();
  const auto share = [&](int diffuse, int compensation = COMPENSATION_NONE) {
    k.diffuse = diffuse, k.compensation = compensation;
    return f64::ambientShare(m, ENVIRONMENT_SPECULAR_DFG, k);
  };
  const double e = 0.0196 * 0.7 + 0.1, mean = 0.85, f = 0.0196 + (1 - 0.0196) / 21,
               again = f * f * mean / (1 - f * (1 - mean));
  CHECK(share(DIFFUSE_LAMBERT) == 1);
  for (int diffuse : {DIFFUSE_LAMBERT_FRESNEL, DIFFUSE_OREN_NAYAR, DIFFUSE_OREN_NAYAR_QUALITATIVE, DIFFUSE_COUPLED,
                      DIFFUSE_OREN_NAYAR_ENERGY})
    CHECK(share(diffuse) == Approx(1 - e));
  CHECK(share(DIFFUSE_COUPLED, COMPENSATION_MULTIPLE_SCATTERING) == Approx(1 - e - again * 0.2));
  CHECK(f64::environmentScattered(m, k).x == Approx(f64::scatteredShare(m.f0.x, m.dfgMean, k.fresnel) * 0.2));
  const double g = m.f0.y + (1 - m.f0.y) / 21;
  CHECK(f64::environmentScattered(m, k).y == Approx(g * g * mean / (1 - g * (1 - mean)) * 0.2));
  k.compensation = COMPENSATION_NONE;
  CHECK(f64::environmentScattered(m, k) == dvec3(0));
}

TEST_CASE("surroundings: irradiance by rung") {
  const dvec3 n = normalize(dvec3(0.3, -0.5, 0.7));
  dvec3 c[9];
  for (int i = 0; i < 9; ++i) c[i] = dvec3(0.1 * (i + 1), 0.2, -0.03 * i);
  const auto irradiance = [&](int rung) {
    return f64::irradianceSh(n, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], rung);
  };
  CHECK(irradiance(AMBIENT_NONE) == dvec3(0));
  CHECK(irradiance(AMBIENT_CONSTANT) == c[0]);
  const dvec3 linear = c[0] + n.y * c[1] + n.z * c[2] + n.x * c[3];
  CHECK(glm::length(irradiance(AMBIENT_SH_L1) - linear) < 1e-14);
  const dvec3 all = linear + n.x * n.y * c[4] + n.y * n.z * c[5] + (3 * n.z * n.z - 1) * c[6] + n.x * n.z * c[7] +
                    (n.x * n.x - n.y * n.y) * c[8];
  CHECK(glm::length(irradiance(AMBIENT_SH_L2) - all) < 1e-14);
}

TEST_CASE("surroundings: specular occlusion by rung") {
  CHECK(f64::specularOcclusion(0.3, 0.4, 0.25, SPECULAR_OCCLUSION_NONE) == 1);
  CHECK(f64::specularOcclusion(0.3, 0.4, 0.25, SPECULAR_OCCLUSION_AO) == 0.4);
  // Listing 26 on alpha = 0.25 (r = 0.5): 0.7^(2^-5) - 0.6; with r it would be 0.7^(2^-9) - 0.6 = 0.399.
  CHECK(f64::specularOcclusion(0.3, 0.4, 0.25, SPECULAR_OCCLUSION_LAGARDE) ==
        Approx(std::pow(0.7, 1 / 32.0) - 0.6).epsilon(1e-9));
  CHECK(std::abs(f64::specularOcclusion(0.3, 0.4, 0.25, SPECULAR_OCCLUSION_LAGARDE) -
                 f64::specularOcclusion(0.3, 0.4, 0.5, SPECULAR_OCCLUSION_LAGARDE)) > 0.009);
}

TEST_CASE("roughness is squared once: every consumer of alpha") {
  const double alpha = 0.09;  // r = 0.3
  CHECK(f64::alphaFromRoughness(0.3) == Approx(alpha));
  f64::Surface m = surface(alpha);
  CHECK(m.power == Approx(2 / (alpha * alpha) - 2));
  CHECK(m.alphaX == alpha);
  // The peak of each distribution, in alpha.
  CHECK(f64::D_blinnPhong(1, m.power) == Approx(1 / (kPi * alpha * alpha)));
  CHECK(f64::D_beckmann(0, alpha) == Approx(1 / (kPi * alpha * alpha)));
  CHECK(f64::D_ggx(0, alpha) == Approx(1 / (kPi * alpha * alpha)));
  f64::setTangent(m, dvec3(1, 0, 0), 0.5);
  CHECK(m.alphaX == Approx(alpha + (1 - alpha) * 0.25));  // KHR_materials_anisotropy
  CHECK(m.alphaY == alpha);
  m = surface(alpha);
  // Oren and Nayar's sigma is alpha over root 2; A and B by hand at n·l = n·v = 0.5 in one plane (cos φ = 1): A + B
  // sin² θ / cos θ.
  const double s2 = alpha * alpha / 2, a = 1 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  shading::Rungs k = defaultRungs();
  k.diffuse = DIFFUSE_OREN_NAYAR_QUALITATIVE;
  k.fresnel = FRESNEL_NONE;
  const dvec3 diffuse = f64::diffuseRung(m, f64::anglesOf(m, m.v), dvec2(0), k);
  CHECK(diffuse.x == Approx(0.8 * 0.96 / kPi * (a + b * 0.75 / 0.5)).epsilon(1e-6));
  // Levels of a prefiltered cube go by roughness: level 2 of 4 is r = (3 - sqrt 5)/2.
  CHECK(f64::environmentRoughness(2, 4) == Approx(1.5 - std::sqrt(1.25)));
  CHECK(f64::environmentLevel(0.3, 4) == Approx(4 * 0.3 * (1.5 - 0.15)));
  // The G-buffer's code is linear in log alpha: the middle of [4e-4, 1] is 0.02.
  CHECK(f64::encodeAlpha(0.02) == Approx(0.5));
  // Tables are read by alpha: 0.6 code + 0.4 alpha, scaled to [0, 1].
  CHECK(f64::dfgRow(0.02) == Approx((0.3 + 0.008 - 0.00016) / 0.99984));
  CHECK(f64::sigmaFromAlpha(0.5) == Approx(0.5 / std::sqrt(2)));
}
