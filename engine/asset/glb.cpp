#include "asset/glb.h"

#include <fmt/format.h>

#include <cstdint>

namespace burnish::asset {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr const char* kRemedy = "export the file again";

std::uint32_t u32At(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t v = 0;
  for (int i = 3; i >= 0; --i) v = v << 8 | std::to_integer<std::uint32_t>(bytes[at + std::size_t(i)]);
  return v;
}

}  // namespace

bool isGlb(std::span<const std::byte> file) { return file.size() >= 4 && u32At(file, 0) == kMagic; }

Result<Glb> parseGlb(std::span<const std::byte> file, const std::string& place, Report& report) {
  const auto bad = [&](std::string what) { return fail(place, "damaged GLB: " + std::move(what), kRemedy); };
  if (file.size() < 12) return bad("the header is cut off");
  const std::uint32_t version = u32At(file, 4), length = u32At(file, 8);
  if (version != 2)
    return fail(place, fmt::format("GLB version {} is not supported", version), "convert the file to glTF 2.0");
  if (length < 20) return bad(fmt::format("the header gives a length of {} bytes, too few for a chunk", length));
  if (length > file.size())
    return bad(fmt::format("the header gives a length of {} bytes, the file has {}", length, file.size()));
  if (length < file.size())
    report.warn(place, fmt::format("{} bytes after the end of the GLB are ignored", file.size() - length));
  Glb glb;
  int index = 0;
  for (std::size_t at = 0, next = 12; next < length; ++index) {
    at = next;
    if (length - at < 8) return bad(fmt::format("the header of chunk {} is cut off", index));
    const std::uint32_t bytes = u32At(file, at), type = u32At(file, at + 4);
    if (bytes > length - at - 8) return bad(fmt::format("chunk {} of {} bytes does not fit", index, bytes));
    if (bytes % 4) return bad(fmt::format("the length {} of chunk {} is no multiple of 4", bytes, index));
    const auto body = file.subspan(at + 8, bytes);
    next = at + 8 + bytes;
    if (index == 0 && type != kJson) return bad("the first chunk is not JSON");
    if (index > 0 && type == kJson) return bad("there are two JSON chunks");
    if (type == kBinary && glb.binary) return bad("there are two BIN chunks");
    if (type == kBinary && index != 1) return bad("the BIN chunk is not the second one");
    if (type == kJson)
      glb.json = body;
    else if (type == kBinary)
      glb.binary = body;
    else
      report.warn(place, fmt::format("chunk {} of the unknown type {:#010x} is ignored", index, type));
  }
  if (glb.json.empty()) return bad("the JSON chunk is empty");
  return glb;
}

}  // namespace burnish::asset
