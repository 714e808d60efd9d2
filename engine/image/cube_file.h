// Cubemap files in memory: DDS, KTX2, and the metadata that both carry.
#pragma once
#include <burnish/image.h>

#include <string>
#include <string_view>
#include <utility>

namespace burnish::image {

/// Keys and values, UTF-8, in the order of their keys.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// What lets a reader map roughness to levels as the writer did: BurnishLobe, BurnishRoughness, BurnishVersion; and under `writerKey` this program's name. `scale`: where it is not 1, BurnishScale says that
/// texels are to be multiplied by it.
Metadata metadataOf(const Cubemap& cubemap, std::string_view writerKey = "KTXwriter", double scale = 1);
/// Puts lobe and roughness into a cubemap whose levels are read, and multiplies its texels by the scale. No such keys: it stays unfiltered. A version that is not known, a count of roughnesses that
/// does not fit, a scale that is no power of two or a value that is none is an error, so that no reader mixes up the mapping.
Result<void> applyMetadata(Cubemap& cubemap, const Metadata& metadata, std::string_view name);
/// BurnishScale; 1 if there is none, 0 if it is no power of two from 2^-127 to 2^126.
double scaleOf(const Metadata& metadata);
/// The value of a key; empty if there is none.
[[nodiscard]] std::string_view valueOf(const Metadata& metadata, std::string_view key);

/// Key and value pairs as KTX 2.0 stores them (3.13): a length, the key, NUL, the value, NUL, padding to 4 bytes. DDS files of ours carry the same bytes behind their texels.
std::vector<std::byte> encodeKeyValues(const Metadata& metadata);
/// `at`: where the bytes stand in the file, for errors. Values that are no text (they may be binary) are kept as they are, without a last NUL.
Result<Metadata> decodeKeyValues(std::span<const std::byte> bytes, std::size_t at, std::string_view name);

struct CubeFile {
  Cubemap cube;
  std::string format;  ///< for people: "DDS cube, R16G16B16A16_FLOAT"
  std::string writer;
  bool linear8 = false;  ///< 8-bit texels that the file calls linear
  double scale = 1;      ///< BurnishScale: what the stored texels were multiplied by
};

[[nodiscard]] bool isDds(std::span<const std::byte> file);
[[nodiscard]] bool isKtx2(std::span<const std::byte> file);
Result<CubeFile> decodeDds(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits);
Result<CubeFile> decodeKtx2(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits);

/// `cubemap` has passed checkCubemap; `type` is F16 or F32. RGBA, alpha 1. Values beyond half floats are held at 65504. The same cubemap gives the same bytes.
std::vector<std::byte> encodeDds(const Cubemap& cubemap, PixelType type);
/// `scale`: a power of two that texels are divided by, and that readers multiply them by.
std::vector<std::byte> encodeKtx2(const Cubemap& cubemap, PixelType type, double scale = 1);
/// The power of two with which a cubemap's largest value comes to lie in [16384, 32768) as a half float: nothing is held, and what is dark keeps its digits. 1 for a black one. A cubemap that was
/// written with it and read back has the same one.
double halfScale(const Cubemap& cubemap);

/// Whether a cubemap can be written: halving levels, all texels there, finite and not negative, roughness in [0, 1] and not falling, none without a lobe.
Result<void> checkCubemap(const Cubemap& cubemap, std::string_view name);
/// The texels of a level, divided by `scale`, as RGBA, halves or floats, faces in order.
std::vector<std::byte> encodeLevel(const CubeLevel& level, PixelType type, double scale = 1);

/// "Burnish 0.1.0"
std::string writerName();

}  // namespace burnish::image
