// Reference pictures as OpenEXR files: one part, scan lines, float channels named by layer.
#include <ImfChannelList.h>
#include <ImfCompressionAttribute.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <burnish/measure.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "core/file.h"

namespace burnish {
namespace {

constexpr int kMaxSide = 16384;
constexpr std::uint64_t kMaxBytes = std::uint64_t(1) << 32;

/// A layer and its channels. The picture itself has bare names, so that every viewer shows it.
struct Layer {
  const char* channels[3];
  Image ReferencePicture::*image;
};
constexpr Layer kLayers[] = {{{"R", "G", "B"}, &ReferencePicture::radiance},
                             {{"direct.R", "direct.G", "direct.B"}, &ReferencePicture::direct},
                             {{"albedo.R", "albedo.G", "albedo.B"}, &ReferencePicture::albedo},
                             {{"normal.X", "normal.Y", "normal.Z"}, &ReferencePicture::normal},
                             {{"variance.R", "variance.G", "variance.B"}, &ReferencePicture::variance}};

/// OpenEXR goes back to fill in its table of offsets, so the file is made in memory.
class Writer final : public Imf::OStream {
 public:
  Writer() : Imf::OStream("memory") {}
  void write(const char data[], int count) override {
    const std::size_t end = at_ + std::size_t(count);
    if (end > bytes.size()) bytes.resize(end);
    std::memcpy(bytes.data() + at_, data, std::size_t(count));
    at_ = end;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = std::size_t(position); }
  std::vector<std::byte> bytes;

 private:
  std::size_t at_ = 0;
};

class Reader final : public Imf::IStream {
 public:
  explicit Reader(std::span<const std::byte> bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char out[], int count) override {
    if (count < 0 || std::size_t(count) > bytes_.size() - std::min(at_, bytes_.size())) throw std::runtime_error("the file ends too early");
    std::memcpy(out, bytes_.data() + at_, std::size_t(count));
    at_ += std::size_t(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = std::size_t(position); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

Imf::FrameBuffer frameOf(ReferencePicture& picture) {
  constexpr std::size_t kPixel = 3 * sizeof(float);
  Imf::FrameBuffer frame;
  for (const Layer& layer : kLayers) {
    Image& image = picture.*layer.image;
    for (std::size_t c = 0; c < 3; ++c)
      frame.insert(layer.channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.data.data()) + c * sizeof(float), kPixel, kPixel * std::size_t(image.width)));
  }
  return frame;
}

std::vector<std::byte> encode(const ReferencePicture& picture) {
  Imf::Header header(picture.radiance.width, picture.radiance.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.insert("software", Imf::StringAttribute("burnish " BURNISH_LIBRARY_VERSION));
  header.insert("samples", Imf::IntAttribute(picture.samples));
  header.insert("noise", Imf::DoubleAttribute(picture.error));
  header.insert("seed", Imf::StringAttribute(fmt::format("{}", picture.seed)));
  header.insert("bounces", Imf::IntAttribute(picture.bounces));
  header.insert("pixel", Imf::StringAttribute(picture.pixelArea ? "area" : "centre"));
  if (!picture.scene.empty()) header.insert("scene", Imf::StringAttribute(picture.scene));
  if (!picture.camera.empty()) header.insert("camera", Imf::StringAttribute(picture.camera));
  for (const Layer& layer : kLayers)
    for (const char* name : layer.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Writer stream;
  {
    ReferencePicture written = picture;  // OpenEXR's frame buffers are not const
    Imf::OutputFile out(stream, header, 1);
    out.setFrameBuffer(frameOf(written));
    out.writePixels(picture.radiance.height);
  }  // the destructor writes the table of offsets
  return std::move(stream.bytes);
}

std::string textOf(const Imf::Header& header, const char* name) {
  const auto* a = header.findTypedAttribute<Imf::StringAttribute>(name);
  return a ? a->value() : std::string();
}
template <class A, class T>
T numberOf(const Imf::Header& header, const char* name, T otherwise) {
  const auto* a = header.findTypedAttribute<A>(name);
  return a ? T(a->value()) : otherwise;
}

// What writeReference does not write is refused before a pixel is read: other compressions, tiles, parts, channels' types and sizes. nullptr: it is good.
const char* refused(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t w = std::int64_t(window.max.x) - window.min.x + 1, h = std::int64_t(window.max.y) - window.min.y + 1;
  if (w < 1 || h < 1 || w > kMaxSide || h > kMaxSide) return "its picture has no size, or is larger than 16384 pixels along a side";
  if (header.displayWindow() != window || window.min != Imath::V2i(0, 0)) return "its display and data windows differ";
  if (header.hasTileDescription() || header.compression() != Imf::ZIP_COMPRESSION) return "it is tiled, or not compressed as reference pictures are";
  std::size_t count = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) ++count;
  if (count > 64) return "it has more channels than reference pictures have";
  return nullptr;
}

Result<ReferencePicture> decode(const std::string& place, std::span<const std::byte> bytes) {
  const auto bad = [&](std::string_view what) { return fail(place, std::string(what), "give a file that `burnish reference` wrote"); };
  Reader stream(bytes);
  Imf::InputFile in(stream, 1);
  const Imf::Header& header = in.header();
  if (const char* what = refused(header)) return bad(what);
  for (const Layer& layer : kLayers)
    for (const char* name : layer.channels) {
      const Imf::Channel* c = header.channels().findChannel(name);
      if (!c) return bad(fmt::format("it has no channel '{}'", name));
      if (c->type != Imf::FLOAT || c->xSampling != 1 || c->ySampling != 1) return bad(fmt::format("its channel '{}' is not 32-bit float at every pixel", name));
    }
  const int width = header.dataWindow().max.x + 1, height = header.dataWindow().max.y + 1;
  // ZIP makes things smaller by about a thousand at most: what claims more is not there.
  if (std::uint64_t(width) * std::uint64_t(height) * 60 > std::uint64_t(bytes.size()) * 1200) return bad("it is shorter than its size says");
  ReferencePicture p;
  for (const Layer& layer : kLayers) p.*layer.image = makeImage(width, height, 3, PixelType::F32);
  in.setFrameBuffer(frameOf(p));
  in.readPixels(0, height - 1);
  p.samples = std::max(numberOf<Imf::IntAttribute>(header, "samples", 0), 0);
  p.error = numberOf<Imf::DoubleAttribute>(header, "noise", 0.0);
  p.bounces = numberOf<Imf::IntAttribute>(header, "bounces", -1);
  const std::string seed = textOf(header, "seed");
  std::from_chars(seed.data(), seed.data() + seed.size(), p.seed);
  p.pixelArea = textOf(header, "pixel") != "centre";
  p.scene = textOf(header, "scene");
  p.camera = textOf(header, "camera");
  if (p.samples < 1 || !(p.error >= 0)) return bad("its header does not say how many samples it has, and how much noise");
  return p;
}

}  // namespace

Result<void> writeReference(const std::filesystem::path& file, const ReferencePicture& picture) {
  for (const Layer& layer : kLayers) {
    const Image& image = picture.*layer.image;
    if (image.type != PixelType::F32 || image.channels != 3 || image.width < 1 || image.height < 1 || image.width != picture.radiance.width || image.height != picture.radiance.height ||
        image.data.size() != image.byteSize())
      return fail(file.string(), fmt::format("the picture of '{}' is not float with three channels, or not as large as the others", layer.channels[0]), "give it as traceReference does");
  }
  try {
    return core::writeFileAtomic(file, encode(picture));
  } catch (const std::exception& e) {
    return fail(file.string(), fmt::format("cannot be written as OpenEXR ({})", e.what()), "make the picture smaller");
  }
}

Result<ReferencePicture> readReference(const std::filesystem::path& file) {
  auto bytes = core::readFile(file, kMaxBytes);
  if (!bytes) return fail(bytes.error());
  try {
    return decode(file.string(), *bytes);
  } catch (const std::exception& e) {
    return fail(file.string(), fmt::format("is no OpenEXR file, or damaged ({})", e.what()), "give a file that `burnish reference` wrote");
  }
}

}  // namespace burnish
