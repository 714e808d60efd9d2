// A unit cube with an emissive ceiling: light on its walls by lattice and by one probe in the middle, through the shading text in double, against the oracle. The light of points and probe comes from the
// oracle too: what errs is the rung.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "grid_oracle.h"
#include "grid_sampler.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
namespace f64 = shading::f64;

namespace {

struct Off {
  double mean = 0, worst = 0;  ///< relative to the oracle at each place
};
constexpr int kFloor = 2, kCeiling = 3, kSide = 0;  // the other sides are alike
constexpr int kSteps = 16;

class Cube {
 public:
  explicit Cube(double albedo) : oracle(albedo, 24) {
    for (const int wall : {kSide, kFloor, kCeiling})
      for (int i = 0; i < kSteps * kSteps; ++i) truth_[wall].push_back(oracle.irradiance(at(wall, i), wallNormal(wall)));
  }
  static dvec3 at(int wall, int i) { return wallPoint(wall, (i / kSteps + 0.5) / kSteps, (i % kSteps + 0.5) / kSteps); }  // NOLINT(bugprone-integer-division)
  template <class F>
  [[nodiscard]] Off on(int wall, F&& light) const {
    Off e;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double off = std::abs(light(at(wall, i), wallNormal(wall)) / truth_[wall][std::size_t(i)] - 1);
      e.mean += off / (kSteps * kSteps);
      e.worst = std::fmax(e.worst, off);
    }
    return e;
  }
  [[nodiscard]] double mean(int wall) const {
    double sum = 0;
    for (const double t : truth_[wall]) sum += t / (kSteps * kSteps);
    return sum;
  }
  [[nodiscard]] std::array<dvec3, 9> harmonics(const dvec3& p) const {
    const auto sh = oracle.harmonics(p);
    std::array<dvec3, 9> out;
    for (std::size_t k = 0; k < 9; ++k) out[k] = dvec3(sh[k]);
    return out;
  }
  CubeOracle oracle;

 private:
  std::vector<double> truth_[6];
};

double byRung(const std::array<dvec3, 9>& c, const dvec3& n, int rung) { return std::fmax(f64::irradianceSh(n, c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], rung).x, 0.0); }

/// Where a ray from p along d leaves the unit cube, as seen from its middle.
dvec3 fromMiddle(const dvec3& p, const dvec3& d) {
  double t = 1e300;
  for (int a = 0; a < 3; ++a)
    if (d[a] != 0) t = std::fmin(t, std::fmax(((d[a] > 0 ? 1 : 0) - p[a]) / d[a], 0.0));
  return glm::normalize(p + d * t - 0.5);
}

/// The box-projected variation of one probe in the middle.
double boxProjected(const std::array<dvec3, 9>& c, const dvec3& p, const dvec3& n) {
  dvec3 sum(0);
  for (int i = 0; i < AMBIENT_BOX_TAPS; ++i) {
    const dvec3 d = f64::ambientTap(i);
    sum += f64::irradianceBands(fromMiddle(p, d), c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8]) * f64::ambientTapWeight(dot(n, d));
  }
  return std::fmax(sum.x, 0.0);
}

std::string row(double albedo, const char* name, const Off& f, const Off& c, const Off& s) {
  char text[200];
  std::snprintf(text, sizeof text, "| %.1f | %s | %.1f, %.1f | %.1f, %.1f | %.1f, %.1f |\n", albedo, name, 100 * f.mean, 100 * f.worst, 100 * c.mean, 100 * c.worst, 100 * s.mean, 100 * s.worst);
  return text;
}

}  // namespace

TEST_CASE("a cube with an emissive ceiling: each rung and source against radiosity", "[box]") {
  std::string table = "\n| albedo | ambient | floor: mean, worst % | ceiling | sides |\n|---|---|---|---|---|\n", center = "\n| albedo | rung | up | down | aside |\n|---|---|---|---|---|\n";
  static constexpr const char* kName[] = {"", "constant", "sh-l1", "sh-l2"};
  double floorByProbe[3];
  int which = 0;
  for (const double albedo : {0.2, 0.5, 0.8}) {
    const Cube cube(albedo);
    const auto middle = cube.harmonics(dvec3(0.5));
    const auto add = [&](const std::string& name, auto&& light) {
      const Off f = cube.on(kFloor, light), c = cube.on(kCeiling, light), s = cube.on(kSide, light);
      table += row(albedo, name.c_str(), f, c, s);
      return std::array<Off, 3>{f, c, s};
    };
    std::array<Off, 3> plain;
    for (int rung = AMBIENT_CONSTANT; rung <= AMBIENT_SH_L2; ++rung) plain = add(std::string("one probe, ") + kName[rung], [&](const dvec3&, const dvec3& n) { return byRung(middle, n, rung); });
    const auto box = add("one probe, box", [&](const dvec3& p, const dvec3& n) { return boxProjected(middle, p, n); });
    // The walls know that they are nearer to one light and farther from another than the middle is.
    CHECK(box[0].mean < 0.5 * plain[0].mean);
    CHECK(box[2].mean < 0.5 * plain[2].mean);

    AmbientGrid grid = gridIn(dvec3(0), dvec3(1), glm::ivec3(5), 0.01);
    fillGrid(grid, roomOf(dvec3(0), dvec3(1), 0.1), [&](const dvec3& p) { return cube.harmonics(p); });
    std::array<Off, 3> best;
    for (int rung = AMBIENT_CONSTANT; rung <= AMBIENT_SH_L2; ++rung) {
      const GridSampler sampler(grid, rung);
      best = add(std::string("lattice of 5 x 5 x 5, ") + kName[rung], [&](const dvec3& p, const dvec3& n) {
        const GridLight l = sampler.at(p, n);
        CHECK(l.share > 0.99);
        return l.light.x;
      });
    }
    CAPTURE(albedo);
    for (const Off& e : best) {
      CHECK(e.mean < 0.05);
      CHECK(e.worst < 0.15);
    }

    // Where points stand counts: 5 cm from the walls, and a lattice of the same spacing that knows nothing of the room (points in its walls are not valid), with the
    // probe in the middle where it says nothing.
    const auto other = [&](const std::string& name, AmbientGrid elsewhere) {
      fillGrid(elsewhere, roomOf(dvec3(0), dvec3(1), 0.5), [&](const dvec3& p) { return cube.harmonics(p); });
      const GridSampler sampler(elsewhere);
      return add(name, [&](const dvec3& p, const dvec3& n) {
        const GridLight l = sampler.at(p, n);
        return l.light.x * l.share + byRung(middle, n, AMBIENT_SH_L2) * (1 - l.share);
      });
    };
    const auto far = other("points 5 cm from the walls, sh-l2", gridIn(dvec3(0), dvec3(1), glm::ivec3(5), 0.05));
    AmbientGrid loose = gridIn(dvec3(0), dvec3(1), glm::ivec3(6), 0.01);
    loose.spacing = dvec3(0.245);
    loose.origin = dvec3(-0.08, -0.13, -0.17);
    other("not aligned, sh-l2", loose);
    CHECK(far[1].mean > best[1].mean);

    // At the probe itself: what three bands make of the light there.
    for (int rung = AMBIENT_CONSTANT; rung <= AMBIENT_SH_L2; ++rung) {
      char text[120];
      double off[3];
      for (int k = 0; k < 3; ++k) {
        const dvec3 n = k == 0 ? dvec3(0, 1, 0) : k == 1 ? dvec3(0, -1, 0) : dvec3(1, 0, 0);
        off[k] = byRung(middle, n, rung) / cube.oracle.irradiance(dvec3(0.5), n) - 1;
        if (rung == AMBIENT_SH_L2) CHECK(std::abs(off[k]) < 0.12);
      }
      std::snprintf(text, sizeof text, "| %.1f | %s | %.1f | %.1f | %.1f |\n", albedo, kName[rung], 100 * off[0], 100 * off[1], 100 * off[2]);
      center += text;
    }
    floorByProbe[which++] = 1 - cube.mean(kFloor) / byRung(middle, {0, 1, 0}, AMBIENT_SH_L2);
  }
  WARN(table << "\nAt the probe, %:" << center << "\nThe floor has " << 100 * floorByProbe[0] << ", " << 100 * floorByProbe[1] << " and " << 100 * floorByProbe[2] << " % less light than one probe says");
  // Known of one probe without projection: 25 to 61 % on the floor's side.
  for (const double less : floorByProbe) {
    CHECK(less > 0.25);
    CHECK(less < 0.62);
  }
}
