#include <burnish/decode_inprocess.h>

#include "oiio_decode.h"

namespace burnish {
namespace {

struct VectorSink final : decode::PixelSink {
  std::vector<std::byte> pixels;
  std::size_t filled = 0;
  bool begin(const decode::Decoded&, std::size_t bytes) override {
    pixels.resize(bytes);
    return true;
  }
  std::span<std::byte> room() override { return std::span(pixels).subspan(filled); }
  bool commit(std::size_t bytes) override {
    filled += bytes;
    return true;
  }
};

class InProcessDecoder final : public ImageDecoder {
 public:
  InProcessDecoder() { decode::prepareOpenImageIo(); }

  [[nodiscard]] int concurrency() const override { return 2; }
  Result<Image> decode(std::span<const std::byte> file, std::string_view name, const DecodeLimits& limits) override {
    VectorSink sink;
    auto decoded = decode::decodePicture(file, name, limits, sink);
    if (!decoded) return fail(decoded.error());
    return Image{decoded->width, decoded->height, decoded->channels, decoded->type, std::move(sink.pixels)};
  }
};

}  // namespace

std::unique_ptr<ImageDecoder> makeInProcessDecoder() { return std::make_unique<InProcessDecoder>(); }

}  // namespace burnish
