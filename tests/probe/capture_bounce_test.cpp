// Bounces without a picture: what a point gives, where it goes in the set, when light grows and when it is enough.
#include <random>

#include "prefilter/irradiance.h"
#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;
using probe::Change;

namespace {

/// Gives a function of the direction, and says that so many values were mended.
class Painted final : public probe::Capture {
 public:
  void setProbes(ProbeSet) override {}
  Result<CubeLevel> radiance(glm::dvec3 point, int size) override {
    CubeLevel level{size, 0, {}};
    for (int f = 0; f < 6; ++f)
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const dvec3 d = prefilter::texelDirection(size, f, x, y);
          for (int c = 0; c < 3; ++c) level.texels.push_back(float(point.x + 1 + d[c]));
        }
    mended_ = point.x == 3 ? 5 : 0;
    return level;
  }
};

ProbeSet places() {
  ProbeSet set;
  set.reflections.resize(2);
  set.reflections[0].name = "hall";
  set.reflections[1].capture = {3, 0, 0};
  AmbientGrid& grid = set.grid.emplace();
  grid.counts = {2, 2, 1};
  grid.origin = {10, 0, 0};
  grid.points.resize(4);
  for (const std::size_t i : {1u, 3u}) grid.points[i].valid = true;
  return set;
}

/// The bounces that a row of absolute changes makes.
std::vector<BounceReport> judged(const std::vector<double>& added, std::string* error = nullptr) {
  std::vector<BounceReport> bounces;
  double light = 0;
  for (const double a : added) {
    light += a;
    auto b = probe::judge(bounces, {light > 0 ? a / light : 0, light});
    if (!b) {
      if (error) *error = b.error().message();
      return bounces;
    }
    bounces.push_back(*b);
  }
  return bounces;
}

}  // namespace

TEST_CASE("bounce: points are the probes, then what is valid of the grid") {
  const ProbeSet set = places();
  REQUIRE(probe::captureCount(set) == 4);
  Painted painted;
  BakeOptions options;
  options.size = 32;
  probe::PointTime time;
  std::vector<probe::PointLight> lights;
  for (int i = 0; i < 4; ++i) {
    auto light = probe::capturePoint(painted, set, i, options, time);
    REQUIRE(light);
    lights.push_back(std::move(*light));
  }
  CHECK(!probe::capturePoint(painted, set, 4, options, time));
  CHECK(time.filterMs > 0);
  REQUIRE(lights[0].radiance.levels.size() == 3);
  CHECK(lights[0].radiance.levels[0].size == 32);
  CHECK(lights[0].radiance.levels[2].size == 8);
  CHECK(lights[0].radiance.lobe == ReflectionLobe::BlinnPhong);
  CHECK(lights[2].radiance.levels.empty());
  // 1 + x from everywhere: irradiance/π is 1 + 2/3 x (Ramamoorthi and Hanrahan 2001); texels are points, which faces of 16² know within 1e-3.
  const ProbeSet lit = probe::withLight(set, lights);
  CHECK(lit.revision != set.revision);
  CHECK(lit.reflections[1].irradiance[0][0] == Approx(4).epsilon(1e-3));
  CHECK(lit.grid->points[1].irradiance[0].x == Approx(12).epsilon(1e-3));  // at x = 11
  CHECK(lit.grid->points[3].irradiance[3].x == Approx(2 / 3.0).epsilon(2e-3));
  CHECK(lit.grid->points[0].irradiance[0] == vec3(0));
  REQUIRE(painted.report().warnings().size() == 1);
  CHECK(painted.report().warnings()[0].message().find("reflection probe 1: 5 of") == 0);
  // Black: as many levels, of as much roughness, so that it takes the sky's place.
  const ProbeSet black = probe::blackLight(set, options);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(black.reflections[0].radiance.levels[k].size == lights[0].radiance.levels[k].size);
    CHECK(black.reflections[0].radiance.levels[k].roughness == lights[0].radiance.levels[k].roughness);
    for (const float v : black.reflections[0].radiance.levels[k].texels) REQUIRE(v == 0);
  }
}

TEST_CASE("bounce: values that are no light count as none") {
  Image picture = makeImage(6, 4, 4, PixelType::F32);
  for (std::size_t i = 0; i < picture.pixelCount() * 4; ++i) picture.f32()[i] = float(i);
  picture.f32()[0] = NAN;
  picture.f32()[5] = -1;
  picture.f32()[10] = INFINITY;
  picture.f32()[3] = NAN;  // alpha is none
  std::size_t mended = 0;
  const CubeLevel cube = probe::facesOf(picture, 2, mended);
  CHECK(mended == 3);
  for (const float v : cube.texels) CHECK((v >= 0 && std::isfinite(v)));
  // The picture's last row is face +X's first; its first column of the second row of faces is -Y's.
  CHECK(texel(cube, 0, 0, 0) == dvec3(72, 73, 74));
  CHECK(texel(cube, 3, 0, 1) == dvec3(0, 1, 2));
}

TEST_CASE("bounce: changes are rms over points and directions") {
  // Against a sum over many directions.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<IrradianceSh> before(3), now(3);
  for (auto* set : {&before, &now})
    for (IrradianceSh& sh : *set)
      for (auto& c : sh)
        for (double& v : c) v = normal(random);
  double apart = 0, all = 0;
  for (std::size_t p = 0; p < 3; ++p) {
    prefilter::IrradianceSh a{}, b{};
    for (std::size_t i = 0; i < 9; ++i)
      for (int c = 0; c < 3; ++c) a[i][c] = before[p][i][std::size_t(c)], b[i][c] = now[p][i][std::size_t(c)];
    CubeLevel directions{64, 0, std::vector<float>(18 * 64 * 64)};
    eachTexel(directions, [&](int, int x, int y, const dvec3& d, const dvec3&) {
      const dvec3 l = prefilter::irradianceAt(b, d), m = l - prefilter::irradianceAt(a, d);
      const double w = prefilter::texelSolidAngle(64, x, y);
      apart += w * glm::dot(m, m);
      all += w * glm::dot(l, l);
    });
  }
  const Change change = probe::changeOf(before, now);
  CHECK(change.share == Approx(std::sqrt(apart / all)).epsilon(1e-3));
  CHECK(change.light == Approx(std::sqrt(all / (4 * kPi * 9))).epsilon(1e-3));
  CHECK(probe::changeOf({}, now).share == 1);
  CHECK(probe::changeOf(before, std::vector<IrradianceSh>(3)).share == 0);
}

TEST_CASE("bounce: the rest of a geometric series is exact") {
  for (const double q : {0.1, 0.5, 0.9, 0.97}) {
    std::vector<double> added;
    for (int k = 0; k < 400; ++k) added.push_back(std::pow(q, k));
    const std::vector<BounceReport> bounces = judged(added);
    REQUIRE(bounces.size() == 400);
    CHECK(std::isinf(bounces[0].rest));
    for (std::size_t k = 1; k < 40; ++k) {
      const double have = (1 - std::pow(q, double(k + 1))) / (1 - q), missing = 1 / (1 - q) - have;
      CHECK(bounces[k].ratio == Approx(q));
      CHECK(bounces[k].rest == Approx(missing / have).margin(1e-12));
    }
    BakeOptions options;
    options.maxBounces = 1000;
    std::size_t n = 0;
    while (probe::wantsMore({bounces.data(), n}, options)) ++n;
    CHECK(n >= std::size_t(probe::kLeastBounces));
    CHECK(bounces[n - 1].rest <= 0.01);
    if (n > std::size_t(probe::kLeastBounces)) CHECK(bounces[n - 2].rest > 0.01);
    options.bounces = 7;
    CHECK(probe::wantsMore({bounces.data(), 6}, options));
    CHECK(!probe::wantsMore({bounces.data(), 7}, options));
    options.bounces = 0;
    options.maxBounces = 2;
    CHECK(!probe::wantsMore({bounces.data(), 2}, options));
  }
}

TEST_CASE("bounce: growth is an error, and light that comes late is none") {
  std::string error;
  std::vector<double> growing;
  for (int k = 0; k < 20; ++k) growing.push_back(std::pow(1.02, k));
  CHECK(judged(growing, &error).size() == 3);
  CHECK(error.find("bounce 4") == 0);
  // A dark room behind two corners: hardly anything until the third bounce, where it is lit; then it fades.
  error.clear();
  const std::vector<BounceReport> late = judged({1e-4, 0.3, 1, 0.5, 0.25, 0.12, 0.06, 0.03, 0.015, 0.0075, 0.004}, &error);
  CHECK(error.empty());
  CHECK(late[1].ratio > 1);
  CHECK(std::isinf(late[1].rest));
  CHECK(std::isinf(late[2].rest));
  CHECK(late.back().rest < 0.01);
  // And one that would seem settled after two.
  const std::vector<BounceReport> pause = judged({1, 1e-3, 0.5, 0.2});
  BakeOptions options;
  CHECK(pause[1].rest < options.until);
  CHECK(probe::wantsMore({pause.data(), 2}, options));
  CHECK(probe::wantsMore({pause.data(), 3}, options));
  // No light at all: one bounce tells.
  const std::vector<BounceReport> none = judged({0});
  CHECK(none[0].rest == 0);
  CHECK(!probe::wantsMore(none, options));
}
