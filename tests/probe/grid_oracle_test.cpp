// The oracle against closed forms and itself.
#include <catch2/catch.hpp>
#include <cmath>

#include "grid_oracle.h"

using namespace burnish::test;
using glm::dvec3;

namespace {
constexpr double kPi = 3.14159265358979323846;
/// Share of the hemisphere of a small plane that a rectangle a x b takes, one metre away, parallel, its corner over the plane (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3).
double corner(double a, double b) {
  const double s = std::sqrt(1 + a * a), t = std::sqrt(1 + b * b);
  return (a / s * std::atan(b / s) + b / t * std::atan(a / t)) / (2 * kPi);
}
}  // namespace

TEST_CASE("oracle: light straight from the ceiling is the closed form") {
  const CubeOracle dark(0, 8);
  CHECK(dark.irradiance({0.5, 0, 0.5}, {0, 1, 0}) == Approx(4 * corner(0.5, 0.5)).epsilon(1e-10));
  CHECK(dark.irradiance({0, 0, 0}, {0, 1, 0}) == Approx(corner(1, 1)).epsilon(1e-10));
  CHECK(dark.irradiance({0.25, 0, 0.1}, {0, 1, 0}) == Approx(corner(0.25, 0.1) + corner(0.75, 0.1) + corner(0.25, 0.9) + corner(0.75, 0.9)).epsilon(1e-10));
  // A plane on its edge under the middle of the ceiling sees half of it; the other half is under its horizon.
  CHECK(dark.irradiance({0.5, 0.5, 0.5}, {1, 0, 0}) == Approx(dark.irradiance({0.5, 0.5, 0.5}, {-1, 0, 0})).epsilon(1e-12));
  CHECK(dark.irradiance({0.5, 0.5, 0.5}, {0, -1, 0}) == Approx(0).margin(1e-12));
}

TEST_CASE("oracle: a closed furnace shines with e/(1 - rho), everywhere and without bands") {
  for (const double albedo : {0.2, 0.5, 0.8, 0.9}) {
    const CubeOracle furnace(albedo, 8, 1, true);
    CHECK(furnace.radiance(2, {0.3, 0, 0.9}) == Approx(1 / (1 - albedo)).epsilon(1e-9));
    for (const dvec3& p : {dvec3(0.5), dvec3(0.02, 0.9, 0.3)}) {
      const auto sh = furnace.harmonics(p);
      CHECK(sh[0] == Approx(1 / (1 - albedo)).epsilon(1e-5));
      for (std::size_t k = 1; k < 9; ++k) CHECK(sh[k] == Approx(0).margin(1e-5 / (1 - albedo)));
    }
  }
}

TEST_CASE("oracle: converged, and no energy is lost") {
  for (const double albedo : {0.2, 0.5, 0.8}) {
    const CubeOracle coarse(albedo, 12), fine(albedo, 24);
    double worst = 0;
    for (int wall = 0; wall < 6; ++wall)
      for (const double u : {0.03, 0.2, 0.5})
        for (const double v : {0.03, 0.35}) {
          const double a = coarse.irradiance(wallPoint(wall, u, v), wallNormal(wall)), b = fine.irradiance(wallPoint(wall, u, v), wallNormal(wall));
          worst = std::fmax(worst, std::abs(a / b - 1));
        }
    // Errors of constant rectangles fall with the square of their size or, at kinks, a little slower: what is left is at most half the difference.
    INFO("albedo " << albedo << ": 12 against 24 rectangles along a side differ by " << worst);
    CHECK(worst < 0.006);
    CHECK(fine.residual() < 1e-12);
    // What the ceiling sends out is what the walls absorb: e = sum of (1 - rho) E, Gaussian points on each wall.
    constexpr double kNode[4] = {0.069431844202973713, 0.330009478207571868, 0.669990521792428132, 0.930568155797026287}, kWeight[4] = {0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929};
    double absorbed = 0;
    for (int wall = 0; wall < 6; ++wall)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) absorbed += (1 - albedo) * kWeight[i] * kWeight[j] * fine.irradiance(wallPoint(wall, kNode[i], kNode[j]), wallNormal(wall));
    CHECK(absorbed == Approx(1).epsilon(5e-3));
  }
}

TEST_CASE("oracle: harmonics are those of the light") {
  // Bands up to 2 hold the irradiance but for what bands above 3 add (band 3 has none): within 1 % of the mean light over all directions, in the middle of the cube; and their mean is exact.
  const CubeOracle oracle(0.5, 16);
  const dvec3 p(0.5);
  const auto sh = oracle.harmonics(p);
  double mean = 0;
  int count = 0;
  for (int i = 0; i < 400; ++i) {
    const double z = (i + 0.5) / 200 - 1, phi = i * 2.399963229728653, s = std::sqrt(1 - z * z);
    const dvec3 n(s * std::cos(phi), s * std::sin(phi), z);
    const double exact = oracle.irradiance(p, n);
    const double found = sh[0] + sh[1] * n.y + sh[2] * n.z + sh[3] * n.x + sh[4] * n.x * n.y + sh[5] * n.y * n.z + sh[6] * (3 * n.z * n.z - 1) + sh[7] * n.x * n.z + sh[8] * (n.x * n.x - n.y * n.y);
    CHECK(found == Approx(exact).margin(0.015 * sh[0]));
    mean += exact, ++count;
  }
  CHECK(mean / count == Approx(sh[0]).epsilon(2e-3));
}
