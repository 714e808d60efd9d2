// What a picture file's first bytes say: its format and how large it will be, without any decoding library.
// Read by the program before a decoder sees the file, so that a decompression bomb costs nothing.
#pragma once
#include <burnish/image.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace burnish::image {

enum class PictureFormat : std::uint8_t { Png, Jpeg, Hdr, Exr };

struct PictureHeader {
  PictureFormat format = PictureFormat::Png;
  int width = 0, height = 0;          ///< pixels of the picture that decoding gives (OpenEXR: the display window)
  int dataWidth = 0, dataHeight = 0;  ///< pixels stored in the file; differs from the above for OpenEXR only
  int channels = 0;                   ///< at most this many come out: 1 to 4 (PNG transparency counted in)
  PixelType type = PixelType::U8;
  [[nodiscard]] std::uint64_t decodedBytes() const;  ///< an upper bound of what decoding gives
};

/// The format by magic bytes; nothing else (no file name, no MIME type) is believed.
std::optional<PictureFormat> pictureFormat(std::span<const std::byte> file);
std::string_view formatName(PictureFormat format);

/// Parses the header of one of the four formats. Errors: unknown format, damaged or unsupported header, a size that the
/// file's length cannot hold. Sizes in the answer are positive and fit 31 bits; they are not yet checked against
/// limits.
Result<PictureHeader> readPictureHeader(std::span<const std::byte> file, std::string_view name);

/// The attributes of an OpenEXR file's first part that hold text (type `string`), by name; `envmap` (OpenEXR's own layouts of surroundings) gives "latlong" or "cube".
/// What is no OpenEXR file, or damaged, has none.
std::vector<std::pair<std::string, std::string>> exrTexts(std::span<const std::byte> file);

/// Whether a picture of this size may be decoded at all.
Result<void> checkPictureLimits(const PictureHeader& header, const DecodeLimits& limits, std::string_view name);

}  // namespace burnish::image
