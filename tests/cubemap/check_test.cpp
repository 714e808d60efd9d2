// The judge of the filter, judged: closed forms that it must agree with, and errors that it must find.
#include "cube_fixture.h"

using namespace cube_test;

namespace {

/// Light that is 1 + 0.5 d·a: a zonal lobe leaves its mean and scales its slope by the lobe's mean cosine.
double light(const Vec& d) { return 1 + 0.5 * (0.36 * d[0] + 0.48 * d[1] - 0.8 * d[2]); }

/// ∫ c w / ∫ w over the sphere, w of docs/shading.md, section 5; Simpson over t = sqrt(1 - c), which spreads narrow lobes.
double meanCosine(ReflectionLobe lobe, double roughness) {
  const double a2 = std::pow(roughness, 4), halfPower = 1 / a2 - 1;
  double first = 0, second = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = double(i) / kSteps, c = 1 - t * t, d = (1 - c) / 2 + (1 + c) / 2 * a2;
    const double w = lobe == ReflectionLobe::Ggx ? c / (d * d) : c * std::pow((1 + c) / 2, halfPower);
    const double weight = (i == 0 || i == kSteps ? 1 : i % 2 ? 4 : 2) * w * 2 * t;
    first += weight;
    second += weight * c;
  }
  return second / first;
}

CubeLevel lit(int size, double slope) {
  CubeLevel level;
  level.size = size;
  for (std::size_t face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) level.texels.insert(level.texels.end(), 3, static_cast<float>(1 + slope * (light(faceDirection(face, centre(x, size), centre(y, size))) - 1)));
  return level;
}

Image litLatLong(int height) {
  Image image = makeImage(2 * height, height, 3, PixelType::F32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < image.width; ++x) {
      // The centre column looks along -Z, +X is to its right, the first row is the zenith.
      const double theta = (y + 0.5) / height * M_PI, a = ((x + 0.5) / image.width - 0.5) * 2 * M_PI;
      const double v = light({std::sin(theta) * std::sin(a), std::cos(theta), -std::sin(theta) * std::cos(a)});
      for (std::size_t c = 0; c < 3; ++c) image.f32()[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3 + c] = static_cast<float>(v);
    }
  return image;
}

Cubemap filteredByHand(ReflectionLobe lobe, std::initializer_list<double> roughness) {
  Cubemap cube;
  cube.lobe = lobe;
  int size = 16;
  for (const double r : roughness) {
    cube.levels.push_back(lit(size, r == 0 ? 1 : meanCosine(lobe, r)));
    cube.levels.back().roughness = r;
    size /= 2;
  }
  return cube;
}

}  // namespace

TEST_CASE("The check agrees with the closed form of a slope under both lobes", "[cubemap][check]") {
  const ReflectionLobe lobe = GENERATE(ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx);
  CHECK(meanCosine(lobe, 1) == Approx(2.0 / 3).epsilon(1e-9));  // at roughness 1 both are the cosine
  const Cubemap cube = filteredByHand(lobe, {0, 0.3, 0.5, 0.8, 1});
  PrefilterCheckOptions how;
  how.error = 2e-4;  // the source's texels are point samples: 128² of them are this close to the integral
  const auto checked = checkPrefilter(lit(128, 1), cube, how);
  REQUIRE(checked);
  REQUIRE(checked->levels.size() == 5);
  for (const auto& level : checked->levels) {
    INFO("roughness " << level.roughness << " rms " << level.rms << " worst " << level.worst);
    CHECK(level.within);
    CHECK(level.samples == (level.roughness == 0 ? 0 : std::min(64, 6 * level.size * level.size)));
  }
  CHECK(checked->within());
  const auto fromLatLong = checkPrefilter(litLatLong(128), cube, how);
  REQUIRE(fromLatLong);
  CHECK(fromLatLong->within());
}

TEST_CASE("The check finds another lobe, a turned cube, one wrong texel and another roughness", "[cubemap][check]") {
  const CubeLevel source = lit(64, 1);
  PrefilterCheckOptions how;
  how.error = 1e-3;
  const Cubemap good = filteredByHand(ReflectionLobe::BlinnPhong, {0, 0.5, 0.8});
  REQUIRE(checkPrefilter(source, good, how)->within());
  Cubemap bad = good;
  bad.lobe = ReflectionLobe::Ggx;
  CHECK_FALSE(checkPrefilter(source, bad, how)->levels[1].within);
  bad = good;
  bad.levels[2].roughness = 0.85;
  CHECK_FALSE(checkPrefilter(source, bad, how)->levels[2].within);
  CHECK(checkPrefilter(source, bad, how)->levels[1].within);
  bad = good;
  std::rotate(bad.levels[1].texels.begin(), bad.levels[1].texels.begin() + 64 * 3, bad.levels[1].texels.end());
  CHECK_FALSE(checkPrefilter(source, bad, how)->levels[1].within);
  bad = good;
  bad.levels[1].texels[200] = 3;  // the brightest texel is always looked at
  const auto found = checkPrefilter(source, bad, how);
  CHECK_FALSE(found->levels[1].within);
  CHECK(found->levels[1].worst > 0.5);
  bad.levels[1].texels[200] = std::nanf("");
  bad.levels[1].texels[0] = std::nanf("");
  CHECK_FALSE(checkPrefilter(source, bad, how)->within());
  bad = good;
  bad.lobe.reset();
  CHECK_FALSE(checkPrefilter(source, bad, how));
}

TEST_CASE("A level of roughness 0 is compared with the source itself where it has its size", "[cubemap][check]") {
  const CubeLevel source = lit(16, 1);
  Cubemap cube = filteredByHand(ReflectionLobe::BlinnPhong, {0});
  const auto same = checkPrefilter(source, cube);
  REQUIRE(same);
  CHECK(same->levels[0].samples == 6 * 16 * 16);
  CHECK(same->levels[0].rms == 0);
  CHECK(same->within());
  cube.levels[0].texels[1000] *= 1.01f;
  CHECK(checkPrefilter(source, cube)->levels[0].worst == Approx(0.01).epsilon(1e-3));
  CHECK_FALSE(checkPrefilter(source, cube)->within());
}

TEST_CASE("The check does not depend on threads, and tells how far it is", "[cubemap][check]") {
  const CubeLevel source = lit(16, 1);
  const Cubemap cube = filteredByHand(ReflectionLobe::Ggx, {0, 0.4, 0.9});
  PrefilterCheckOptions how;
  double last = 0;
  how.progress = [&](double share) {
    CHECK(share >= last);
    last = share;
  };
  std::vector<double> first;
  for (const int threads : {1, 2, 8}) {
    how.threads = threads;
    last = 0;
    const auto checked = checkPrefilter(source, cube, how);
    REQUIRE(checked);
    CHECK(last == 1);
    std::vector<double> numbers;
    for (const auto& level : checked->levels) numbers.insert(numbers.end(), {level.rms, level.worst});
    if (first.empty()) first = numbers;
    CHECK(numbers == first);
  }
  Cubemap black = cube;
  for (CubeLevel& level : black.levels) std::fill(level.texels.begin(), level.texels.end(), 0.0f);
  CubeLevel night = source;
  std::fill(night.texels.begin(), night.texels.end(), 0.0f);
  CHECK(checkPrefilter(night, black)->within());
}

TEST_CASE("Irradiance in spherical harmonics is exact for light of bands 0 to 2", "[cubemap][sh]") {
  // Radiance 2 + y - 3 z + 0.5 x + xy + (3z² - 1)/4: irradiance over π keeps band 0, 2/3 of band 1 and 1/4 of band 2.
  const auto radiance = [](const Vec& d) { return 4 + d[1] - 3 * d[2] + 0.5 * d[0] + d[0] * d[1] + (3 * d[2] * d[2] - 1) / 4; };
  const double expected[9] = {4, 2.0 / 3, -2, 1.0 / 3, 0.25, 0, 1.0 / 16, 0, 0};
  CubeLevel cube;
  cube.size = 64;
  for (std::size_t face = 0; face < 6; ++face)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        for (int c = 1; c <= 3; ++c) cube.texels.push_back(static_cast<float>(c * radiance(faceDirection(face, centre(x, 64), centre(y, 64)))));
  Image picture = makeImage(256, 128, 4, PixelType::F32);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 256; ++x) {
      const double theta = (y + 0.5) / 128 * M_PI, a = ((x + 0.5) / 256 - 0.5) * 2 * M_PI;
      for (std::size_t c = 0; c < 4; ++c) picture.f32()[(std::size_t(y) * 256 + std::size_t(x)) * 4 + c] = static_cast<float>(double(c + 1) * radiance({std::sin(theta) * std::sin(a), std::cos(theta), -std::sin(theta) * std::cos(a)}));
    }
  for (const auto& sh : {irradianceSh(cube), irradianceSh(picture)}) {
    REQUIRE(sh);
    for (std::size_t i = 0; i < 9; ++i)
      for (std::size_t c = 0; c < 3; ++c) CHECK((*sh)[i][c] == Approx(expected[i] * double(c + 1)).margin(2e-3));
  }
  // A lone lamp: without de-ringing the far side is negative, and band 0 stays.
  CubeLevel lamp = cube;
  std::fill(lamp.texels.begin(), lamp.texels.end(), 0.0f);
  lamp.texels[2 * 64 * 64 * 3 + (32 * 64 + 32) * 3] = 1e4f;
  const auto plain = irradianceSh(lamp), mild = irradianceSh(lamp, true);
  // At c = y = -8/15, x = sqrt(1 - y²), z = 0: where 1 + 2 c + 5/4 P2(c) is least, -0.158.
  const double y = -8.0 / 15, x = std::sqrt(1 - y * y);
  const auto below = [&](const IrradianceSh& sh) { return sh[0][0] + sh[1][0] * y + sh[3][0] * x + sh[4][0] * x * y - sh[6][0] + sh[8][0] * (x * x - y * y); };
  REQUIRE((plain && mild));
  CHECK((*plain)[0][0] == (*mild)[0][0]);
  CHECK((*mild)[1][0] < (*plain)[1][0]);
  CHECK(below(*plain) / (*plain)[0][0] == Approx(-0.158).margin(0.02));  // the lamp is a texel off +Y
  CHECK(below(*mild) > -1e-9 * (*mild)[0][0]);
  CHECK_FALSE(irradianceSh(CubeLevel{}));
  CHECK_FALSE(irradianceSh(Image{}));
}
