// The G-buffer's target for brushed and rough surfaces: what its four bytes lose, in float and in double.
#include <algorithm>
#include <catch2/catch.hpp>

#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

namespace {

/// As an 8-bit target rounds.
template <class V>
V stored(V v) {
  return glm::floor(v * decltype(v.x)(255) + decltype(v.x)(0.5)) / decltype(v.x)(255);
}

}  // namespace

TEST_CASE("details: the tangent comes back within 3.1e-5 radians, widths within 1.6 %, sigma within 0.002") {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> uniform(0, 1);
  double angle = 0, angleFloat = 0, width = 0, sigma = 0;
  for (int i = 0; i < 200'000; ++i) {
    const dvec3 n = f64::unpackNormal(f64::packNormal(i < 6 ? dvec3(i == 0, i == 1, i == 2) - dvec3(i == 3, i == 4, i == 5) : randomUnit(random)));
    dvec3 t = randomUnit(random);
    t = normalize(t - n * dot(n, t));
    const double alpha = std::pow(10.0, -3.3 * uniform(random)), s = uniform(random);
    const auto d = stored(f64::packDetail(n, t * std::exp(4 * uniform(random) - 2), alpha, s));
    angle = std::max(angle, glm::length(cross(f64::unpackTangent(n, d), t)));
    width = std::max(width, std::abs(f64::decodeAlpha(d.z) / f64::storedAlpha(alpha) - 1));
    sigma = std::max(sigma, std::abs(d.w - s));
    const auto e = stored(f32::packDetail(glm::vec3(n), glm::vec3(t), float(alpha), float(s)));
    angleFloat = std::max(angleFloat, glm::length(cross(dvec3(f32::unpackTangent(glm::vec3(n), e)), t)));
  }
  WARN("details: tangent within " << angle << " radians (in float " << angleFloat << "), alpha within " << 100 * width << " %, sigma within " << sigma);
  CHECK(angle < 3.1e-5);
  CHECK(angleFloat < 3.3e-5);
  CHECK(width < 0.0163);
  CHECK(sigma <= 0.5 / 255 + 1e-12);
}

TEST_CASE("details: no tangent, and zeros, are a round lobe; a line has no sign") {
  const dvec3 n(0, 0, 1);
  for (const dvec3& none : {dvec3(0), dvec3(0, 0, 3), dvec3(0, 0, -1e30)}) {
    const auto d = f64::packDetail(n, none, 1, 0.25);
    CHECK((d.x == 0 && d.y == 0 && d.z == 0 && d.w == 0.25));
  }
  f64::Surface m = f64::makeSurface(n, n, dvec3(1), 1, 0.04);
  f64::setWidth(m, f64::unpackTangent(n, glm::dvec4(0)), f64::decodeAlpha(0));
  CHECK((m.alphaX == 0.04 && m.alphaY == 0.04));
  CHECK(m.alpha == Approx(0.04).epsilon(1e-12));
  CHECK(m.power == Approx(f64::powerFromAlpha(0.04)).epsilon(1e-9));
  const auto there = f64::packDetail(n, {0.3, 0.4, 0}, 0.5, 0), back = f64::packDetail(n, {-0.3, -0.4, 0}, 0.5, 0);
  CHECK(there == back);
  CHECK(f64::packDetail(n, {0, 1, 0}, 0.5, 0) != there);
}

TEST_CASE("two widths that are one are the round lobe, every model") {
  std::mt19937_64 random(32);
  for (shading::Rungs k : specularRungs())
    for (const double alpha : {0.01, 0.3, 1.0})
      for (int i = 0; i < 200; ++i) {
        const dvec3 n = randomUnit(random), v = randomUnit(random), l = randomUnit(random);
        if (dot(n, v) < 0.02 || dot(n, l) < 0.02) continue;
        f64::Surface m = f64::makeSurface(n, v, dvec3(1), 1, alpha);
        k.anisotropic = 0;
        const double round = f64::specularRung(m, f64::anglesOf(m, l), k);
        k.anisotropic = 1;
        f64::setTangent(m, randomUnit(random), 0);
        CAPTURE(nameOf(k), alpha);
        CHECK(f64::specularRung(m, f64::anglesOf(m, l), k) == Approx(round).epsilon(1e-6).margin(1e-12));
      }
}

TEST_CASE("the mean of two widths stands for both where one is asked for: albedo within 0.09 on the mean over azimuths") {
  double worst = 0, narrow = 0;
  for (const int geometry : {GEOMETRY_KELEMEN, GEOMETRY_SMITH})
    for (const double alpha : {0.04, 0.25})
      for (const double strength : {0.4, 0.7, 1.0})
        for (const double nov : {0.1, 0.4, 1.0}) {
          shading::Rungs k = defaultRungs(geometry);
          k.distribution = geometry == GEOMETRY_SMITH ? DISTRIBUTION_GGX : DISTRIBUTION_BLINN_PHONG;
          k.anisotropic = 1;
          double mean = 0;
          f64::Surface m;
          for (int i = 0; i < 8; ++i) {
            reference::OracleSurface s;
            s.v = reference::directionAt(nov), s.albedo = dvec3(1), s.substance = 1, s.alpha = alpha, s.anisotropy = strength;
            // Quadrature takes one half of the hemisphere: turns to either side make up for it.
            s.tangent = {std::cos((i + 0.5) * kPi / 8), std::sin((i + 0.5) * kPi / 8), 0};
            mean += reference::directionalAlbedo(s, k, {128, 96}).specular.x / 8;
            m = reference::surfaceOf(s, nullptr);
          }
          k.anisotropic = 0;
          const auto albedo = [&](double a) {
            const glm::dvec2 e = reference::lobeAlbedo(k, nov, a, true);
            return e.x + e.y;
          };
          CHECK(mean < 1.001);
          worst = std::max(worst, std::abs(albedo(m.alpha) - mean));
          narrow = std::max(narrow, std::abs(albedo(m.alphaY) - mean));
        }
  WARN("two widths: the round lobe of their mean is off by at most " << worst << ", that of the narrow one by " << narrow);
  CHECK(worst < 0.09);
  CHECK(narrow > 0.3);
}

TEST_CASE("rough diffuse: its albedo toward the eye in closed form, and no more than white with what specular takes") {
  double worst = 0, most = 0;
  for (const double sigma : {0.0, 0.2, 0.5, 1.0})
    for (const double nov : {0.05, 0.3, 0.7, 1.0}) {
      const dvec3 v = reference::directionAt(nov);
      for (const double rho : {0.2, 0.7, 1.0}) {
        const double sum = reference::integrateCosine<double>([&](const dvec3& l) { return f64::Fd_orenNayarEnergy(l.z, nov, dot(l, v), sigma, rho) * l.z; }, {96, 96});
        worst = std::max(worst, std::abs(f64::orenNayarEnergyAlbedo(nov, sigma, rho) - sum));
      }
      for (const double r : {0.1, 0.4, 0.7, 1.0})
        for (const double substance : {0.0, 0.2, 1.0 / 3, 0.4}) {
          shading::Rungs k = defaultRungs();
          k.roughDiffuse = 1;
          reference::OracleSurface s;
          s.v = v, s.albedo = dvec3(1), s.substance = substance, s.alpha = r * r, s.sigma = sigma;
          const reference::DirectionalAlbedo e = reference::directionalAlbedo(s, k);
          most = std::max(most, e.diffuse.x + e.specular.x);
        }
    }
  WARN("rough diffuse: closed form within " << worst << ", with specular at most " << most);
  CHECK(worst < 3e-3);
  CHECK(most < 1.005);
}
