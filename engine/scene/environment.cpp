// The light of the surroundings from a lat-long picture: linear floats, finite, and small enough for half-float
// targets.
#include <fmt/format.h>

#include <cmath>

#include "core/file.h"
#include "image/convert.h"
#include "scene/load.h"

namespace burnish {
namespace scene {
namespace {

struct Mended {
  std::size_t notANumber = 0, negative = 0, tooLarge = 0;
  float largest = 0;  ///< before clamping, finite ones
  [[nodiscard]] std::size_t count() const { return notANumber + negative + tooLarge; }
};

float mend(float v, Mended& mended) {
  if (std::isnan(v)) {
    ++mended.notANumber;
    return 0;
  }
  if (v < 0) {
    ++mended.negative;
    return 0;
  }
  if (v > image::kHalfMax) {
    ++mended.tooLarge;
    if (std::isfinite(v)) mended.largest = std::max(mended.largest, v);
    return image::kHalfMax;
  }
  return v;
}

}  // namespace

Image environmentMap(const Image& image, const std::string& place, Report& report) {
  Image out = makeImage(image.width, image.height, 3, PixelType::F32);
  const std::size_t pixels = image.pixelCount();
  const std::size_t channels = std::size_t(image.channels);
  Mended mended;
  const Image source = image::toLinear(image);
  float* to = out.f32();
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) *to++ = mend(source.f32()[i * channels + (channels >= 3 ? c : 0)], mended);
  if (mended.count())
    report.warn(place, fmt::format("{} values were mended: {} not a number and {} negative became 0, {} above {} "
                                   "(largest {:g}) were held there",
                                   mended.count(), mended.notANumber, mended.negative, mended.tooLarge, image::kHalfMax,
                                   mended.largest));
  return out;
}

Result<void> decodeEnvironment(Scene& scene, std::span<const std::byte> file, const std::string& place,
                               ImageDecoder& decoder, Report& report) {
  auto image = decoder.decode(file, place);
  if (!image) return fail(image.error());
  if (image->width < 1 || image->height < 1 || image->channels < 1)
    return fail(place, "the picture has no pixels", "give a lat-long picture (HDR or EXR)");
  if (image->width != 2 * image->height)
    report.warn(place,
                fmt::format("is {}x{}, not twice as wide as high: it is taken for a lat-long picture all the same",
                            image->width, image->height));
  scene.environment.map = environmentMap(*image, place, report);
  ++scene.environment.revision;
  return {};
}

}  // namespace scene

Result<void> loadEnvironment(Scene& scene, const std::filesystem::path& file, const LoadOptions& options,
                             Report& report) {
  auto bytes = core::readFile(file, options.maxFileBytes);
  if (!bytes) return fail(bytes.error());
  std::unique_ptr<ImageDecoder> own;
  if (!options.decoder) own = makeDecoderPool();
  return scene::decodeEnvironment(scene, *bytes, file.filename().string(), options.decoder ? *options.decoder : *own,
                                  report);
}

}  // namespace burnish
