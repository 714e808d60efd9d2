#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "inspect.h"
#include "messages.h"

namespace cli {
namespace {

using burnish::Image;
using burnish::PixelType;


float valueAt(const Image& image, std::size_t i) {
  switch (image.type) {
    case PixelType::U8: return float(image.u8()[i]) / 255;
    case PixelType::U16: {
      std::uint16_t v = 0;
      std::memcpy(&v, image.data.data() + i * 2, 2);
      return float(v) / 65535;
    }
    case PixelType::F32: return image.f32()[i];
    case PixelType::F16: break;  // no decoder gives it
  }
  return 0;
}

struct ChannelCount {
  float least = INFINITY, most = -INFINITY;
  double sum = 0;
  std::uint64_t finite = 0, nan = 0, infinite = 0, negative = 0, overHalf = 0;

  void add(float v) {
    if (std::isnan(v)) return void(++nan);
    if (std::isinf(v)) return void(++infinite);
    ++finite;
    sum += v;
    least = std::min(least, v);
    most = std::max(most, v);
    negative += v < 0 ? 1 : 0;
    overHalf += v > kMostHalf ? 1 : 0;
  }
};

std::string_view typeName(PixelType type) {
  constexpr std::string_view kNames[] = {"8-bit", "16-bit", "half", "float"};
  return kNames[int(type)];
}

std::string_view channelNames(int channels) { return channels < 3 ? "YA" : "RGBA"; }

/// sRGB encoding (IEC 61966-2-1), clipped, 0..255.
int encodeSrgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  return int(std::lround(255 * (x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f)));
}

}  // namespace

void printPicture(const Image& image, const std::string& name) {
  fmt::print("{}\n", shown(name));
  fmt::print("size: {}x{}, {} channels, {}{}\n", image.width, image.height, image.channels, typeName(image.type),
             image.width == 2 * image.height ? ", shaped like a lat-long environment" : "");
  std::vector<ChannelCount> counts{std::size_t(image.channels)};
  for (std::size_t i = 0; i < image.pixelCount() * std::size_t(image.channels); ++i) counts[i % std::size_t(image.channels)].add(valueAt(image, i));
  ChannelCount all;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    const ChannelCount& count = counts[c];
    all.nan += count.nan;
    all.infinite += count.infinite;
    all.negative += count.negative;
    all.overHalf += count.overHalf;
    if (count.finite > 0)
      fmt::print("{}: {:.6g} to {:.6g}, mean {:.6g}\n", channelNames(image.channels)[c], count.least, count.most, count.sum / double(count.finite));
    else
      fmt::print("{}: no finite value\n", channelNames(image.channels)[c]);
  }
  fmt::print("not finite: {} NaN, {} infinite\n", all.nan, all.infinite);
  fmt::print("negative: {}; over 65504 (clamped when loaded): {}\n", all.negative, all.overHalf);
}

void printSubstance(const burnish::Substance& substance) {
  const glm::vec3 f0 = substance.f0;
  fmt::print("{}: {}\n", substance.name, substance.conductor ? "conductor" : "dielectric");
  fmt::print("F0: {:.4f},{:.4f},{:.4f} (linear Rec.709)\n", f0.x, f0.y, f0.z);
  if (substance.conductor) {
    fmt::print("eta: {:.3f},{:.3f},{:.3f} (effective index of refraction of red, green, blue)\n", substance.eta.x, substance.eta.y, substance.eta.z);
    fmt::print("k: {:.3f},{:.3f},{:.3f} (extinction, from eta and F0)\n", substance.k.x, substance.k.y, substance.k.z);
  } else {
    fmt::print("IOR: {:.4f} at 589 nm\n", substance.ior);
  }
  const float code = substance.conductor ? burnish::encodeMetalness(1) : burnish::encodeDielectric(f0.x);
  const glm::vec3 decoded = burnish::decodeSubstance(code, f0).f0;
  fmt::print("code: {:.4f} ({} of 255), which decodes to F0 {:.4f},{:.4f},{:.4f}\n", code, std::lround(code * 255), decoded.x, decoded.y, decoded.z);
  const int r = encodeSrgb(f0.x), g = encodeSrgb(f0.y), b = encodeSrgb(f0.z);
  const std::string swatch = isatty(STDOUT_FILENO) == 1 ? fmt::format(" \x1b[48;2;{};{};{}m      \x1b[0m", r, g, b) : "";
  fmt::print("sRGB: #{:02x}{:02x}{:02x}{}{}\n", r, g, b, swatch, substance.conductor ? " (albedo of map A)" : " (reflectance; albedo is the coat's own)");
  fmt::print("source: {}\n", substance.source);
}

}  // namespace cli
