// The bytes behind buffers and pictures: GLB chunk, data URI or file, the latter only from inside the asset's folder.
#pragma once
#include "asset/document.h"

namespace burnish::asset {

/// Where an asset's bytes may come from, and how many of them.
struct Source {
  std::filesystem::path folder;
  bool allowOutside = false;
  std::uint64_t bytesLeft = 0;                         ///< of all files together; falls with every one that is read
  std::optional<std::span<const std::byte>> glbChunk;  ///< buffer 0 without a uri
};

/// Fills Buffer::bytes of every buffer. Buffers that cannot be read are faults at their path, except remote ones that
/// nothing uses (a warning).
void loadBuffers(Check& check, Document& doc, Source& source);

/// Bytes of the buffer view, or none when its buffer has no data.
std::span<const std::byte> bytesOf(const Document& doc, int view);

}  // namespace burnish::asset
