#include <burnish/decode_inprocess.h>

#include "oiio_decode.h"

namespace burnish {
namespace {

class InProcessDecoder final : public ImageDecoder {
 public:
  InProcessDecoder() { decode::prepareOpenImageIo(); }

  Result<Image> decode(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) override {
    Image image;
    const auto place = [&](const decode::Decoded&, std::size_t bytes) {
      image.data.resize(bytes);
      return image.data.data();
    };
    auto decoded = decode::decodePicture(file, name, limits, place);
    if (!decoded) return fail(decoded.error());
    image.width = decoded->width;
    image.height = decoded->height;
    image.channels = decoded->channels;
    image.type = decoded->type;
    return image;
  }
};

}  // namespace

std::unique_ptr<ImageDecoder> makeInProcessDecoder() { return std::make_unique<InProcessDecoder>(); }

}  // namespace burnish
