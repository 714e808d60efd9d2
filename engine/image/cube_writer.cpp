// Cubemaps to files (burnish/image.h).
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "core/file.h"
#include "image/convert.h"
#include "image/cube_file.h"
#include "image/cube_layout.h"
#include "image/encode.h"
#include "image/face_files.h"

namespace burnish {
namespace image {
namespace {

namespace fs = std::filesystem;

enum class Container : std::uint8_t { Dds, Ktx2, Exr, Folder };

Result<Container> containerOf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  std::error_code ignored;
  if (!file.has_filename() || ending.empty() || fs::is_directory(file, ignored)) return Container::Folder;
  if (ending == ".dds") return Container::Dds;
  if (ending == ".ktx2") return Container::Ktx2;
  if (ending == ".exr") return Container::Exr;
  return fail(file.string(), fmt::format("a cubemap cannot be written as '{}'", ending), "end the name in .dds, .ktx2 or .exr, or give a folder's name");
}

/// The picture in the type that the file is to have, finite.
Image converted(Image rgb, PixelType type) { return type == PixelType::F16 ? toF16(rgb) : std::move(rgb); }

Result<void> writeStack(const fs::path& file, const Cubemap& cubemap, PixelType type) {
  Metadata texts = metadataOf(cubemap, "software");
  texts.emplace_back("BurnishLayout", "levels");
  const auto bytes = encodeExr(converted(stackedStrips(cubemap), type), file.string(), texts);
  if (!bytes) return fail(bytes.error());
  return core::writeFileAtomic(file, *bytes);
}

Result<void> writeFaces(const fs::path& folder, const Cubemap& cubemap, PixelType type) {
  std::vector<core::NamedBytes> files;
  for (std::size_t k = 0; k < cubemap.levels.size(); ++k) {
    const CubeLevel& level = cubemap.levels[k];
    Metadata texts = metadataOf(cubemap, "software");
    texts.emplace_back("BurnishLevel", std::to_string(k));
    for (std::size_t face = 0; face < 6; ++face) {
      Image picture = makeImage(level.size, level.size, 3, PixelType::F32);
      std::memcpy(picture.data.data(), level.texels.data() + face * picture.pixelCount() * 3, picture.data.size());
      const std::string name = faceFileName(static_cast<int>(k), face);
      auto bytes = encodeExr(converted(std::move(picture), type), (folder / name).string(), texts);
      if (!bytes) return fail(bytes.error());
      files.push_back({name, std::move(*bytes)});
    }
  }
  return core::replaceFolder(folder, files, isFaceFileName);
}

void warnAboutHalves(const Cubemap& cubemap, const std::string& place, Report& report) {
  std::size_t over = 0;
  float largest = 0;
  for (const CubeLevel& level : cubemap.levels)
    for (const float v : level.texels)
      if (v > kHalfMax) ++over, largest = std::max(largest, v);
  if (over > 0) report.warn(place, fmt::format("{} values above {} (largest {:g}) were held there, the most that half floats hold", over, kHalfMax, largest));
}

}  // namespace
}  // namespace image

Result<void> writeCubemap(const std::filesystem::path& file, const Cubemap& cubemap, PixelType type, Report& report) {
  if (type != PixelType::F16 && type != PixelType::F32) return fail(file.string(), "a cubemap is written as half or float", "choose one of them");
  const auto container = image::containerOf(file);
  if (!container) return fail(container.error());
  if (auto ok = image::checkCubemap(cubemap, file.string()); !ok) return ok;
  if (type == PixelType::F16) image::warnAboutHalves(cubemap, file.string(), report);
  try {
    switch (*container) {
      case image::Container::Dds: return core::writeFileAtomic(file, image::encodeDds(cubemap, type));
      case image::Container::Ktx2: return core::writeFileAtomic(file, image::encodeKtx2(cubemap, type));
      case image::Container::Exr: return image::writeStack(file, cubemap, type);
      case image::Container::Folder: break;
    }
    return image::writeFaces(file, cubemap, type);
  } catch (const std::bad_alloc&) {
    return fail(file.string(), "there is not enough memory to write it", "make the cubemap smaller");
  }
}

}  // namespace burnish
