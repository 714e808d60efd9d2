#include "asset/buffers.h"

#include <fmt/format.h>

#include "asset/uri.h"
#include "core/file.h"

namespace burnish::asset {
namespace {

// A buffer's file may be longer than byteLength (glTF 2.0, section 3.6.1.1), but not by any amount: it would be read in
// vain.
constexpr std::uint64_t kTail = 16 * 1024 * 1024;

void keep(Check& check, Buffer& b, const std::string& path) {
  if (b.owned.size() < b.byteLength)
    return check.fail(path, fmt::format("byteLength is {}, the data are {} bytes", b.byteLength, b.owned.size()));
  b.owned.resize(b.byteLength);
  b.bytes = b.owned;
}

void loadFile(Check& check, Buffer& b, Source& source, const std::string& path) {
  const std::uint64_t most = std::min(source.bytesLeft, b.byteLength + kTail);
  auto bytes = core::readFileInside(source.folder, *b.uri, source.allowOutside, most);
  if (!bytes) {
    const Error& e = bytes.error();
    return check.fail(path + "/uri", fmt::format("{}: {} (byteLength is {})", e.place, e.what, b.byteLength), e.remedy);
  }
  source.bytesLeft -= bytes->size();
  b.owned = std::move(*bytes);
  keep(check, b, path);
}

void loadData(Check& check, Buffer& b, const std::string& path) {
  auto data = decodeDataUri(*b.uri);
  if (!data) return check.fail(path + "/uri", data.error().what);
  if (data->mediaType != "application/octet-stream" && data->mediaType != "application/gltf-buffer")
    return check.fail(path + "/uri", fmt::format("media type '{}' is not that of a buffer", data->mediaType),
                      "use application/octet-stream");
  b.owned = std::move(data->bytes);
  keep(check, b, path);
}

void loadChunk(Check& check, Buffer& b, const Source& source, const std::string& path) {
  const auto chunk = source.glbChunk;
  if (!chunk) return check.fail(path, "the file has no binary chunk for this buffer");
  if (chunk->size() < b.byteLength)
    return check.fail(path,
                      fmt::format("byteLength is {}, the binary chunk has {} bytes", b.byteLength, chunk->size()));
  if (chunk->size() > b.byteLength + 3)
    check.warn(path, fmt::format("the binary chunk is {} bytes longer than the buffer", chunk->size() - b.byteLength));
  b.bytes = chunk->first(b.byteLength);
}

}  // namespace

void loadBuffers(Check& check, Document& doc, Source& source) {
  const bool glb = source.glbChunk.has_value();
  for (std::size_t i = 0; check.ok() && i < doc.buffers.size(); ++i) {
    Buffer& b = doc.buffers[i];
    const std::string path = fmt::format("/buffers/{}", i);
    if (!b.uri) {
      if (i == 0 && glb) loadChunk(check, b, source, path);
      continue;  // a placeholder; whoever needs its data says so
    }
    switch (uriKind(*b.uri)) {
      case UriKind::Data:
        loadData(check, b, path);
        break;
      case UriKind::Relative:
        loadFile(check, b, source, path);
        break;
      case UriKind::Invalid:
        check.fail(path + "/uri", fmt::format("'{}' is no URI", b.uri->substr(0, 80)));
        break;
      case UriKind::Remote:
        if (b.used || !b.uri->starts_with("http"))
          loadFile(check, b, source, path);  // refused there
        else
          check.warn(path + "/uri", "nothing is fetched from a network; the buffer is not used");
    }
  }
}

std::span<const std::byte> bytesOf(const Document& doc, int view) {
  const BufferView& v = doc.views[std::size_t(view)];
  const auto bytes = doc.buffers[std::size_t(v.buffer)].bytes;
  return bytes.empty() ? bytes : bytes.subspan(v.offset, v.length);
}

}  // namespace burnish::asset
