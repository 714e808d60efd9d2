// Specular models as their papers write them, with half vector and mirrored direction, against the shading text;
// normalizations, distributions, widths.
#include <catch2/catch.hpp>

#include "reference/quadrature.h"
#include "sphere.h"
#include "test_rungs.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f64 = burnish::shading::f64;

namespace {

struct Frame {
  dvec3 n, l, v, t, b;
  double alpha, ax, ay;
};

double normalization(int rung, double p) {
  switch (rung) {
    case NORMALIZATION_NONE:
      return 1;
    case NORMALIZATION_LINEAR_FIT:
      return 0.0397436 * p + 0.0856832;
    case NORMALIZATION_LINEAR_FIT_8:
      return 0.0397436 * p + 0.3183;
    case NORMALIZATION_PLUS_2:
      return (p + 2) / (8 * kPi);
    case NORMALIZATION_PLUS_8:
      return (p + 8) / (8 * kPi);
    default:
      return (p + 2) * (p + 4) / (8 * kPi * (std::pow(2, -p / 2) + p));
  }
}

double lambda(double c, double alpha, bool ggx) {
  const double tan = std::sqrt(1 - c * c) / c, a = 1 / (alpha * tan);
  if (ggx) return 0.5 * (std::sqrt(1 + 1 / (a * a)) - 1);
  return tan == 0 ? 0 : 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
}

/// f (n·l) / F of the rungs, from l, v, h and r as the papers have them.
double byThePaper(const shading::Rungs& k, const Frame& f) {
  const dvec3 h = normalize(f.l + f.v), r = 2 * dot(f.n, f.l) * f.n - f.l;
  const double nl = dot(f.n, f.l), nv = dot(f.n, f.v), nh = dot(f.n, h), lh = dot(f.l, h), rv = dot(r, f.v);
  const double hx = dot(h, f.t), hy = dot(h, f.b), along = hx * hx + hy * hy;
  // Two widths: Ashikhmin and Shirley's power over the azimuth, and what a facet's profile is toward a direction.
  const bool two = hasTwoWidths(k) && along > 0;
  const double a2 = two ? along / (hx * hx / (f.ax * f.ax) + hy * hy / (f.ay * f.ay)) : f.alpha * f.alpha;
  const double p = 2 / a2 - 2, q = p / 4, tan2 = dot(cross(f.n, h), cross(f.n, h)) / (nh * nh);
  const auto toward = [&](const dvec3& o) {
    const double x = dot(o, f.t), y = dot(o, f.b);
    return two ? std::sqrt((x * x * f.ax * f.ax + y * y * f.ay * f.ay) / (x * x + y * y)) : f.alpha;
  };
  const double al = toward(f.l), av = toward(f.v), area = two ? f.ax * f.ay : f.alpha * f.alpha;
  const double phong = rv > 0 ? std::pow(rv, q) : 0;  // also for q = 0
  const double gauss = std::exp(-tan2 / a2),
               gauss2 = std::exp(-(hx * hx / (f.ax * f.ax) + hy * hy / (f.ay * f.ay)) / (nh * nh));
  const double beckmann = gauss2 / (kPi * area * std::pow(nh, 4));
  const double ggx = 1 / (kPi * area * std::pow(hx * hx / (f.ax * f.ax) + hy * hy / (f.ay * f.ay) + nh * nh, 2));
  const double cavity = std::min({1.0, 2 * nh * nv / lh, 2 * nh * nl / lh});
  const auto smith = [&](bool g) { return 1 / (1 + lambda(nl, al, g) + lambda(nv, av, g)); };
  switch (k.specular) {
    case SPECULAR_PHONG:
      return phong;
    case SPECULAR_BLINN_PHONG:
      return std::pow(nh, p);
    case SPECULAR_MODIFIED_PHONG:
      return (q + 2) / (2 * kPi) * phong * nl;
    case SPECULAR_MAX_PHONG:
      return (q + 1) / (2 * kPi) * phong / std::max(nl, nv) * nl;
    case SPECULAR_NORMALIZED_BLINN_PHONG:
      return (p + 8) / (8 * kPi) * std::pow(nh, p) * nl;
    case SPECULAR_COOK_TORRANCE:
      return beckmann * cavity / (4 * nl * nv) * nl;
    case SPECULAR_WARD:
      return gauss / (4 * kPi * a2 * std::sqrt(nl * nv)) * nl;
    case SPECULAR_WARD_ANISOTROPIC:
      return gauss2 / (4 * kPi * f.ax * f.ay * std::sqrt(nl * nv)) * nl;
    case SPECULAR_WARD_BOUNDED: {
      const dvec3 both = f.l + f.v;
      return gauss2 * dot(both, both) / (kPi * f.ax * f.ay * std::pow(dot(both, f.n), 4)) * nl;
    }
    case SPECULAR_GGX_SMITH:
      return ggx * smith(true) / (4 * nl * nv) * nl;
    default:
      break;
  }
  if (k.geometry == GEOMETRY_VOID && k.distribution == DISTRIBUTION_BLINN_PHONG)
    return normalization(k.normalization, p) * a2 / area * std::pow(nh, p) * nl;
  const double px = 2 / (f.ax * f.ax) - 2, py = 2 / (f.ay * f.ay) - 2;
  const double d = k.distribution == DISTRIBUTION_BLINN_PHONG ? std::sqrt((px + 2) * (py + 2)) / (2 * kPi) * std::pow(nh, along > 0 ? (px * hx * hx + py * hy * hy) / along : 0)
                   : k.distribution == DISTRIBUTION_BECKMANN  ? beckmann
                                                              : ggx;
  const double share = k.distribution == DISTRIBUTION_GGX ? 0.5 : std::sqrt(2 / kPi), wl = al * share, wv = av * share;
  double g = nl * nv;
  if (k.geometry == GEOMETRY_KELEMEN) g = nl * nv / (lh * lh);
  if (k.geometry == GEOMETRY_SCHLICK_SMITH) g = nl / (nl * (1 - wl) + wl) * nv / (nv * (1 - wv) + wv);
  if (k.geometry == GEOMETRY_SMITH) g = smith(k.distribution == DISTRIBUTION_GGX);
  if (k.geometry == GEOMETRY_V_CAVITY) g = cavity;
  return d * g / (4 * nl * nv) * nl;
}

/// Smith's term with Gaussian slopes is a fit.
bool fitted(const shading::Rungs& k) {
  return k.specular == SPECULAR_MICROFACET && k.geometry == GEOMETRY_SMITH && k.distribution != DISTRIBUTION_GGX;
}

Frame randomFrame(std::mt19937_64& random, double alpha, double strength) {
  std::uniform_real_distribution<double> uniform(0, 1);
  while (true) {
    Frame f;
    f.n = randomUnit(random);
    f.v = randomUnit(random);
    f.t = normalize(cross(f.n, randomUnit(random)));
    f.b = cross(f.n, f.t);
    f.alpha = alpha;
    f.ax = alpha + (1 - alpha) * strength * strength;
    f.ay = alpha;
    // Half of the lights over the sphere, half within a few widths of the mirrored direction.
    f.l = randomUnit(random);
    if (uniform(random) < 0.5) {
      const double angle = std::min(4 * alpha, 1.2) * uniform(random), turn = 2 * kPi * uniform(random);
      const dvec3 h = f.n * std::cos(angle) + (f.t * std::cos(turn) + f.b * std::sin(turn)) * std::sin(angle);
      f.l = glm::reflect(-f.v, h);
    }
    if (dot(f.n, f.l) > 0.01 && dot(f.n, f.v) > 0.01) return f;
  }
}

double evaluate(const shading::Rungs& k, const Frame& f, double strength) {
  f64::Surface m = f64::makeSurface(f.n, f.v, dvec3(1), 1, f.alpha);
  if (strength > 0 && hasTwoWidths(k)) f64::setTangent(m, f.t * 3.0 + f.n, strength);
  return f64::specularRung(m, f64::anglesOf(m, f.l), k);
}

}  // namespace

TEST_CASE("models: every specular rung is what its paper says") {
  double fit = 0;
  for (shading::Rungs k : specularRungs())
    for (const double alpha : {4e-4, 0.01, 0.1, 0.3, 0.7, 1.0})
      for (const double strength : {0.0, 0.6}) {
        k.anisotropic = strength > 0;
        std::mt19937_64 random(13);
        double worst = 0, largest = 0;
        for (int i = 0; i < 1000; ++i) {
          const Frame f = randomFrame(random, alpha, strength);
          const double truth = byThePaper(k, f);
          if (truth < 1e-30) continue;
          largest = std::max(largest, truth);
          worst = std::max(worst, std::abs(evaluate(k, f, strength) - truth) / (truth + 1e-9));
        }
        if (fitted(k)) fit = std::max(fit, worst);
        CAPTURE(nameOf(k), alpha, strength, worst);
        CHECK(largest > 1e-3);
        CHECK(worst <
              (fitted(k)
                   ? 0.0065
                   : 2e-5));  // ln(1 - x) has a truncated series in double too: 3e-7 of an exponent that reaches 70
      }
  WARN("models: Smith's rational fit off by at most " << fit * 100 << " %");
}

TEST_CASE("models: the three evaluations of a power of a cosine agree in double") {
  std::mt19937_64 random(14);
  for (int model : {SPECULAR_PHONG, SPECULAR_BLINN_PHONG, SPECULAR_MODIFIED_PHONG, SPECULAR_MICROFACET})
    for (const double alpha : {0.03, 0.2, 0.6, 1.0})
      for (int i = 0; i < 500; ++i) {
        shading::Rungs k = defaultRungs();
        k.specular = model;
        const Frame f = randomFrame(random, alpha, 0);
        const double truth = byThePaper(k, f);
        for (int lobe : {LOBE_POW, LOBE_EXP2, LOBE_STABLE}) {
          k.lobe = lobe;
          CAPTURE(nameOf(k), lobe, alpha, truth);
          CHECK(evaluate(k, f, 0) == Approx(truth).epsilon(2e-5).margin(1e-9));
        }
      }
}

TEST_CASE("models: normalizations of void geometry against the exact one") {
  for (const double p : {0.0, 0.5, 1.0, 8.8, 16.0, 64.0, 1000.0, 1.25e7})
    for (int rung = NORMALIZATION_NONE; rung <= NORMALIZATION_EXACT; ++rung)
      CHECK(f64::normalizationRung(p, rung) == Approx(normalization(rung, p)).epsilon(1e-12));
  struct Row {
    int rung;
    double p, percent;
  };
  // docs/shading.md, section 4; the second fit is its sibling.
  for (const Row& row : {Row{NORMALIZATION_LINEAR_FIT, 1, -64.1}, Row{NORMALIZATION_LINEAR_FIT, 16, -19.4},
                         Row{NORMALIZATION_LINEAR_FIT, 64, -5.8}, Row{NORMALIZATION_LINEAR_FIT_8, 1, 2.4},
                         Row{NORMALIZATION_LINEAR_FIT_8, 16, 6.61}, Row{NORMALIZATION_LINEAR_FIT_8, 64, 2.57},
                         Row{NORMALIZATION_PLUS_2, 1, -65.9}, Row{NORMALIZATION_PLUS_2, 16, -20.0},
                         Row{NORMALIZATION_PLUS_2, 64, -5.9}, Row{NORMALIZATION_PLUS_8, 8.8, 7.52}}) {
    const double percent = (f64::normalizationRung(row.p, row.rung) / f64::normalizationExact(row.p) - 1) * 100;
    CAPTURE(row.rung, row.p, percent);
    CHECK(std::abs(percent - row.percent) < 0.06);
  }
}

TEST_CASE("models: every distribution integrates to one") {
  const reference::GaussRule polar(256), azimuth(128);
  // D (n·h) dh with tan² = width² u/(1 - u).
  const auto integral = [&](double width, const auto& density) {
    double sum = 0;
    for (std::size_t i = 0; i < polar.node.size(); ++i) {
      const double u = polar.node[i], a2 = width * width, d = 1 - u + a2 * u, c = std::sqrt((1 - u) / d),
                   s = width * std::sqrt(u / d);
      for (std::size_t j = 0; j < azimuth.node.size(); ++j) {
        const double phi = 2 * kPi * azimuth.node[j];
        sum += density(dvec3(s * std::cos(phi), s * std::sin(phi), c)) * polar.weight[i] * azimuth.weight[j] * kPi *
               a2 / (d * d);
      }
    }
    return sum;
  };
  for (const double alpha : {4e-4, 0.01, 0.1, 0.5, 1.0}) {
    const double p = f64::powerFromAlpha(alpha);
    CAPTURE(alpha);
    const auto sin2 = [](const dvec3& h) { return h.x * h.x + h.y * h.y; };
    CHECK(integral(alpha, [&](const dvec3& h) { return f64::D_blinnPhong(f64::lobeStable(sin2(h), p), p); }) ==
          Approx(1).epsilon(1e-6));
    CHECK(integral(alpha, [&](const dvec3& h) { return f64::D_beckmann(sin2(h), alpha); }) == Approx(1).epsilon(1e-5));
    CHECK(integral(alpha, [&](const dvec3& h) { return f64::D_ggx(sin2(h), alpha); }) == Approx(1).epsilon(1e-9));
    for (const double ratio : {1.5, 4.0}) {
      const double ax = std::min(alpha * ratio, 1.0);
      CAPTURE(ax);
      CHECK(integral(std::sqrt(ax * alpha), [&](const dvec3& h) {
              const double a = f64::alphaAlong(h.x, h.y, ax, alpha);
              return f64::D_beckmann(sin2(h), a) * f64::twoWidthsScale(a, ax, alpha);
            }) == Approx(1).epsilon(1e-4));
      CHECK(integral(std::sqrt(ax * alpha), [&](const dvec3& h) {
              const double a = f64::alphaAlong(h.x, h.y, ax, alpha);
              return f64::D_ggx(sin2(h), a) * f64::twoWidthsScale(a, ax, alpha);
            }) == Approx(1).epsilon(1e-4));
      CHECK(integral(std::sqrt(ax * alpha), [&](const dvec3& h) {
              const double a = f64::alphaAlong(h.x, h.y, ax, alpha), pa = f64::powerFromAlpha(a);
              return f64::D_blinnPhong(f64::lobeStable(sin2(h), pa), pa) * f64::twoWidthsScale(a, ax, alpha);
            }) == Approx(1).epsilon(1e-4));
    }
  }
}

TEST_CASE("models: conversions of width") {
  // Half of D cos⁴ at the same tangent.
  const auto half = [](const auto& d, double alpha) {
    double low = 0, high = 100 * alpha;
    const auto value = [&](double tan) { return d(tan * tan / (1 + tan * tan), alpha) / std::pow(1 + tan * tan, 2); };
    for (int i = 0; i < 100; ++i) (value(0.5 * (low + high)) > 0.5 * value(0) ? low : high) = 0.5 * (low + high);
    return low;
  };
  for (const double alpha : {0.01, 0.1, 0.5}) {
    CHECK(half(f64::D_ggx, f64::ggxFromBeckmann(alpha)) == Approx(half(f64::D_beckmann, alpha)).epsilon(1e-6));
    CHECK(f64::beckmannFromGgx(f64::ggxFromBeckmann(alpha)) == Approx(alpha).epsilon(1e-7));
    CHECK(f64::alphaFromPower(f64::powerFromAlpha(alpha)) == Approx(alpha).epsilon(1e-12));
    CHECK(f64::powerFromAlpha(f64::alphaFromRoughness(std::sqrt(alpha))) ==
          Approx(2 / (alpha * alpha) - 2).epsilon(1e-12));
    const double p = f64::powerFromAlpha(alpha);
    CHECK(f64::blinnPhongFromPhong(f64::phongFromBlinnPhong(p)) == Approx(p));
  }
  // cos^q(x) and cos^p(x/2) fall to one half at the same angle, the narrower the better.
  for (const double alpha : {0.01, 0.05, 0.1}) {
    const double p = f64::powerFromAlpha(alpha), phong = std::acos(std::pow(0.5, 1 / f64::phongFromBlinnPhong(p))),
                 blinn = 2 * std::acos(std::pow(0.5, 1 / p));
    CHECK(phong / blinn == Approx(1).epsilon(2 * alpha * alpha));
  }
  // Beckmann's slopes: ∫ D (n·h) tan² cos² φ dh = sigma² (alpha²/2), and sigma is that of small angles.
  const reference::GaussRule rule(400);
  for (const double alpha : {0.05, 0.2}) {
    double variance = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double tan = 10 * alpha * rule.node[i], c2 = 1 / (1 + tan * tan);
      variance += rule.weight[i] * 10 * alpha * f64::D_beckmann(tan * tan * c2, alpha) * c2 * c2 * tan * tan * tan *
                  kPi;  // sin cos dθ = tan cos⁴ dtan
    }
    CHECK(f64::sigmaFromAlpha(alpha) == Approx(std::sqrt(variance)).epsilon(1e-5));
  }
}
