// Surroundings from files (burnish/image.h): which kind of file it is, its cube or lat-long picture, values that are mended.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/file.h"
#include "image/convert.h"
#include "image/cube_file.h"
#include "image/cube_layout.h"
#include "image/cube_texels.h"
#include "image/face_files.h"
#include "image/picture_header.h"

namespace burnish {
namespace image {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kSigned = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

/// What readers of one call share.
class Reader {
 public:
  Reader(const EnvironmentFileOptions& options, Report& report) : options_(options), report_(report) {}

  Result<EnvironmentFile> read(const fs::path& file);
  Result<EnvironmentFile> readFaces(std::span<const fs::path> faces);

 private:
  struct Picture {
    Image rgb;
    Metadata texts;  ///< of an OpenEXR file's header
    bool was8 = false;
  };

  [[nodiscard]] std::uint64_t mostFileBytes() const { return options_.limits.maxBytes > ~std::uint64_t(0) / 2 ? options_.limits.maxBytes : 2 * options_.limits.maxBytes; }
  Result<Picture> decode(std::span<const std::byte> bytes, const std::string& name);
  Result<EnvironmentFile> fromCubeFile(Result<CubeFile> file, const std::string& name);
  Result<EnvironmentFile> fromPicture(Picture picture, const std::string& name);
  Result<EnvironmentFile> fromStack(const Picture& picture, const std::string& name);
  Result<EnvironmentFile> fromFolder(const fs::path& folder);
  Result<CubeLevel> readLevel(std::span<const fs::path> faces, Metadata* texts);

  const EnvironmentFileOptions& options_;
  Report& report_;
  std::unique_ptr<ImageDecoder> own_;
};

Result<Reader::Picture> Reader::decode(std::span<const std::byte> bytes, const std::string& name) {
  if (!options_.decoder && !own_) own_ = makeDecoderPool();
  ImageDecoder& decoder = options_.decoder ? *options_.decoder : *own_;
  Picture picture;
  picture.texts = exrTexts(bytes);
  if (valueOf(picture.texts, "envmap") == "cube")
    return fail(name, "is OpenEXR's own kind of cube map, whose texels lie on the edges of the faces", "convert it to a lat-long picture (exrenvmap -l) or a cross");
  auto image = decoder.decode(bytes, name, options_.limits);
  if (!image) return fail(image.error());
  if (image->width < 1 || image->height < 1 || image->channels < 1) return fail(name, "the picture has no pixels", "export it again");
  picture.was8 = image->type == PixelType::U8 || image->type == PixelType::U16;
  picture.rgb = linearRgb(std::move(*image));
  return picture;
}

Result<EnvironmentFile> Reader::fromCubeFile(Result<CubeFile> file, const std::string& name) {
  if (!file) return fail(file.error());
  if (file->linear8) report_.warn(name, "its 8-bit texels are taken for linear light, as the format says (UNORM, not SRGB)");
  return EnvironmentFile{std::move(file->cube), {}, std::move(file->format), std::move(file->writer)};
}

Result<EnvironmentFile> Reader::fromStack(const Picture& picture, const std::string& name) {
  auto cube = cubeFromStackedStrips(picture.rgb);
  if (!cube) return fail(name, fmt::format("says that it holds stacked levels, but is {} x {} pixels", picture.rgb.width, picture.rgb.height), "prefilter the environment again");
  if (auto ok = applyMetadata(*cube, picture.texts, name); !ok) return fail(ok.error());
  return EnvironmentFile{std::move(*cube), {}, "OpenEXR, levels stacked in one picture", std::string(valueOf(picture.texts, "software"))};
}

Result<EnvironmentFile> Reader::fromPicture(Picture picture, const std::string& name) {
  if (valueOf(picture.texts, "BurnishLayout") == "levels") return fromStack(picture, name);
  const int width = picture.rgb.width, height = picture.rgb.height;
  const auto layout = pictureLayout(width, height);
  if (!layout)
    return fail(name, fmt::format("is {} x {} pixels: neither a lat-long picture (2:1), a cross (4:3, 3:4) nor a strip (6:1, 1:6)", width, height), "crop or convert it to one of these shapes");
  EnvironmentFile out;
  out.layout = fmt::format("{} of {} x {}{}", layoutName(*layout), width, height, picture.was8 ? ", sRGB" : "");
  if (*layout == PictureLayout::LatLong) {
    out.latLong = std::move(picture.rgb);
    return out;
  }
  if (crossHasContent(picture.rgb, *layout)) report_.warn(name, fmt::format("is taken for a {} because of its shape, but its corners, which belong to no face, are not empty", layoutName(*layout)));
  out.cube.levels.push_back(cubeFromPicture(picture.rgb, *layout));
  return out;
}

Result<CubeLevel> Reader::readLevel(std::span<const fs::path> faces, Metadata* texts) {
  CubeLevel level;
  for (std::size_t face = 0; face < 6; ++face) {
    const std::string name = faces[face].string();
    auto bytes = core::readFile(faces[face], mostFileBytes());
    if (!bytes) return fail(bytes.error());
    auto picture = decode(*bytes, name);
    if (!picture) return fail(picture.error());
    const Image& rgb = picture->rgb;
    if (rgb.width != rgb.height) return fail(name, fmt::format("is {} x {} pixels, a face of a cube is square", rgb.width, rgb.height), "crop it, or give a single picture");
    if (face == 0) {
      if (auto ok = checkCubeLimits(rgb.width, 1, options_.limits, name); !ok) return fail(ok.error());
      level = makeLevel(rgb.width, 0);
      if (texts) *texts = picture->texts;
    }
    if (rgb.width != level.size) return fail(name, fmt::format("is {} pixels wide, the face +X is {}", rgb.width, level.size), "give six faces of one size");
    if (texts)
      for (const std::string_view key : {"BurnishLobe", "BurnishRoughness", "BurnishVersion", "BurnishLevel"})
        if (valueOf(picture->texts, key) != valueOf(*texts, key))
          return fail(name, fmt::format("its {} is not that of {}: the files are of two sets", key, faces[0].filename().string()), "write the whole set again");
    copyFace(rgb, 0, 0, false, level, face);
  }
  return level;
}

Result<EnvironmentFile> Reader::readFaces(std::span<const fs::path> faces) {
  auto level = readLevel(faces, nullptr);
  if (!level) return fail(level.error());
  EnvironmentFile out;
  out.layout = fmt::format("six files of {} x {}", level->size, level->size);
  out.cube.levels.push_back(std::move(*level));
  return out;
}

Result<EnvironmentFile> Reader::fromFolder(const fs::path& folder) {
  const auto found = facesOfFolder(folder);
  if (!found) return fail(found.error());
  EnvironmentFile out;
  Metadata first;
  for (std::size_t k = 0; k < found->levels.size(); ++k) {
    Metadata texts;
    auto level = readLevel(found->levels[k], &texts);
    if (!level) return fail(level.error());
    const std::string& name = found->levels[k][0].string();
    if (k == 0) {
      first = texts;
      if (auto ok = checkCubeLimits(level->size, static_cast<int>(found->levels.size()), options_.limits, name); !ok) return fail(ok.error());
    }
    if (const int expected = levelSize(k == 0 ? level->size : out.cube.levels[0].size, static_cast<int>(k)); level->size != expected)
      return fail(name, fmt::format("is {} pixels wide, level {} has {}", level->size, k, expected), "write the whole set again");
    if (valueOf(texts, "BurnishRoughness") != valueOf(first, "BurnishRoughness") || valueOf(texts, "BurnishLobe") != valueOf(first, "BurnishLobe") ||
        (!first.empty() && !valueOf(first, "BurnishLevel").empty() && valueOf(texts, "BurnishLevel") != std::to_string(k)))
      return fail(name, "is of another set of faces than level 0", "write the whole set again");
    out.cube.levels.push_back(std::move(*level));
  }
  if (auto ok = applyMetadata(out.cube, first, folder.string()); !ok) return fail(ok.error());
  out.layout = fmt::format("folder with six files {}", out.cube.levels.size() > 1 ? "a level" : fmt::format("of {0} x {0}", out.cube.levels[0].size));
  out.writer = valueOf(first, "software");
  return out;
}

Result<EnvironmentFile> Reader::read(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return fromFolder(file);
  if (file.filename().native().find("%s") != std::string::npos && !fs::exists(file, ignored)) {
    const auto faces = facesOfPattern(file);
    if (!faces) return fail(faces.error());
    return readFaces(*faces);
  }
  auto bytes = core::readFile(file, mostFileBytes());
  if (!bytes) return fail(bytes.error());
  const std::string name = file.string();
  if (isDds(*bytes)) return fromCubeFile(decodeDds(*bytes, name, options_.limits), name);
  if (isKtx2(*bytes)) return fromCubeFile(decodeKtx2(*bytes, name, options_.limits), name);
  if (!pictureFormat(*bytes))
    return fail(name, bytes->empty() ? "is empty" : "is no DDS, KTX2, Radiance HDR, OpenEXR, PNG or JPEG file", "convert it to one of these formats");
  auto picture = decode(*bytes, name);
  if (!picture) return fail(picture.error());
  bytes->clear(), bytes->shrink_to_fit();
  return fromPicture(std::move(*picture), name);
}

struct Mended {
  std::size_t notANumber = 0, negative = 0, infinite = 0;
  std::size_t first = 0;  ///< index of the first such value
  [[nodiscard]] std::size_t count() const { return notANumber + negative + infinite; }
};

void mend(std::span<float> values, Mended& mended) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    float& v = values[i];
    if (v >= 0 && v <= std::numeric_limits<float>::max()) continue;
    if (mended.count() == 0) mended.first = i;
    if (std::isnan(v)) ++mended.notANumber, v = 0;
    else if (v < 0) ++mended.negative, v = 0;
    else ++mended.infinite, v = kHalfMax;
  }
}

void mend(std::span<float> values, const std::string& place, Report& report, const std::function<std::string(std::size_t)>& where) {
  Mended mended;
  mend(values, mended);
  if (mended.count() == 0) return;
  report.warn(place, fmt::format("{} values were mended: {} not a number and {} negative became 0, {} infinite became {}; the first is in {}", mended.count(), mended.notANumber, mended.negative,
                                 mended.infinite, kHalfMax, where(mended.first)));
}

void mend(EnvironmentFile& file, const std::string& place, Report& report) {
  if (!file.latLong.empty()) {
    const auto width = static_cast<std::size_t>(file.latLong.width);
    mend({file.latLong.f32(), file.latLong.pixelCount() * 3}, place, report, [&](std::size_t i) { return fmt::format("column {}, row {}", i / 3 % width, i / 3 / width); });
  }
  for (std::size_t k = 0; k < file.cube.levels.size(); ++k) {
    CubeLevel& level = file.cube.levels[k];
    const auto size = static_cast<std::size_t>(level.size);
    mend(level.texels, place, report, [&](std::size_t i) { return fmt::format("level {}, face {}, column {}, row {}", k, kSigned[i / 3 / size / size], i / 3 % size, i / 3 / size % size); });
  }
}

}  // namespace
}  // namespace image

Result<EnvironmentFile> readEnvironment(std::span<const std::filesystem::path> files, Report& report, const EnvironmentFileOptions& options) {
  if (files.size() != 1 && files.size() != 6) return fail(files.empty() ? "" : files[0].string(), fmt::format("{} files are no cube", files.size()), "give one file or six faces: +X -X +Y -Y +Z -Z");
  const std::string place = files[0].string();
  try {
    image::Reader reader(options, report);
    auto file = files.size() == 1 ? reader.read(files[0]) : reader.readFaces(files);
    if (file && !options.asStored) image::mend(*file, place, report);
    return file;
  } catch (const std::bad_alloc&) {
    return fail(place, "there is not enough memory for it", "make it smaller");
  }
}

Result<EnvironmentFile> readEnvironment(const std::filesystem::path& file, Report& report, const EnvironmentFileOptions& options) { return readEnvironment(std::span(&file, 1), report, options); }

Result<Cubemap> readCubemap(const std::filesystem::path& file, Report& report, const EnvironmentFileOptions& options) {
  auto read = readEnvironment(file, report, options);
  if (!read) return fail(read.error());
  if (!read->isCube()) return fail(file.string(), fmt::format("is a {}, no cubemap", read->layout), "filter it first: burnish prefilter");
  return std::move(read->cube);
}

}  // namespace burnish
