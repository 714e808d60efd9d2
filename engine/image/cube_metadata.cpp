// What a cubemap file says of its levels beside their texels.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "image/bytes.h"
#include "image/convert.h"
#include "image/cube_file.h"
#include "image/cube_texels.h"

namespace burnish::image {
namespace {

constexpr std::string_view kLobe = "BurnishLobe", kRoughness = "BurnishRoughness", kVersion = "BurnishVersion", kScale = "BurnishScale";
constexpr std::string_view kLobeNames[] = {"blinn-phong", "ggx"};
constexpr std::string_view kMappingVersion = "1";

tl::unexpected<Error> badMetadata(std::string_view name, std::string what) { return fail(std::string(name) + ": metadata", std::move(what), "prefilter the environment again"); }

/// Numbers between single spaces; nothing else.
bool parseNumbers(std::string_view text, std::vector<double>& numbers) {
  while (!text.empty()) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value) || numbers.size() > 64) return false;
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return true;
    if (text[0] != ' ') return false;
    text.remove_prefix(1);
    if (text.empty()) return false;
  }
  return true;
}

}  // namespace

std::string writerName() { return "Burnish " BURNISH_LIBRARY_VERSION; }

std::string_view valueOf(const Metadata& metadata, std::string_view key) {
  for (const auto& [k, value] : metadata)
    if (k == key) return value;
  return {};
}

Metadata metadataOf(const Cubemap& cubemap, std::string_view writerKey, double scale) {
  std::string roughness;
  for (const CubeLevel& level : cubemap.levels) roughness += fmt::format("{}{}", roughness.empty() ? "" : " ", level.roughness);
  const std::string_view lobe = cubemap.lobe ? kLobeNames[static_cast<std::size_t>(*cubemap.lobe)] : "none";
  Metadata out = {{std::string(kLobe), std::string(lobe)}, {std::string(kRoughness), roughness}};
  if (scale != 1) out.emplace_back(kScale, fmt::format("{}", scale));
  out.emplace_back(kVersion, kMappingVersion);
  out.emplace_back(writerKey, writerName());
  return out;
}

double halfScale(const Cubemap& cubemap) {
  float most = 0;
  for (const CubeLevel& level : cubemap.levels)
    for (const float v : level.texels) most = std::max(most, v);
  if (!(most > 0 && std::isfinite(most))) return 1;
  const auto rounded = [&](double scale) {
    const std::array<float, 1> in{static_cast<float>(most / scale)};
    std::array<std::uint16_t, 1> half{};
    std::array<float, 1> out{};
    floatToHalf(in, half);
    halfToFloat(half, out);
    return out[0];
  };
  const double scale = std::ldexp(1.0, std::max(std::ilogb(most) - 14, -126));
  return rounded(scale) < 32768 ? scale : 2 * scale;
}

Result<void> applyMetadata(Cubemap& cubemap, const Metadata& metadata, std::string_view name) {
  const std::string_view lobe = valueOf(metadata, kLobe), roughness = valueOf(metadata, kRoughness), version = valueOf(metadata, kVersion);
  if (lobe.empty() && roughness.empty() && version.empty()) return {};
  if (version != kMappingVersion) return badMetadata(name, fmt::format("{} is '{}', this program knows {}", kVersion, version.substr(0, 40), kMappingVersion));
  std::optional<ReflectionLobe> found;
  for (std::size_t i = 0; i < std::size(kLobeNames); ++i)
    if (lobe == kLobeNames[i]) found = static_cast<ReflectionLobe>(i);
  if (!found && lobe != "none") return badMetadata(name, fmt::format("{} is '{}', neither of blinn-phong, ggx, none", kLobe, lobe.substr(0, 40)));
  std::vector<double> values;
  if (!parseNumbers(roughness, values)) return badMetadata(name, fmt::format("{} is no list of numbers", kRoughness));
  if (values.size() != cubemap.levels.size()) return badMetadata(name, fmt::format("{} has {} values for {} levels", kRoughness, values.size(), cubemap.levels.size()));
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!(values[k] >= 0 && values[k] <= 1) || (k > 0 && values[k] < values[k - 1]) || (!found && values[k] != 0))
      return badMetadata(name, fmt::format("{} {} of level {} is outside 0 to 1, less than the one before, or has no lobe", kRoughness, values[k], k));
    cubemap.levels[k].roughness = values[k];
  }
  const double scale = scaleOf(metadata);
  if (scale == 0) return badMetadata(name, fmt::format("{} is '{}', no power of two from 2^-127 to 2^126", kScale, valueOf(metadata, kScale).substr(0, 40)));
  for (CubeLevel& level : cubemap.levels)
    for (float& v : level.texels) v *= static_cast<float>(scale);
  cubemap.lobe = found;
  return {};
}

double scaleOf(const Metadata& metadata) {
  const std::string_view text = valueOf(metadata, kScale);
  if (text.empty()) return 1;
  std::vector<double> values;
  int exponent = 0;
  const bool good = parseNumbers(text, values) && values.size() == 1 && values[0] > 0 && std::frexp(values[0], &exponent) == 0.5 && std::abs(exponent) <= 127;
  return good ? values[0] : 0;
}

std::vector<std::byte> encodeKeyValues(const Metadata& metadata) {
  ByteWriter out;
  for (const auto& [key, value] : metadata) {
    out.u32(static_cast<std::uint32_t>(key.size() + value.size() + 2));
    out.text(key);
    out.zeros(1);
    out.text(value);
    out.zeros(1);
    out.align(4);
  }
  return out.take();
}

Result<Metadata> decodeKeyValues(std::span<const std::byte> bytes, std::size_t at, std::string_view name) {
  Metadata metadata;
  Bytes in(bytes);
  while (in.left() > 0) {
    const std::size_t begin = in.position();
    const std::uint32_t length = in.leU32();
    const std::span<const std::byte> pair = in.take(length);
    const auto* text = reinterpret_cast<const char*>(pair.data());
    const auto* nul = length > 1 && !in.bad() ? static_cast<const char*>(std::memchr(text, 0, length)) : nullptr;
    if (!nul || nul == text) return fail(fmt::format("{}: byte {}", name, at + begin), fmt::format("a key and value of {} bytes are cut off or have no key", length), "export the file again");
    std::string_view value(nul + 1, static_cast<std::size_t>(text + length - nul - 1));
    if (!value.empty() && value.back() == '\0') value.remove_suffix(1);
    metadata.emplace_back(std::string(text, nul), std::string(value));
    in.skip(std::min<std::size_t>((4 - length % 4) % 4, in.left()));  // the last one's padding may be missing
  }
  return metadata;
}

Result<void> checkCubemap(const Cubemap& cubemap, std::string_view name) {
  const auto bad = [&](std::string what, const char* remedy) { return fail(std::string(name), std::move(what), remedy); };
  if (cubemap.levels.empty() || cubemap.levels[0].size < 1) return bad("a cubemap without levels cannot be written", "filter an environment first");
  const int size = cubemap.levels[0].size;
  if (static_cast<int>(cubemap.levels.size()) > fullChain(size)) return bad(fmt::format("{} levels are more than faces of {} can be halved", cubemap.levels.size(), size), "leave the last ones out");
  double before = 0;
  for (std::size_t k = 0; k < cubemap.levels.size(); ++k) {
    const CubeLevel& level = cubemap.levels[k];
    const int expected = levelSize(size, static_cast<int>(k));
    if (level.size != expected || level.texels.size() != cubeTexels(expected) * 3)
      return bad(fmt::format("level {} has faces of {} with {} values, not of {} with {}", k, level.size, level.texels.size(), expected, cubeTexels(expected) * 3), "halve the faces from level to level");
    if (!(level.roughness >= before && level.roughness <= 1) || (!cubemap.lobe && level.roughness != 0))
      return bad(fmt::format("level {} has roughness {} after {}{}", k, level.roughness, before, cubemap.lobe ? "" : " and no lobe"), "let it rise from 0 to 1, and name the lobe");
    before = level.roughness;
    for (std::size_t i = 0; i < level.texels.size(); ++i)
      if (!(level.texels[i] >= 0 && std::isfinite(level.texels[i])))
        return bad(fmt::format("level {} holds {} in value {}", k, level.texels[i], i), "make every value finite and at least 0");
  }
  return {};
}

std::vector<std::byte> encodeLevel(const CubeLevel& level, PixelType type, double scale) {
  const std::size_t texels = level.texels.size() / 3;
  std::vector<float> rgba(texels * 4, 1.0f);
  const auto inverse = static_cast<float>(1 / scale);
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    const float v = level.texels[i] * inverse;
    rgba[i / 3 * 4 + i % 3] = type == PixelType::F16 ? std::min(v, kHalfMax) : v;
  }
  std::vector<std::byte> bytes(rgba.size() * static_cast<std::size_t>(bytesPerChannel(type)));
  if (type == PixelType::F16)
    floatToHalf(rgba, {reinterpret_cast<std::uint16_t*>(bytes.data()), rgba.size()});
  else
    std::memcpy(bytes.data(), rgba.data(), bytes.size());
  return bytes;
}

}  // namespace burnish::image
