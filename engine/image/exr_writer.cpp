#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>

#include "core/file.h"
#include "image/encode.h"

namespace burnish {
namespace image {
namespace {

/// OpenEXR goes back to fill in its table of offsets, so the file is made in memory.
class MemoryStream final : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const std::size_t end = at_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + at_, bytes, static_cast<std::size_t>(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = static_cast<std::size_t>(position); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

std::vector<std::byte> encode(const Image& image, std::span<const std::pair<std::string, std::string>> attributes) {
  constexpr const char* kNames[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  const Imf::PixelType type = image.type == PixelType::F16 ? Imf::HALF : Imf::FLOAT;
  const auto sample = static_cast<std::size_t>(bytesPerChannel(image.type));
  const std::size_t pixel = sample * static_cast<std::size_t>(image.channels);
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
  Imf::FrameBuffer frame;
  for (int c = 0; c < image.channels; ++c) {
    const char* name = kNames[image.channels - 1][c];
    header.channels().insert(name, Imf::Channel(type));
    auto* first = reinterpret_cast<char*>(const_cast<std::byte*>(image.data.data())) +
                  sample * static_cast<std::size_t>(c);  // only read
    frame.insert(name, Imf::Slice(type, first, pixel, pixel * static_cast<std::size_t>(image.width)));
  }
  MemoryStream stream;
  {
    Imf::OutputFile out(stream, header, 0);
    out.setFrameBuffer(frame);
    out.writePixels(image.height);
  }  // the destructor writes the table of offsets
  return stream.take();
}

}  // namespace

Result<std::vector<std::byte>> encodeExr(const Image& image, std::string_view place,
                                         std::span<const std::pair<std::string, std::string>> attributes) {
  if ((image.type != PixelType::F16 && image.type != PixelType::F32) || image.channels < 1 || image.channels > 4)
    return fail(std::string(place), "only half and float pictures of 1 to 4 channels can be written as OpenEXR",
                "convert it first, or write PNG");
  if (image.width <= 0 || image.height <= 0 || image.data.size() != image.byteSize())
    return fail(std::string(place),
                fmt::format("a picture of {} x {} pixels with {} bytes cannot be written", image.width, image.height,
                            image.data.size()),
                "draw something first");
  try {
    return encode(image, attributes);
  } catch (const std::exception& e) {
    return fail(std::string(place), fmt::format("cannot be written as OpenEXR ({})", e.what()),
                "make the picture smaller");
  }
}

}  // namespace image

Result<void> writeExr(const std::filesystem::path& file, const Image& image) {
  auto bytes = image::encodeExr(image, file.string());
  if (!bytes) return fail(bytes.error());
  return core::writeFileAtomic(file, *bytes);
}

}  // namespace burnish
