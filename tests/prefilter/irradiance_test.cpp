// Diffuse light: exact projections, and what de-ringing keeps (H10).
#include <catch2/catch.hpp>

#include "oracle.h"
#include "prefilter/irradiance.h"
#include "reference/shading.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;

namespace {

double leastOf(const prefilter::IrradianceSh& sh) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double least = 1e300;
  for (int i = 0; i < 20000; ++i) {
    const dvec3 e = prefilter::irradianceAt(sh, glm::normalize(dvec3(normal(random), normal(random), normal(random))));
    least = std::min({least, e.x, e.y, e.z});
  }
  return least;
}

}  // namespace

TEST_CASE("irradiance of the first nine harmonics is exact") {
  // f = 2 + y + z x: the cosine lobe scales bands by 1, 2/3 and 1/4.
  const auto f = [](const dvec3& d) { return dvec3(2 + d.y + d.z * d.x, d.x, 1 + d.y * d.y); };
  Image image = makeImage(512, 256, 3, PixelType::F32);
  const Points at = pointsOf(image);
  for (std::size_t i = 0; i < at.direction.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) image.f32()[3 * i + c] = float(f(at.direction[i])[int(c)] + 1);
  const prefilter::IrradianceSh sky = prefilter::irradianceOf(image), cube = prefilter::irradianceOf(cubeOf(128, [&](const dvec3& d) { return f(d) + 1.0; }), 2);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const dvec3 n = glm::normalize(dvec3(normal(random), normal(random), normal(random)));
    const dvec3 truth(3 + n.y * 2 / 3 + n.z * n.x / 4, 1 + n.x * 2 / 3, 2 + 1 / 3.0 + (n.y * n.y - 1 / 3.0) / 4);
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(prefilter::irradianceAt(cube, n)[c] - truth[c]));
      worst = std::max(worst, std::abs(prefilter::irradianceAt(sky, n)[c] - truth[c]));
    }
    // The shader's text reads the same coefficients.
    const dvec3 text = shading::f64::irradianceSh(n, cube[0], cube[1], cube[2], cube[3], cube[4], cube[5], cube[6], cube[7], cube[8], AMBIENT_SH_L2);
    REQUIRE(glm::length(text - prefilter::irradianceAt(cube, n)) < 1e-12);
  }
  WARN("first nine harmonics: off by at most " << worst);
  CHECK(worst < 2e-4);  // texel centres of a 128² cube and a 512 × 256 picture
}

TEST_CASE("one bright direction: two bands ring below zero, windowed ones do not (H10)") {
  const dvec3 sun = glm::normalize(dvec3(0.4, 0.8, -0.3));
  const double edge = std::cos(0.05);
  const CubeLevel source = cubeOf(64, [&](const dvec3& d) { return dvec3(glm::dot(d, sun) > edge ? 100 : 0, glm::dot(d, sun) > edge ? 50 : 0.001, 1); });
  prefilter::IrradianceSh sh = prefilter::irradianceOf(source);
  const double peak = prefilter::irradianceAt(sh, sun).x, before = leastOf(sh);
  CHECK(before < -0.02 * peak);  // of 1 + 2 + 5/4 shares at the peak, on the far side 1 - 2 + 5/4 and less on the way there
  const dvec3 mean = sh[0];
  const double lambda = prefilter::deRing(sh);
  CHECK(lambda > 0);
  CHECK(leastOf(sh) >= 0);
  CHECK(sh[0] == mean);  // the mean over the sphere is kept
  // The hemisphere that faces the sun: what it took.
  const double after = prefilter::irradianceAt(sh, sun).x;
  WARN("one bright direction: least " << before / peak << " of the peak before, " << leastOf(sh) / peak << " after; the peak falls to " << after / peak << ", lambda " << lambda);
  CHECK(after < peak);
  CHECK(after > 0.4 * peak);
  prefilter::IrradianceSh soft = prefilter::irradianceOf(cubeOf(16, [](const dvec3& d) { return dvec3(1 + 0.3 * d.y); }));
  const prefilter::IrradianceSh same = soft;
  CHECK(prefilter::deRing(soft) == 0);
  CHECK(soft == same);
}

TEST_CASE("irradiance as a cube is the cosine lobe's integral") {
  std::mt19937 random(3);
  const CubeLevel source = cubeOf(48, [&](const dvec3& d) { return dvec3(random() % 5, d.y > 0 ? 3 : 0.1, 1); });
  CubeLevel cube = prefilter::irradianceCube(*prefilter::makeSource(source, 1), 8);
  REQUIRE(cube.size == 8);
  const LevelError e = errorOf(cube, pointsOf(source), ReflectionLobe::BlinnPhong, 100, {0, 1, 0});
  CHECK(e.rms < 1e-4);
  // Power 0 is the cosine: straight up under an upper half of 3 over 0.1.
  CHECK(weightOf(ReflectionLobe::BlinnPhong, 1, 0.4) == Approx(0.6));
  double top = 0;
  for (int k = 0; k < 4; ++k) top = std::max(top, double(cube.texels[3 * (2 * 64 + std::size_t(3 + k / 2) * 8 + std::size_t(3 + k % 2)) + 1]));
  CHECK(top > 2.9);
}
