// Energy of the specular rungs: what each reflects in all under unit radiance from everywhere, over roughness and
// angle. What breaks the bound is listed with how much.
#include <catch2/catch.hpp>

#include "energy_grid.h"
#include "sphere.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec2;
using glm::dvec3;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

namespace {

/// What a lobe without width reflects with F = 1: D is a spike of weight 1 at n, and dl = 4 (v·h) dh, so 4 (n·v)² V for
/// D V. 0 where the model has no such limit.
double mirrorAlbedo(const shading::Rungs& k, double nov) {
  switch (k.specular) {
    case SPECULAR_PHONG:
    case SPECULAR_BLINN_PHONG:
      return 0;  // not normalized
    case SPECULAR_MODIFIED_PHONG:
    case SPECULAR_WARD:
    case SPECULAR_WARD_ANISOTROPIC:
      return nov;
    case SPECULAR_NORMALIZED_BLINN_PHONG:
      return nov * nov;
    case SPECULAR_MICROFACET:
      break;
    default:
      return 1;
  }
  if (k.geometry != GEOMETRY_VOID) return 1;
  if (k.distribution == DISTRIBUTION_BLINN_PHONG && k.normalization < NORMALIZATION_PLUS_2) {
    // 1/8pi is 0.0397887; the fits have 0.0397436.
    return k.normalization == NORMALIZATION_NONE ? 0 : nov * nov * 0.0397436 * 8 * kPi;
  }
  return nov * nov;
}

}  // namespace

TEST_CASE("energy: specular rungs with F = 1, never above 1 or as listed") {
  for (const shading::Rungs& k : specularRungs()) {
    Worst worst;
    for (const double r : kRoughness)
      for (const double nov : kCosines) {
        const dvec2 e = reference::lobeAlbedo(k, nov, r * r);
        CHECK(e.x >= 0);
        CHECK(e.y >= 0);
        worst.note(e.x + e.y, r, nov);
      }
    const auto excess = kBright.find(nameOf(k));
    WARN("albedo, F = 1, " << nameOf(k) << ": at most " << worst);
    CAPTURE(nameOf(k), worst.value);
    if (excess == kBright.end()) {
      CHECK(worst.value <= 1.001);
    } else {
      CHECK(worst.value > excess->second.low);
      CHECK(worst.value < excess->second.high);
    }
  }
}

TEST_CASE("energy: specular rungs toward the horizon") {
  // V-cavities stay under 1 as a model; BURNISH_GUARD_HALF makes 2.1 % of too much there at alpha 4e-4.
  constexpr double kGuard = 1.025;
  for (const shading::Rungs& k : specularRungs()) {
    if (!claims(k) && nameOf(k) != "blinn-phong, smith") continue;
    Worst worst;
    for (const double r : kRoughness)
      for (const double nov : {1e-4, 3e-4, 1e-3, 5e-3}) {
        const dvec2 e = reference::lobeAlbedo(k, nov, r * r, true);
        worst.note(e.x + e.y, r, nov);
      }
    const bool cavity =
        k.specular == SPECULAR_COOK_TORRANCE || (k.specular == SPECULAR_MICROFACET && k.geometry == GEOMETRY_V_CAVITY);
    const auto excess = kBrightGrazing.find(nameOf(k));
    CAPTURE(nameOf(k), worst.value, worst.cosine, worst.roughness);
    if (excess == kBrightGrazing.end()) {
      CHECK(worst.value <= (cavity ? kGuard : 1.001));
    } else {
      CHECK(worst.value > excess->second.low);
      CHECK(worst.value < excess->second.high);
    }
    if (worst.value > 1.001) WARN("toward the horizon, " << nameOf(k) << ": at most " << worst);
  }
}

TEST_CASE("energy: (p + 8)/8pi gains 7.5 % near p = 8.8") {
  shading::Rungs k = defaultRungs();
  k.specular = SPECULAR_NORMALIZED_BLINN_PHONG;
  double worst = 0, at = 0;
  for (double p = 1; p < 40; p += 0.1) {
    const dvec2 e = reference::lobeAlbedo(k, 1, f64::alphaFromPower(p));
    if (e.x + e.y > worst) worst = e.x + e.y, at = p;
  }
  CHECK(worst == Approx(1.0752).margin(2e-4));
  CHECK(at == Approx(8.8).margin(0.15));
}

TEST_CASE("energy: two widths") {
  for (const int model : {SPECULAR_WARD_BOUNDED, SPECULAR_WARD_ANISOTROPIC}) {
    Worst worst;
    shading::Rungs k = defaultRungs();
    k.specular = model;
    k.anisotropic = 1;
    k.fresnel = FRESNEL_NONE;
    for (const dvec3 tangent : {dvec3(1, 0, 0), dvec3(0, 1, 0)})
      for (const double r : {0.2, 0.4, 0.7})
        for (const double nov : {0.05, 0.2, 0.5, 1.0}) {
          reference::OracleSurface s;
          s.v = viewAt(nov), s.albedo = dvec3(1), s.substance = 1, s.alpha = r * r, s.tangent = tangent,
          s.anisotropy = 0.7;
          worst.note(reference::directionalAlbedo(s, k, {128, 96}).specular.x, r, nov);
        }
    WARN("two widths, model " << model << ": at most " << worst);
    CHECK(worst.value <= 1.001);  // Ward's own passes 1 toward the horizon alone
  }
}

TEST_CASE("energy: white metal at roughness 0.01 to 0.1, in float, every distribution and geometry") {
  // H12: a guard of 1e-4 in a denominator once left 0.035 of it.
  double worst = 0;
  for (const shading::Rungs& k : specularRungs())
    for (const double r : {0.01, 0.02, 0.03, 0.05, 0.07, 0.1})
      for (const double nov : {0.05, 0.2, 0.5, 0.8, 1.0}) {
        const double alpha = r * r;
        const f32::Surface m = f32::makeSurface({0, 0, 1}, glm::vec3(viewAt(nov)), glm::vec3(1), 1, float(alpha));
        const auto inFloat = [&](const dvec3& l) {
          const f32::Angles a = f32::anglesOf(m, glm::vec3(l));
          return double(f32::fresnelRung(m.f0, m.eta, m.k, a.loh, FRESNEL_SCHLICK).x * f32::specularRung(m, a, k));
        };
        const bool phong = lobeFamily(k) == LOBE_FAMILY_PHONG;
        const double sum = phong ? reference::integrateMirror<double>(nov, alpha, inFloat)
                                 : reference::integrateHalf<double>(nov, alpha, inFloat);
        const dvec2 e = reference::lobeAlbedo(k, nov, alpha, true);
        CAPTURE(nameOf(k), r, nov, sum);
        const double error = std::abs(sum / (e.x + e.y) - 1);
        CHECK(error < 0.01);
        worst = std::max(worst, error);
        // Not by the same text alone: a guard that eats both would not show.
        const double mirror = mirrorAlbedo(k, nov);
        if (mirror > 0 && r <= 0.03 && nov >= 0.2) CHECK(sum == Approx(mirror).epsilon(0.01));
      }
  WARN("narrow lobes in float: albedo off by at most " << worst * 100 << " %");
}
