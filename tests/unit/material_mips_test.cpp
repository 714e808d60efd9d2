// Mip chains: what light sees is what is averaged.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "image/convert.h"
#include "material/codec.h"
#include "material/mips.h"
#include "material/resample.h"

using namespace burnish;

namespace {

Image randomMapA(int width, int height, unsigned seed, bool metals) {
  std::mt19937 rng(seed);
  Image image = makeImage(width, height, 4, PixelType::U8);
  for (std::size_t i = 0; i < image.pixelCount(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.u8()[4 * i + c] = std::uint8_t(rng() % 200);
    const unsigned kind = rng() % 3;
    image.u8()[4 * i + 3] = std::uint8_t(metals && kind == 0   ? 255
                                         : metals && kind == 1 ? 103 + rng() % 153
                                                               : rng() % 103);
  }
  return image;
}

material::Reflectance texel(const Image& a, int x, int y) {
  const std::uint8_t* p = a.u8() + 4 * (std::size_t(y) * std::size_t(a.width) + std::size_t(x));
  const auto& linear = image::srgbToLinearTable();
  return material::decode({{linear[p[0]], linear[p[1]], linear[p[2]]}, p[3]});
}

/// The exact area average of the original over a texel of a level, for sides that are powers of two.
material::Reflectance areaMean(const Image& original, const Image& level, int x, int y) {
  const int sx = original.width / level.width, sy = original.height / level.height;
  glm::dvec3 f0(0), diffuse(0);
  for (int j = 0; j < sy; ++j)
    for (int i = 0; i < sx; ++i) {
      const material::Reflectance r = texel(original, x * sx + i, y * sy + j);
      f0 += glm::dvec3(r.f0);
      diffuse += glm::dvec3(r.diffuse);
    }
  return {glm::vec3(f0 / double(sx * sy)), glm::vec3(diffuse / double(sx * sy))};
}

/// Half the linear distance between the sRGB codes around a value: what rounding may cost.
float roundingOf(float linear) {
  return 0.5f * (linear < 0.0031f ? 12.92f : 2.275f * std::pow(std::min(linear, 1.0f), 0.5833f) + 0.15f) / 255 + 1e-4f;
}

}  // namespace

TEST_CASE("Mips of map A keep F0 + diffuse in every texel", "[material]") {
  // 0.0018 is half a step of the code where all texels are dielectrics; with metal among them the albedo makes up for
  // the code's rounding.
  const Image original = randomMapA(64, 64, 1, true);
  const std::vector<Image> levels = material::buildMips(MapKind::AlbedoSubstance, original);
  REQUIRE(levels.size() == 7);
  for (std::size_t k = 1; k < levels.size(); ++k)
    for (int y = 0; y < levels[k].height; ++y)
      for (int x = 0; x < levels[k].width; ++x) {
        const material::Reflectance truth = areaMean(original, levels[k], x, y), shown = texel(levels[k], x, y);
        for (int c = 0; c < 3; ++c) {
          const float sum = truth.f0[c] + truth.diffuse[c];
          CHECK(shown.f0[c] + shown.diffuse[c] == Approx(sum).margin(roundingOf(sum) + 0.0018f));
        }
      }
}

TEST_CASE("Mips of dielectrics average F0 and diffuse apart", "[material]") {
  const Image original = randomMapA(32, 32, 2, false);
  const std::vector<Image> levels = material::buildMips(MapKind::AlbedoSubstance, original);
  for (std::size_t k = 1; k < levels.size(); ++k)
    for (int y = 0; y < levels[k].height; ++y)
      for (int x = 0; x < levels[k].width; ++x) {
        const material::Reflectance truth = areaMean(original, levels[k], x, y), shown = texel(levels[k], x, y);
        CHECK(shown.f0.x == Approx(truth.f0.x).margin(0.0018));  // half a step of the code at F0 0.25
        for (int c = 0; c < 3; ++c)
          CHECK(shown.diffuse[c] == Approx(truth.diffuse[c]).margin(roundingOf(truth.diffuse[c])));
      }
}

TEST_CASE("Codes run one way from paint to metal in mips", "[material]") {
  // Columns of iron and paint in shares that rise from left to right: the code must rise with them, though grey F0 up
  // to 0.25 would also fit a gem.
  Image image = makeImage(16, 16, 4, PixelType::U8);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const bool metal = y < x;
      const std::uint8_t v[4] = {std::uint8_t(metal ? 190 : 120), std::uint8_t(metal ? 190 : 120),
                                 std::uint8_t(metal ? 190 : 120), std::uint8_t(metal ? 255 : 85)};
      std::copy_n(v, 4, image.u8() + 4 * (y * 16 + x));
    }
  // Averages over whole columns: a 16x1 picture would come from anisotropic halving, so rows are reduced by hand here.
  int last = 0;
  for (int x = 0; x < 16; ++x) {
    Image column = makeImage(1, 16, 4, PixelType::U8);
    for (int y = 0; y < 16; ++y) std::copy_n(image.u8() + 4 * (y * 16 + x), 4, column.u8() + 4 * y);
    const int code = material::buildMips(MapKind::AlbedoSubstance, column).back().u8()[3];
    CHECK(code >= last);
    last = code;
  }
  CHECK(last > 200);
}

TEST_CASE("Constant maps stay constant, whatever their size", "[material]") {
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 5}, {300, 1}, {1, 33}, {64, 64}, {100, 37}})
    for (const MapKind kind : {MapKind::AlbedoSubstance, MapKind::NormalRoughness, MapKind::Emissive,
                               MapKind::MetalRough, MapKind::Occlusion}) {
      Image image = makeImage(w, h, kind == MapKind::Occlusion ? 2 : 4, PixelType::U8);
      const std::uint8_t value[4] = {200, 90, 140, 160};
      for (std::size_t i = 0; i < image.byteSize(); ++i) image.u8()[i] = value[i % std::size_t(image.channels)];
      if (kind == MapKind::NormalRoughness)  // a unit vector as eight bits hold it
        for (std::size_t i = 0; i < image.pixelCount(); ++i) {
          image.u8()[4 * i] = 187;
          image.u8()[4 * i + 1] = 98;
          image.u8()[4 * i + 2] = 236;
          image.u8()[4 * i + 3] = 5;  // as smooth as it gets: nothing may widen it
        }
      const std::vector<Image> levels = material::buildMips(kind, image);
      REQUIRE(levels.back().width == 1);
      REQUIRE(levels.back().height == 1);
      REQUIRE(levels.size() == 1 + std::size_t(std::floor(std::log2(std::max(w, h)))));
      for (std::size_t k = 1; k < levels.size(); ++k) {
        CHECK(levels[k].width == std::max(1, levels[k - 1].width / 2));
        for (std::size_t i = 0; i < levels[k].byteSize(); ++i) {
          INFO("kind " << int(kind) << " level " << k << " byte " << i);
          REQUIRE(std::abs(int(levels[k].u8()[i]) - int(image.u8()[i % std::size_t(image.channels)])) <=
                  (kind == MapKind::NormalRoughness && i % 4 < 3 ? 1 : 0));
        }
      }
    }
}

TEST_CASE("Halving weights cover each sample once", "[material]") {
  for (int n = 1; n < 70; ++n) {
    const auto taps = material::halvingTaps(n);
    REQUIRE(int(taps.size()) == std::max(1, n / 2));
    std::vector<double> covered(std::size_t(n), 0);
    for (const auto& t : taps) {
      double sum = 0;
      for (int k = 0; k < t.count; ++k) {
        REQUIRE(t.first + k < n);
        sum += t.weight[k];
        covered[std::size_t(t.first + k)] += t.weight[k];
      }
      CHECK(sum == Approx(1).margin(1e-6));
    }
    for (const double c : covered) CHECK(c == Approx(double(taps.size()) / n).margin(1e-6));
  }
}

TEST_CASE("Odd sides average all their pixels", "[material]") {
  std::mt19937 rng(7);
  Image image = makeImage(37, 23, 1, PixelType::U8);
  double mean = 0;
  for (std::size_t i = 0; i < image.byteSize(); ++i) mean += image.u8()[i] = std::uint8_t(rng());
  mean /= double(image.byteSize());
  const auto levels = material::buildMips(MapKind::Occlusion, image);
  CHECK(double(levels.back().u8()[0]) == Approx(mean).margin(0.51));
  double second = 0;
  for (std::size_t i = 0; i < levels[1].byteSize(); ++i) second += levels[1].u8()[i];
  CHECK(second / double(levels[1].byteSize()) == Approx(mean).margin(0.3));
}

TEST_CASE("Emission is averaged in linear light, roughness as alpha squared", "[material]") {
  Image checker = makeImage(2, 1, 3, PixelType::U8);
  for (int c = 0; c < 3; ++c) checker.u8()[c] = 255;
  CHECK(int(material::buildMips(MapKind::Emissive, checker).back().u8()[1]) == 188);  // sRGB of one half

  Image rough = makeImage(2, 1, 3, PixelType::U8);
  rough.u8()[1] = 255;
  rough.u8()[2] = 100;
  const Image mean = material::buildMips(MapKind::MetalRough, rough).back();
  CHECK(int(mean.u8()[1]) == int(std::lround(255 * std::pow(0.5, 0.25))));
  CHECK(int(mean.u8()[2]) == 50);
}

namespace {
/// alpha² of the lobe that all the texels' lobes make together, by summing half vectors: each texel's normal and the
/// lobe around it (slopes with variance alpha²/2 an axis) are sampled, and the slopes' variance about the mean
/// direction is measured.
double integratedAlpha2(double sigma, double alpha, std::mt19937& rng) {
  std::normal_distribution<double> gauss;
  constexpr int kSamples = 400000;
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double x = sigma * gauss(rng) + alpha / std::sqrt(2.0) * gauss(rng),
                 y = sigma * gauss(rng) + alpha / std::sqrt(2.0) * gauss(rng);
    sum += x * x + y * y;
  }
  return sum / kSamples;  // two axes of alpha²/2
}
}  // namespace

TEST_CASE("Mips of map B widen the lobe by the spread of normals", "[material]") {
  std::mt19937 rng(3);
  std::normal_distribution<float> gauss;
  for (const float sigma : {0.03f, 0.1f, 0.2f})
    for (const int roughByte : {13, 64, 128}) {
      Image image = makeImage(256, 256, 4, PixelType::U8);
      for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        const glm::vec3 n = glm::normalize(glm::vec3(sigma * gauss(rng), sigma * gauss(rng), 1));
        for (int c = 0; c < 3; ++c) image.u8()[4 * i + std::size_t(c)] = std::uint8_t(std::lround(128 + 127 * n[c]));
        image.u8()[4 * i + 3] = std::uint8_t(roughByte);
      }
      const Image last = material::buildMips(MapKind::NormalRoughness, image).back();
      const double r = double(roughByte) / 255, alpha = r * r;
      const double expected = std::pow(integratedAlpha2(double(sigma), alpha, rng), 0.25);  // perceptual roughness
      INFO("sigma " << sigma << " roughness " << r);
      CHECK(double(last.u8()[3]) / 255 == Approx(expected).epsilon(0.03).margin(0.004));
      CHECK(std::abs(int(last.u8()[2]) - 255) <= 1);
    }
}

TEST_CASE("Spread is the variance of normals whose slopes are Gaussian", "[material]") {
  for (const double sigma : {0.01, 0.05, 0.1, 0.2, 0.3}) {
    // Mean of cos over slopes s with density s/σ² exp(-s²/2σ²), by the midpoint rule.
    double mean = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double s = 10 * sigma * (i + 0.5) / kSteps;
      mean += s / (sigma * sigma) * std::exp(-s * s / (2 * sigma * sigma)) / std::sqrt(1 + s * s) * 10 * sigma / kSteps;
    }
    INFO("sigma " << sigma);
    const double spread = double(material::spreadFromMeanLength(float(mean)));
    CHECK(spread <= 2 * sigma * sigma * 1.01);
    CHECK(spread >= 2 * sigma * sigma * (1 - 2.5 * sigma * sigma - 0.01));  // Toksvig's figure is short by about 2 σ²
  }
  CHECK(material::spreadFromMeanLength(1) == 0);
  CHECK(material::spreadFromMeanLength(0) == 1);
  CHECK(material::spreadFromMeanLength(1.0000002f) == 0);
}

TEST_CASE("What is no map comes back as it is", "[material]") {
  CHECK(material::buildMips(MapKind::AlbedoSubstance, Image{}).size() == 1);
  CHECK(material::buildMips(MapKind::AlbedoSubstance, makeImage(4, 4, 3, PixelType::U8)).size() == 1);
  CHECK(material::buildMips(MapKind::Emissive, makeImage(4, 4, 3, PixelType::F32)).size() == 1);
}
