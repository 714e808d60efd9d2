// Conversions of pixel values, against definitions evaluated in double.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/convert.h"
#include "image/resample.h"

using namespace burnish;
using namespace burnish::image;

namespace {

/// IEEE 754 binary16 by its definition.
double halfValue(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const double sign = bits & 0x8000 ? -1 : 1;
  if (exponent == 31) return mantissa ? std::nan("") : sign * std::numeric_limits<double>::infinity();
  return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25));
}

double srgbDecode(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }
double srgbEncode(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

std::uint16_t* halves(Image& image) { return reinterpret_cast<std::uint16_t*>(image.data.data()); }

}  // namespace

TEST_CASE("Every half float converts exactly, both ways", "[image]") {
  std::vector<std::uint16_t> all(65536), back(65536);
  std::vector<float> wide(65536);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint16_t>(i);
  halfToFloat(all, wide);
  floatToHalf(wide, back);
  int wrong = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double want = halfValue(all[i]);
    if (std::isnan(want))
      wrong += !std::isnan(wide[i]) || !std::isnan(halfValue(back[i]));
    else
      wrong += wide[i] != want || back[i] != all[i];
  }
  CHECK(wrong == 0);
}

TEST_CASE("Floats round to the nearest half, ties to even, in vectors and in the rest", "[image]") {
  std::vector<float> values;
  for (int i = 0; i < 4099; ++i)
    values.push_back(std::ldexp(1.0f + float(i * 7919 % 8388608) / 8388608.0f, i % 42 - 26) * (i % 3 ? 1.0f : -1.0f));
  for (float v : {65504.0f, 65519.9f, 65520.0f, 1e30f, -1e30f, 1.00048828125f, 1.00146484375f, 0.0f, -0.0f})
    values.push_back(v);
  std::vector<std::uint16_t> out(values.size());
  floatToHalf(values, out);
  int wrong = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double v = values[i], got = halfValue(out[i]);
    if (std::isinf(got)) {
      wrong += std::abs(v) < 65520;
      continue;
    }
    for (int step : {-1, 1}) {  // no neighbour is nearer; at the same distance the mantissa is even
      if ((out[i] & 0x7fff) == 0 && step < 0) continue;
      const double other = halfValue(static_cast<std::uint16_t>(out[i] + step));
      if (std::isinf(other)) continue;
      const double mine = std::abs(got - v), its = std::abs(other - v);
      wrong += mine > its || (mine == its && mine > 0 && (out[i] & 1));
    }
  }
  CHECK(wrong == 0);
  CHECK(out[values.size() - 7] == 0x7c00);  // 65520 is the first that overflows
}

TEST_CASE("sRGB decoding and encoding are each other's inverse and the standard's curve", "[image]") {
  int wrong = 0;
  for (int code = 0; code < 256; ++code) {
    const float linear = srgbToLinearTable()[std::size_t(code)];
    CHECK(linear == Approx(srgbDecode(code / 255.0)).margin(1e-7));
    wrong += linearToSrgb8(linear) != code;
  }
  for (int i = 0; i <= 200000; ++i) {
    const double v = i / 200000.0, exact = srgbEncode(v) * 255;
    const int code = linearToSrgb8(static_cast<float>(v));
    wrong += std::abs(code - exact) >
             0.5 + 2e-3;  // the two branches of the standard differ by 1e-3 of a code where they meet
  }
  CHECK(wrong == 0);
  CHECK(linearToSrgb8(-1) == 0);
  CHECK(linearToSrgb8(2) == 255);
  CHECK(linearToSrgb8(std::nanf("")) == 0);
  CHECK(linearToSrgb8(std::numeric_limits<float>::infinity()) == 255);
}

TEST_CASE("toF32 normalises integers and leaves alpha linear", "[image]") {
  Image rgba = makeImage(1, 1, 4, PixelType::U8);
  for (int c = 0; c < 4; ++c) rgba.u8()[c] = 128;
  const Image plain = toF32(rgba), curved = toF32(rgba, true);
  CHECK(plain.f32()[0] == Approx(128 / 255.0));
  CHECK(curved.f32()[2] == Approx(srgbDecode(128 / 255.0)));
  CHECK(curved.f32()[3] == Approx(128 / 255.0));
  Image wide = makeImage(2, 1, 1, PixelType::U16);
  halves(wide)[0] = 65535, halves(wide)[1] = 257;
  CHECK(toF32(wide).f32()[0] == 1.0f);
  CHECK(toF32(wide).f32()[1] == Approx(1 / 255.0));
}

TEST_CASE("makeFinite mends exactly what is not finite or out of range, and says so", "[image]") {
  const float inf = std::numeric_limits<float>::infinity();
  const float values[] = {1, -65504, 65504, 65505, 1e30f, inf, -inf, std::nanf(""), 0};
  const float want[] = {1, -65504, 65504, 65504, 65504, 65504, -65504, 0, 0};
  Image image = makeImage(3, 1, 3, PixelType::F32);
  std::memcpy(image.data.data(), values, sizeof values);
  const Image halfImage = toF16(image);
  const Mended mended = makeFinite(image);
  CHECK(mended.any());
  CHECK(mended.nonFinite == 3);
  CHECK(mended.clamped == 2);
  CHECK(mended.first == 1);
  for (int i = 0; i < 9; ++i) {
    CHECK(image.f32()[i] == want[i]);
    CHECK(halfValue(reinterpret_cast<const std::uint16_t*>(halfImage.data.data())[i]) == want[i]);
  }
  CHECK_FALSE(makeFinite(image).any());
  Image half = makeImage(2, 1, 1, PixelType::F16);
  halves(half)[0] = 0x7c00, halves(half)[1] = 0x7e00;
  CHECK(makeFinite(half).nonFinite == 2);
  CHECK(halves(half)[0] == 0x7bff);
  CHECK(halves(half)[1] == 0);
  Image bytes = makeImage(2, 2, 1, PixelType::U8);
  CHECK_FALSE(makeFinite(bytes).any());
}

TEST_CASE("Channels are taken out in any order and type", "[image]") {
  for (PixelType type : {PixelType::U8, PixelType::U16, PixelType::F16, PixelType::F32}) {
    Image image = makeImage(3, 2, 4, type);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::byte>(i);
    const Image out = extractChannels(image, {2, 0});
    REQUIRE(out.channels == 2);
    const auto size = std::size_t(bytesPerChannel(type));
    for (std::size_t p = 0; p < 6; ++p)
      for (std::size_t b = 0; b < size; ++b) {
        CHECK(out.data[p * 2 * size + b] == image.data[(p * 4 + 2) * size + b]);
        CHECK(out.data[p * 2 * size + size + b] == image.data[p * 4 * size + b]);
      }
  }
}

TEST_CASE("resampleArea is the mean of the covered area", "[image]") {
  Image image = makeImage(7, 5, 2, PixelType::F32);
  for (std::size_t i = 0; i < 70; ++i) image.f32()[i] = static_cast<float>(i * i % 31);
  for (const auto& [w, h] : {std::pair{7, 5}, {1, 1}, {3, 2}, {4, 5}, {14, 10}, {10, 3}}) {
    INFO(w << " x " << h);
    const Image out = resampleArea(image, w, h);
    REQUIRE(out.width == w);
    REQUIRE(out.height == h);
    double worst = 0;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x)
        for (int c = 0; c < 2; ++c) {
          double sum = 0, area = 0;
          for (int sy = 0; sy < 5; ++sy)
            for (int sx = 0; sx < 7; ++sx) {
              const double dx = std::min((x + 1) * 7.0 / w, sx + 1.0) - std::max(x * 7.0 / w, double(sx));
              const double dy = std::min((y + 1) * 5.0 / h, sy + 1.0) - std::max(y * 5.0 / h, double(sy));
              if (dx <= 0 || dy <= 0) continue;
              sum += dx * dy * image.f32()[(sy * 7 + sx) * 2 + c];
              area += dx * dy;
            }
          worst = std::max(worst, std::abs(out.f32()[(y * w + x) * 2 + c] - sum / area));
        }
    CHECK(worst < 1e-5 * 31);
  }
}

TEST_CASE("resampleArea keeps constants, and averages light when asked", "[image]") {
  Image grey = makeImage(13, 11, 3, PixelType::U8);
  for (std::size_t i = 0; i < grey.data.size(); ++i) grey.u8()[i] = 93;
  for (AverageIn average : {AverageIn::Values, AverageIn::LinearLight})
    for (int size : {1, 2, 5, 29}) {
      const Image out = resampleArea(grey, size, size, average);
      int wrong = 0;
      for (std::size_t i = 0; i < out.data.size(); ++i) wrong += out.u8()[i] != 93;
      CHECK(wrong == 0);
    }
  Image checker = makeImage(2, 1, 4, PixelType::U8);
  for (int c = 0; c < 4; ++c) checker.u8()[c] = 255;
  const Image values = resampleArea(checker, 1, 1), light = resampleArea(checker, 1, 1, AverageIn::LinearLight);
  CHECK(int(values.u8()[0]) == 128);
  CHECK(int(light.u8()[0]) == 188);
  CHECK(int(light.u8()[3]) == 128);
  Image wide = makeImage(2, 1, 1, PixelType::U16);
  halves(wide)[0] = 65535;
  CHECK(halves(wide)[0] == 65535);
  Image mean = resampleArea(wide, 1, 1);
  CHECK(halves(mean)[0] == 32768);
  CHECK(resampleArea(Image{}, 4, 4).empty());
}
