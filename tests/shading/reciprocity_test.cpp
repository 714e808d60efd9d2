// f(l, v) = f(v, l): which rungs hold it, and which do not.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>

#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f64 = burnish::shading::f64;

namespace {

struct Asymmetry {
  double worst = 0, typical = 0;  ///< |f(l, v) - f(v, l)| over the larger; the mean
};

/// `part`: what of the surface is asked for, n·l included. Albedos of lobes come from `energy` where it is given.
template <class Part>
Asymmetry asymmetry(const shading::Rungs& k, double alpha, const reference::LobeEnergy* energy, Part&& part) {
  std::mt19937_64 random(21);
  Asymmetry a;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount;) {
    const dvec3 n = randomUnit(random), v = randomUnit(random), tangent = randomUnit(random),
                axis = normalize(n + randomUnit(random) * alpha);
    const dvec3 l = i % 2 ? randomUnit(random) : glm::reflect(-v, axis);  // half of the pairs inside the lobe
    if (dot(n, l) < 0.02 || dot(n, v) < 0.02) continue;
    ++i;
    const auto f = [&](const dvec3& from, const dvec3& to) {
      reference::OracleSurface s;
      s.n = n, s.v = to, s.alpha = alpha, s.substance = 0.45, s.albedo = {0.9, 0.6, 0.1};
      if (k.anisotropic) s.tangent = tangent, s.anisotropy = 0.7;
      if (k.fresnel == FRESNEL_CONDUCTOR) s.eta = {0.14, 0.37, 1.44}, s.k = {4, 2.4, 1.6};
      const f64::Surface m = reference::surfaceOf(s, energy);
      return part(m, from, energy ? energy->at(dot(n, from)) : glm::dvec2(0)) / dot(n, from);
    };
    const dvec3 there = f(l, v), back = f(v, l);
    const double scale = std::max(glm::length(there), glm::length(back)),
                 error = scale > 1e-12 ? glm::length(there - back) / scale : 0;
    a.worst = std::max(a.worst, error);
    a.typical += error / kCount;
  }
  return a;
}

}  // namespace

TEST_CASE("reciprocity: specular rungs, and the two that are not") {
  // Models that leave the cosine out of f (n·l): f itself is divided by one of the two, so swapping changes it by their
  // ratio.
  const std::vector<int> exceptions{SPECULAR_PHONG, SPECULAR_BLINN_PHONG};
  for (shading::Rungs k : specularRungs())
    for (const double alpha : {0.02, 0.2, 0.6, 1.0})
      for (int anisotropic = 0; anisotropic < 2; ++anisotropic)
        for (int fresnel : {FRESNEL_SCHLICK, FRESNEL_CONDUCTOR}) {
          k.anisotropic = anisotropic;
          k.fresnel = fresnel;
          const Asymmetry a = asymmetry(k, alpha, nullptr, [&](const f64::Surface& m, const dvec3& l, glm::dvec2) {
            const f64::Angles angles = f64::anglesOf(m, l);
            return f64::fresnelRung(m.f0, m.eta, m.k, angles.loh, k.fresnel) * f64::specularRung(m, angles, k);
          });
          CAPTURE(nameOf(k), alpha, anisotropic, fresnel, a.worst, a.typical);
          if (k.specular == SPECULAR_MICROFACET ||
              std::find(exceptions.begin(), exceptions.end(), k.specular) == exceptions.end()) {
            CHECK(a.worst < 1e-5);  // ln(1 - x) has a truncated series in double too
          } else {
            CHECK(a.worst > 0.3);
            CHECK(a.typical > 0.03);
          }
        }
}

TEST_CASE("reciprocity: diffuse rungs with every Fresnel, and compensation") {
  for (const double alpha : {0.05, 0.5, 1.0})
    for (const int geometry : {GEOMETRY_KELEMEN, GEOMETRY_SMITH}) {
      shading::Rungs k = defaultRungs(geometry);
      k.distribution = DISTRIBUTION_GGX;
      const reference::LobeEnergy energy(k, alpha, 128);
      for (int compensation : {COMPENSATION_NONE, COMPENSATION_MULTIPLE_SCATTERING})
        for (int fresnel = FRESNEL_NONE; fresnel <= FRESNEL_CONDUCTOR; ++fresnel)
          for (int diffuse = DIFFUSE_LAMBERT; diffuse <= DIFFUSE_OREN_NAYAR_ENERGY; ++diffuse) {
            k.compensation = compensation, k.fresnel = fresnel, k.diffuse = diffuse;
            const Asymmetry a =
                asymmetry(k, alpha, &energy, [&](const f64::Surface& m, const dvec3& l, glm::dvec2 dfg) {
                  return f64::diffuseRung(m, f64::anglesOf(m, l), dfg, k) * dot(m.n, l);
                });
            const Asymmetry whole =
                asymmetry(k, alpha, &energy, [&](const f64::Surface& m, const dvec3& l, glm::dvec2 dfg) {
                  return f64::shadeDirection(m, l, dfg, k);
                });
            CAPTURE(alpha, geometry, compensation, fresnel, diffuse);
            CHECK(a.worst < 1e-5);
            CHECK(whole.worst < 1e-5);
          }
    }
}

TEST_CASE("reciprocity: a term that takes one direction's Fresnel alone is caught") {
  // What the seeds do elsewhere, F(n·v) in place of F(l·h): the measure must see it.
  const Asymmetry a = asymmetry(defaultRungs(), 0.5, nullptr, [&](const f64::Surface& m, const dvec3& l, glm::dvec2) {
    return m.diffuse * (1 - f64::schlickWeight(m.nov)) * dot(m.n, l);
  });
  CHECK(a.worst > 0.3);
}
