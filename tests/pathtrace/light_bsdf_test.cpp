// The path tracer's surfaces: what they draw has the density that they state, and reflects what the oracle's quadrature in double says, for every rung.
#include <catch2/catch.hpp>
#include <map>

#include "light_surfaces.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec3;
using pathtrace::Bsdf;
using pathtrace::LobeTable;
using pathtrace::SurfacePoint;
namespace f32 = burnish::shading::f32;
namespace f64 = burnish::shading::f64;

namespace {

struct Case {
  shading::Rungs rungs;
  double substance = 1.0 / 3, roughness = 0.5, nov = 0.5, anisotropy = 0, sigma = 0;
  dvec3 albedo{0.8, 0.5, 0.2}, eta{0}, k{0};
};

SurfacePoint pointOf(const Case& c) {
  SurfacePoint p = surfaceFor(vec3(c.albedo), c.substance, c.roughness * c.roughness);
  p.eta = vec3(c.eta), p.k = vec3(c.k), p.sigma = float(c.sigma);
  p.brushed = c.anisotropy > 0, p.tangent = {0.6f, 0.8f, 0};
  p.alphaX = float(f64::alphaOfStrength(c.roughness * c.roughness, c.anisotropy));
  return p;
}

/// Standard errors between sampled and integrated albedo, the worst of three channels. The oracle's tables and the renderer's differ by up to 1e-3 (docs/shading.md).
double deviation(const Case& c, int samples, std::uint64_t seed) {
  reference::OracleSurface s;
  const double alpha = c.roughness * c.roughness;
  s.v = dvec3(eyeAt(c.nov)), s.albedo = c.albedo, s.substance = c.substance, s.alpha = alpha, s.eta = c.eta, s.k = c.k, s.sigma = c.sigma;
  s.tangent = {0.6, 0.8, 0}, s.anisotropy = c.anisotropy;
  const bool table = needsAlbedoTable(c.rungs);
  const double tableAlpha = f64::Surface(reference::surfaceOf(s, nullptr)).alpha;
  static std::map<std::pair<std::string, double>, reference::LobeEnergy> energies;
  const reference::LobeEnergy* energy = nullptr;
  if (table) energy = &energies.try_emplace({nameOf(c.rungs), tableAlpha}, c.rungs, tableAlpha, 96).first->second;
  dvec3 exact;
  if (c.anisotropy > 0) {
    // Two widths are not symmetric about the plane of the eye: the sum of both halves.
    exact = dvec3(0);
    for (const double side : {1.0, -1.0}) {
      s.tangent.y = 0.8 * side;
      const auto part = reference::directionalAlbedo(s, c.rungs, {96, 96}, energy);
      exact += 0.5 * (part.diffuse + part.specular);
    }
  } else {
    const auto part = reference::directionalAlbedo(s, c.rungs, {64, 64}, energy);
    exact = part.diffuse + part.specular;
  }
  const LobeTable lobe(c.rungs);
  const Bsdf bsdf(pointOf(c), eyeAt(c.nov), c.rungs, lobe);
  Dice dice(seed);
  Mean mean[3];
  for (int i = 0; i < samples; ++i) {
    vec3 l;
    const float pick = dice.next();
    const bool good = bsdf.sample(pick, dice.next2(), l);
    const pathtrace::Reflected r = good ? bsdf.reflected(l) : pathtrace::Reflected{};
    for (int j = 0; j < 3; ++j) mean[j].add(r.density > 0 ? double(r.value[j] / r.density) : 0);
  }
  double worst = 0;
  for (int j = 0; j < 3; ++j) {
    const double off = mean[j].value() - exact[j], slack = 2e-4 + (table ? 1e-3 : 0);
    const double z = std::copysign(std::max(std::abs(off) - slack, 0.0), off) / std::max(mean[j].error(), 1e-9);
    if (std::abs(z) > std::abs(worst)) worst = z;
  }
  if (std::abs(worst) > 4) {
    CAPTURE(nameOf(c.rungs), c.rungs.fresnel, c.rungs.diffuse, c.rungs.compensation, c.substance, c.roughness, c.nov, c.anisotropy, c.sigma);
    CAPTURE(mean[0].value(), mean[1].value(), mean[2].value(), exact.x, exact.y, exact.z, mean[0].error());
    CHECK(std::abs(worst) <= 4);
  }
  return worst;
}

/// Standard errors over many cases: none beyond 4 (4 in 10,000 channels are by chance beyond 3.5), and their mean within 3.
struct Deviations {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double z) { sum += z, squares += z * z, ++count; }
  void check() const {
    CAPTURE(sum, squares, count);
    CHECK(std::abs(sum) < 3 * std::sqrt(squares));
    CHECK(count > 0);
  }
};

/// A grid of directions, dense where the lobe's half vectors are: visit(l, solid angle, index of the cell) over the whole sphere. Polar angles of half vectors grow as alpha sinh.
template <class Visit>
void overSphere(const vec3& eye, double alpha, Visit&& visit) {
  constexpr int kPolar = 640, kAzimuth = 320;
  const dvec3 v(eye);
  const double width = std::min(alpha, 0.5), k = std::asinh(kTurn / 2 / width);
  for (int i = 0; i < kPolar; ++i) {
    const double s = (i + 0.5) / kPolar, theta = width * std::sinh(k * s), step = width * k * std::cosh(k * s) / kPolar;
    for (int j = 0; j < kAzimuth; ++j) {
      const double phi = kTurn * (j + 0.5) / kAzimuth;
      const dvec3 h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double voh = dot(v, h), solid = std::sin(theta) * step * kTurn / kAzimuth;
      visit(vec3(2 * voh * h - v), h, voh > 0 ? 4 * voh * solid : 0.0, solid, i * 16 / kPolar * 16 + j * 16 / kAzimuth);
    }
  }
}

const std::vector<double> kAngles{0.05, 0.3, 0.95};

}  // namespace

TEST_CASE("light: every specular rung's samples reflect its directional albedo") {
  Deviations all;
  std::uint64_t seed = 1;
  for (const shading::Rungs& k : specularRungs())
    for (const double r : {0.02, 0.2, 0.5, 1.0})
      for (const double nov : kAngles) all.add(deviation({.rungs = k, .roughness = r, .nov = nov}, 12000, ++seed));
  all.check();
}

TEST_CASE("light: Fresnel's, diffuse and compensation rungs likewise") {
  Deviations all;
  std::uint64_t seed = 1000;
  for (int fresnel = 0; fresnel <= FRESNEL_CONDUCTOR; ++fresnel)
    for (const double substance : {0.0, 0.4, 0.7, 1.0}) {
      Case c{.rungs = defaultRungs(GEOMETRY_SMITH), .substance = substance, .roughness = 0.4, .nov = 0.25};
      c.rungs.distribution = DISTRIBUTION_GGX, c.rungs.fresnel = fresnel;
      if (substance == 1) c.eta = {0.2, 0.4, 1.3}, c.k = {3.9, 2.4, 1.8};
      all.add(deviation(c, 12000, ++seed));
    }
  for (int diffuse = 0; diffuse <= DIFFUSE_OREN_NAYAR_ENERGY; ++diffuse)
    for (const double r : {0.1, 0.7, 1.0})
      for (const double sigma : {0.0, 0.5}) {
        Case c{.rungs = defaultRungs(), .substance = 0.1, .roughness = r, .nov = 0.2, .sigma = sigma};
        c.rungs.diffuse = diffuse, c.rungs.roughDiffuse = 1;
        all.add(deviation(c, 12000, ++seed));
      }
  for (const double r : {0.3, 0.8, 1.0})
    for (const double substance : {1.0 / 3, 1.0}) {
      Case c{.rungs = defaultRungs(GEOMETRY_SMITH), .substance = substance, .roughness = r, .nov = 0.4};
      c.rungs.distribution = DISTRIBUTION_GGX, c.rungs.compensation = COMPENSATION_MULTIPLE_SCATTERING, c.rungs.diffuse = DIFFUSE_COUPLED;
      all.add(deviation(c, 12000, ++seed));
    }
  all.check();
}

TEST_CASE("light: brushed surfaces likewise") {
  Deviations all;
  std::uint64_t seed = 2000;
  for (const shading::Rungs& k : specularRungs()) {
    if (!hasTwoWidths(k)) continue;
    Case c{.rungs = k, .substance = 1, .roughness = 0.4, .nov = 0.6, .anisotropy = 0.7};
    c.rungs.anisotropic = 1;
    all.add(deviation(c, 12000, ++seed));
  }
  all.check();
}

TEST_CASE("light: densities integrate to one, and directions are drawn as they say") {
  std::vector<shading::Rungs> lobes;
  for (int distribution = 0; distribution <= DISTRIBUTION_GGX; ++distribution)
    for (const int geometry : {GEOMETRY_KELEMEN, GEOMETRY_SMITH}) {
      lobes.push_back(defaultRungs(geometry));
      lobes.back().distribution = distribution;
    }
  lobes.push_back(defaultRungs());
  lobes.back().specular = SPECULAR_MODIFIED_PHONG;
  std::uint64_t seed = 3000;
  for (const shading::Rungs& k : lobes)
    for (const double r : {0.03, 0.4, 1.0})
      for (const double nov : {0.02, 0.5, 1.0})
        for (const double anisotropy : {0.0, 0.6}) {
          if (anisotropy > 0 && (!hasTwoWidths(k) || r < 0.1)) continue;
          Case c{.rungs = k, .substance = 0.2, .roughness = r, .nov = nov, .anisotropy = anisotropy};
          c.rungs.anisotropic = 1;
          const LobeTable table(c.rungs);
          const vec3 eye = eyeAt(nov);
          const Bsdf bsdf(pointOf(c), eye, c.rungs, table);
          CAPTURE(nameOf(k), r, nov, anisotropy);
          // Of the facets that a lobe draws some look away from the eye and give no direction, unless only those that it sees are drawn.
          const int family = lobeFamily(k);
          const bool facets = family != LOBE_FAMILY_PHONG && !(family == LOBE_FAMILY_GGX && k.geometry == GEOMETRY_SMITH);
          const f32::Surface& m = bsdf.surface();
          double whole = 0, away = 0, lobeShare = 0;
          std::vector<double> expected(257, 0.0);
          overSphere(eye, r * r, [&](const vec3& l, const dvec3& h, double solid, double ofHalf, int cell) {
            const double p = bsdf.density(l) * solid;
            whole += p;
            if (l.z > 0) expected[std::size_t(cell)] += p;
            const vec3 half(h);
            if (facets && dot(h, dvec3(eye)) <= 0 && h.z > 0)
              away += ofHalf * double(anisotropy > 0 ? f32::twoWidthsDensity({dot(half, m.t), dot(half, m.b), 0}, m.alphaX, m.alphaY, family) : f32::lobeDensity(float(1 - h.z * h.z), m.alpha, family));
          });
          // The cosine's share at a direction that the lobe hardly reaches tells the lobe's.
          const double cosineOnly = bsdf.density({0, 0, -1});
          CHECK(cosineOnly < 1e-3 + (family == LOBE_FAMILY_PHONG || r == 1 ? 1 : 0));
          Dice dice(++seed);
          int below = 0;
          constexpr int kSamples = 40000;
          std::vector<double> found(257, 0.0);
          const double width = std::min(r * r, 0.5), scale = std::asinh(kTurn / 2 / width);
          for (int i = 0; i < kSamples; ++i) {
            vec3 l;
            const float pick = dice.next();
            if (!bsdf.sample(pick, dice.next2(), l)) {
              ++below;
              continue;
            }
            const dvec3 h = normalize(dvec3(l) + dvec3(eye));
            const double theta = std::atan2(std::hypot(h.x, h.y), h.z);
            double phi = std::atan2(h.y, h.x);
            if (phi < 0) phi += kTurn;
            const int row = std::min(int(std::asinh(theta / width) / scale * 16), 15), column = std::min(int(phi / kTurn * 16), 15);
            ++found[std::size_t(row * 16 + column)];
          }
          double upper = 0;
          for (const double e : expected) upper += e;
          expected[256] = std::max(1 - upper, 0.0), found[256] = below;
          // Both sides of the integral: the whole sphere and what is drawn toward nothing.
          lobeShare = facets && away > 0 ? (1 - whole) / away : 0;
          if (!facets) CHECK(whole == Approx(1).margin(2e-3));
          else if (away > 0.01) {
            CHECK(lobeShare > 0.1 - 0.02);
            CHECK(lobeShare < 0.95 + 0.02);
          } else {
            CHECK(whole == Approx(1).margin(0.012));
          }
          double chi = 0, restExpected = 0, restFound = 0;
          int cells = 0;
          for (std::size_t i = 0; i < 257; ++i) {
            const double e = expected[i] * kSamples;
            if (e < 20) {
              restExpected += e, restFound += found[i];
              continue;
            }
            chi += (found[i] - e) * (found[i] - e) / e, ++cells;
          }
          if (restExpected > 5) chi += (restFound - restExpected) * (restFound - restExpected) / restExpected, ++cells;
          // The grid's own error in narrow cells is a few thousandths of what they hold.
          CHECK(chi < (cells - 1) + 5 * std::sqrt(2.0 * cells) + 0.02 * cells);
        }
}

TEST_CASE("light: normals that disagree with the triangle keep the albedo and let nothing through the back") {
  for (const double r : {0.1, 0.6})
    for (const double tilt : {0.2, 0.7, 1.2}) {
      Case c{.rungs = defaultRungs(GEOMETRY_SMITH), .substance = 1, .roughness = r, .albedo = dvec3(1)};
      c.rungs.distribution = DISTRIBUTION_GGX;
      SurfacePoint p = pointOf(c);
      const vec3 eye = glm::normalize(vec3(0.7f, 0.2f, 0.4f));
      p.normal = {float(-std::sin(tilt)), 0, float(std::cos(tilt))};
      const LobeTable table(c.rungs);
      const Bsdf bsdf(p, eye, c.rungs, table);
      reference::OracleSurface s;
      s.n = dvec3(bsdf.surface().n), s.v = dvec3(eye), s.albedo = c.albedo, s.substance = 1, s.alpha = r * r;
      const double exact = reference::directionalAlbedo(s, c.rungs).specular.x;
      Dice dice(77);
      Mean mean;
      for (int i = 0; i < 40000; ++i) {
        vec3 l;
        const float pick = dice.next();
        const bool good = bsdf.sample(pick, dice.next2(), l);
        const auto reflected = good ? bsdf.reflected(l) : pathtrace::Reflected{};
        if (good) REQUIRE(l.z > 0);
        mean.add(reflected.density > 0 ? double(reflected.value.x / reflected.density) : 0);
      }
      CAPTURE(r, tilt, mean.value(), exact, mean.error());
      CHECK(std::abs(mean.value() - exact) < 4 * mean.error() + 1e-3);
      CHECK(bsdf.reflected({0.6f, 0, -0.8f}).value == vec3(0));
    }
}

TEST_CASE("light: nothing that comes in makes a number that is none") {
  Dice dice(5);
  const auto bad = [](float x) { return !std::isfinite(x) || x < 0; };
  std::vector<shading::Rungs> all = specularRungs();
  int checked = 0;
  for (shading::Rungs k : all)
    for (const double alpha : {4e-4, 0.01, 1.0})
      for (const double substance : {0.0, 1.0 / 3, 1.0})
        for (const float albedo : {0.0f, 1.0f})
          for (const double nov : {0.0, 1e-5, 1e-3, 0.5, 1.0}) {
            k.diffuse = ++checked % 7, k.compensation = checked % 2, k.fresnel = checked % 5;
            const LobeTable table(k);
            const vec3 v = eyeAt(nov);
            const Bsdf bsdf(surfaceFor(vec3(albedo), substance, alpha), v, k, table);
            CAPTURE(nameOf(k), alpha, substance, albedo, nov);
            const auto look = [&](const vec3& l) {
              const auto r = bsdf.reflected(l);
              if (bad(r.density) || bad(r.value.x) || bad(r.value.y) || bad(r.value.z) || bad(bsdf.guess(l))) FAIL("not finite or negative");
            };
            for (const vec3& l : {-v, v, vec3(0, 0, 1), vec3(1, 0, 0), vec3(-v.x, 0, v.z), vec3(-1, 0, 1e-7f), glm::normalize(vec3(0.3f, 1, 1e-4f))}) look(l);
            for (int i = 0; i < 8; ++i) {
              vec3 l;
              const float pick = dice.next();
              // The ends of the unit interval too.
              const glm::vec2 u = i == 0 ? glm::vec2(0) : i == 1 ? glm::vec2(0.99999994f) : dice.next2();
              if (!bsdf.sample(pick, u, l)) continue;
              look(l);
              CHECK(std::abs(glm::length(l) - 1) < 1e-5f);
            }
            pathtrace::Sampler sampler(3, std::uint32_t(checked), 0);
            const vec3 h = bsdf.facet(sampler);
            CHECK(std::isfinite(h.x + h.y + h.z));
          }
  CHECK(checked > 2000);
}
