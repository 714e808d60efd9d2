// White furnaces: specular and diffuse rungs together over substance, roughness and angle (H13 of the hard cases).
#include <catch2/catch.hpp>

#include "energy_grid.h"
#include "sphere.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec2;
using glm::dvec3;
using reference::LobeEnergy;
namespace f64 = burnish::shading::f64;

namespace {

f64::Surface surfaceAt(double nov, double substance, double alpha, const LobeEnergy* energy = nullptr) {
  reference::OracleSurface s;
  s.v = viewAt(nov), s.albedo = dvec3(1), s.substance = substance, s.alpha = alpha;
  return reference::surfaceOf(s, energy);
}

/// Diffuse part of the directional albedo.
double diffuseAlbedo(const f64::Surface& m, const shading::Rungs& k, const LobeEnergy* energy) {
  return reference::integrateCosine<double>(
      [&](const dvec3& l) {
        return f64::diffuseRung(m, f64::anglesOf(m, l), energy ? energy->at(l.z) : dvec2(0), k).x * l.z;
      },
      {48, 24});
}

/// Of multiple scattering with F0 = 1 by the compensation lobe.
double scattered(const f64::Surface& m, const LobeEnergy& energy) {
  return reference::integrateCosine<double>(
      [&](const dvec3& l) { return f64::multipleScatteringLobe(m.dfg, energy.at(l.z), m.dfgMean) * l.z; }, {48, 1});
}

}  // namespace

TEST_CASE("energy: diffuse models alone, white") {
  Worst qualitative, full, loss{9};
  for (const double r : {0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0})
    for (const double nov : kCosines) {
      const double sigma = f64::sigmaFromAlpha(r * r);
      const dvec3 v = viewAt(nov);
      const auto albedo = [&](const auto& f) {
        return reference::integrateCosine<double>([&](const dvec3& l) { return f(l.z, v.z, dot(l, v)) * l.z; },
                                                  {64, 64});
      };
      const auto energy = [&](double rho) {
        return albedo([&](double l, double e, double lov) { return f64::Fd_orenNayarEnergy(l, e, lov, sigma, rho); });
      };
      qualitative.note(
          albedo([&](double l, double e, double lov) { return f64::Fd_orenNayarQualitative(l, e, lov, sigma); }), r,
          nov);
      full.note(albedo([&](double l, double e, double lov) { return f64::Fd_orenNayar(l, e, lov, sigma, 1); }), r, nov);
      const double white = energy(1);
      CAPTURE(r, nov);
      CHECK(white == Approx(1).epsilon(2e-3));
      CHECK(energy(0.5) <= 0.5 * 1.001);
      loss.value = std::min(loss.value, white);
      CHECK(albedo([](double, double, double) { return f64::Fd_lambert(); }) == Approx(1).epsilon(1e-9));
    }
  // Both of the paper's forms give back more than they get toward grazing.
  CHECK(qualitative.value > 1.01);
  CHECK(qualitative.value < 1.013);
  CHECK(full.value > 1.04);
  CHECK(full.value < 1.05);
  WARN("Oren-Nayar alone: qualitative at most " << qualitative << ", full " << full << ", energy-preserving at least "
                                                << loss.value);
}

TEST_CASE("energy: diffuse rungs without a table on top of specular ones that keep the bound") {
  // Largest sum over all those lobes: none of them holds 1.
  const std::map<int, Excess> stated{
      {DIFFUSE_LAMBERT, {1.95, 1.97}},                 // whatever specular takes
      {DIFFUSE_LAMBERT_FRESNEL, {1.89, 1.92}},         // 1 - F(l·h) leaves diffuse to a grazing eye
      {DIFFUSE_COUPLED_FIT, {1.004, 1.01}},            // fitted to the default lobe; others reflect a little more
      {DIFFUSE_OREN_NAYAR_QUALITATIVE, {1.89, 1.92}},  // as Lambert's
      {DIFFUSE_OREN_NAYAR, {1.89, 1.92}}};
  for (const auto& [diffuse, excess] : stated) {
    Worst worst, usual;
    shading::Rungs k = defaultRungs();
    k.diffuse = diffuse;
    const bool rough = diffuse == DIFFUSE_COUPLED_FIT || diffuse == DIFFUSE_OREN_NAYAR_QUALITATIVE || diffuse == DIFFUSE_OREN_NAYAR;
    for (const double nov : kCosines)
      for (const double s : kSubstances) {
        double part = diffuseAlbedo(surfaceAt(nov, s, 0.1), k, nullptr);
        for (const double r : kRoughness) {
          const f64::Surface m = surfaceAt(nov, s, r * r);
          if (rough) part = diffuseAlbedo(m, k, nullptr);
          for (const shading::Rungs& lobe : specularRungs()) {
            if (!claims(lobe)) continue;
            static std::map<std::tuple<std::string, double, double>, dvec2> known;
            auto& e = known[{nameOf(lobe), nov, r}];
            if (e == dvec2(0)) e = reference::lobeAlbedo(lobe, nov, r * r);
            const double sum = m.f0.x * e.x + e.y + part;
            worst.note(sum, r, nov, s);
            if (nameOf(lobe) == nameOf(defaultRungs())) usual.note(sum, r, nov, s);
          }
        }
      }
    WARN("diffuse " << diffuse << ": the sum is at most " << worst << ", with the default lobe " << usual);
    CAPTURE(diffuse);
    CHECK(worst.value > excess.low);
    CHECK(worst.value < excess.high);
    if (diffuse == DIFFUSE_COUPLED_FIT) CHECK(usual.value < 1.0005);
  }
}

TEST_CASE("energy: coupled diffuse and compensation, over every specular rung") {
  Worst coupled, rough, metal;
  std::string metalName, lowName;
  double coupledLow = 9, roughLow = 9, metalLow = 9;
  const std::vector<double> roughness = kLong ? kRoughness : std::vector<double>{0.1, 0.35, 0.6, 1.0},
                            substances = kLong ? kSubstances : std::vector<double>{0, 1.0 / 3, 0.4, 0.5, 0.7};
  for (shading::Rungs k : specularRungs()) {
    if (!claims(k)) continue;
    for (const double r : roughness) {
      const LobeEnergy energy(k, r * r, 192);
      for (const double nov : {0.02, 0.1, 0.3, 0.6, 0.9, 1.0}) {
        const dvec2 e = reference::lobeAlbedo(k, nov, r * r);
        CAPTURE(nameOf(k), r, nov);
        // White metal: what the lobe loses comes back.
        const double lobe = scattered(surfaceAt(nov, 1, r * r, &energy), energy),
                     white = e.x + e.y + f64::scatteredShare(1, energy.mean(), FRESNEL_SCHLICK) * lobe;
        // A lobe that loses less than BURNISH_GUARD_LOSS in the mean gets less than that back: 3 % toward grazing.
        const bool held = 1 - energy.mean().x - energy.mean().y < 1e-4;
        CHECK(white == Approx(1).epsilon(held && nov < 0.05 ? 0.03 : 0.01));
        CHECK(white < 1.001);
        metal.note(white, r, nov);
        if (white < metalLow)
          metalLow = white, metalName = nameOf(k) + " r " + std::to_string(r) + " nov " + std::to_string(nov);
        for (int compensation : {COMPENSATION_NONE, COMPENSATION_MULTIPLE_SCATTERING})
          for (const double s : substances) {
            const f64::Surface m = surfaceAt(nov, s, r * r, &energy);
            k.compensation = compensation;
            const double specular =
                m.f0.x * e.x + e.y +
                (compensation ? f64::scatteredShare(m.f0.x, energy.mean(), FRESNEL_SCHLICK) * lobe : 0);
            k.diffuse = DIFFUSE_COUPLED;
            const double sum = specular + diffuseAlbedo(m, k, &energy);
            k.diffuse = DIFFUSE_OREN_NAYAR_ENERGY;
            const double sumRough = specular + diffuseAlbedo(m, k, &energy);
            CAPTURE(compensation, s);
            CHECK(sum < 1.001);
            coupled.note(sum, r, nov, s);
            // The rough lobe sends more back where it came from, which the coupling does not know of.
            CHECK(sumRough < 1.007);
            rough.note(sumRough, r, nov, s);
            if (s > 0.4) continue;  // between, metal's part loses unless compensated
            CHECK(sum == Approx(1).epsilon(0.01));
            if (sum < coupledLow)
              coupledLow = sum, lowName = nameOf(k) + " r " + std::to_string(r) + " nov " + std::to_string(nov);
            CHECK(sumRough > 0.99);
            roughLow = std::min(roughLow, sumRough);
          }
        k.compensation = COMPENSATION_NONE;
      }
    }
  }
  WARN("white metal, compensated: " << metalLow << " (" << metalName << ") to " << metal);
  WARN("white dielectrics, coupled: " << coupledLow << " (" << lowName << ") to " << coupled
                                      << "; with energy-preserving Oren-Nayar " << roughLow << " to " << rough);
}

TEST_CASE("energy: the oracle's directional albedo is the sum of its parts") {
  for (const auto& [k, s, r, nov] : {std::tuple{dvec3(DISTRIBUTION_GGX, GEOMETRY_SMITH, 0), 1.0 / 3, 0.5, 0.4},
                                     std::tuple{dvec3(DISTRIBUTION_BECKMANN, GEOMETRY_V_CAVITY, 1), 0.6, 0.8, 0.15},
                                     std::tuple{dvec3(DISTRIBUTION_BLINN_PHONG, GEOMETRY_KELEMEN, 1), 1.0, 0.3, 0.9}}) {
    shading::Rungs rungs = defaultRungs(int(k.y));
    rungs.distribution = int(k.x), rungs.compensation = int(k.z), rungs.diffuse = DIFFUSE_COUPLED;
    reference::OracleSurface surface;
    surface.v = viewAt(nov), surface.albedo = dvec3(1), surface.substance = s, surface.alpha = r * r;
    const reference::DirectionalAlbedo sum = reference::directionalAlbedo(surface, rungs);
    const LobeEnergy energy(rungs, r * r);
    const f64::Surface m = surfaceAt(nov, s, r * r, &energy);
    const dvec2 e = reference::lobeAlbedo(rungs, nov, r * r);
    const double specular =
        m.f0.x * e.x + e.y +
        (k.z > 0 ? f64::scatteredShare(m.f0.x, energy.mean(), FRESNEL_SCHLICK) * scattered(m, energy) : 0);
    CHECK(sum.specular.x == Approx(specular).margin(5e-4));
    CHECK(sum.diffuse.x == Approx(diffuseAlbedo(m, rungs, &energy)).margin(5e-4));
    // A surface turned in space is the same surface.
    const dvec3 n = normalize(dvec3(0.3, -0.5, 0.8)), t = normalize(cross(n, dvec3(0, 1, 0)));
    surface.n = n, surface.v = n * nov + t * std::sqrt(1 - nov * nov);
    CHECK(reference::directionalAlbedo(surface, rungs).specular.x == Approx(sum.specular.x).epsilon(1e-9));
  }
}

TEST_CASE("energy: coupled diffuse under the other Fresnel rungs") {
  // Tables hold Schlick's albedo, so what is left for diffuse is Schlick's too: what the exact equations add to that,
  // or take.
  struct Row {
    int fresnel;
    double low, high;
  };
  for (const Row& row : {Row{FRESNEL_NONE, 0.999, 1.001}, Row{FRESNEL_SPHERICAL_GAUSSIAN, 0.997, 1.003},
                         Row{FRESNEL_DIELECTRIC, 0.87, 1.025}}) {
    Worst worst;
    double low = 9, plastic = 9, plasticHigh = 0;
    for (const int geometry : {GEOMETRY_KELEMEN, GEOMETRY_SMITH}) {
      shading::Rungs k = defaultRungs(geometry);
      if (geometry == GEOMETRY_SMITH) k.distribution = DISTRIBUTION_GGX;
      k.fresnel = row.fresnel, k.diffuse = DIFFUSE_COUPLED;
      for (const double r : {0.1, 0.4, 0.7, 1.0}) {
        const LobeEnergy energy(k, r * r, 192);
        for (const double nov : {0.02, 0.1, 0.2, 0.4, 0.7, 1.0})
          for (const double s : {0.0, 0.2, 1.0 / 3, 0.4}) {
            const f64::Surface m = surfaceAt(nov, s, r * r, &energy);
            const double specular = reference::integrateHalf<double>(nov, r * r, [&](const dvec3& l) {
              const f64::Angles a = f64::anglesOf(m, l);
              return f64::fresnelRung(m.f0, m.eta, m.k, a.loh, k.fresnel).x * f64::specularRung(m, a, k);
            });
            const double sum = specular + diffuseAlbedo(m, k, &energy);
            worst.note(sum, r, nov, s);
            low = std::min(low, sum);
            if (s > 0.3) plastic = std::min(plastic, sum), plasticHigh = std::max(plasticHigh, sum);
          }
      }
    }
    WARN("coupled, fresnel " << row.fresnel << ": white dielectrics reflect " << low << " to " << worst
                             << "; F0 up to 0.04: " << plastic << " to " << plasticHigh);
    CHECK(low > row.low);
    CHECK(worst.value < row.high);
  }
}
