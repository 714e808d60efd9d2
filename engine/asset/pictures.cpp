#include "asset/pictures.h"

#include <fmt/format.h>

#include "asset/uri.h"
#include "core/file.h"

namespace burnish::asset {
namespace {

constexpr TextureRef Material::*kSlots[] = {
    &Material::baseColorTexture,     &Material::metallicRoughnessTexture, &Material::normalTexture,
    &Material::occlusionTexture,     &Material::emissiveTexture,          &Material::specularTexture,
    &Material::specularColorTexture, &Material::diffuseTexture,           &Material::specularGlossinessTexture};

std::string imagePath(std::size_t i, const char* member = "") { return fmt::format("/images/{}{}", i, member); }

std::vector<bool> usedPictures(const Document& doc) {
  std::vector<bool> used(doc.pictures.size());
  for (const Material& m : doc.materials)
    for (const auto slot : kSlots)
      if (const TextureRef& ref = m.*slot)
        if (const int picture = doc.textures[std::size_t(ref.texture)].picture; picture >= 0)
          used[std::size_t(picture)] = true;
  return used;
}

// A name inside the folder that nothing stands behind. Everything else that cannot be resolved is a refusal: told apart
// by asking again without the guard, and by looking whether something is there that is no file.
bool isMissing(const Source& source, const std::string& uri, const Error& refusal) {
  if (uriKind(uri) != UriKind::Relative) return false;
  const std::string name = percentDecoded(uri);
  std::error_code ignored;
  const auto status = std::filesystem::status(source.folder / name, ignored);
  if (name.find('\0') != name.npos || status.type() != std::filesystem::file_type::not_found) return false;
  const auto unguarded = core::resolveInside(source.folder, uri, true);
  return !unguarded && unguarded.error().what == refusal.what;
}

// The canonical path of a picture's file; empty when there is none (a warning where the picture is used).
std::filesystem::path resolve(Check& check, const Source& source, const std::string& uri, std::size_t index,
                              bool used) {
  if (uriKind(uri) == UriKind::Invalid)
    check.fail(imagePath(index, "/uri"), fmt::format("'{}' is no URI", uri.substr(0, 80)));
  if (!used && uri.starts_with("http"))
    check.warn(imagePath(index, "/uri"), "nothing is fetched from a network; the picture is not used");
  if (!check.ok() || (!used && uri.starts_with("http"))) return {};
  auto path = core::resolveInside(source.folder, uri, source.allowOutside);
  if (path) return std::move(*path);
  const Error& e = path.error();
  if (!isMissing(source, uri, e))
    check.fail(imagePath(index, "/uri"), e.place + ": " + e.what, e.remedy);
  else if (used)
    check.warn(imagePath(index), fmt::format("picture {} was not found: materials go on without it", e.place));
  return {};
}

class Loader {
 public:
  Loader(Check& check, const Document& doc, Source& source, ImageDecoder& decoder)
      : check_(check), doc_(doc), source_(source), decoder_(decoder) {}

  void load(std::size_t index, bool used, Picture& out) {
    const PictureSource& p = doc_.pictures[index];
    out.name = p.name;
    if (p.view >= 0) {
      const auto bytes = bytesOf(doc_, p.view);
      if (used && bytes.empty())
        check_.warn(imagePath(index), "the picture's buffer has no data: materials go on without it");
      if (used && !bytes.empty()) decode(index, bytes, out);
    } else if (uriKind(*p.uri) == UriKind::Data) {
      auto data = decodeDataUri(*p.uri);
      if (!data) return check_.fail(imagePath(index, "/uri"), data.error().what);
      if (used) decode(index, data->bytes, out);
    } else {
      const auto file = resolve(check_, source_, *p.uri, index, used);
      if (used && check_.ok() && !file.empty()) loadFile(index, file, out);
    }
  }

 private:
  void loadFile(std::size_t index, const std::filesystem::path& file, Picture& out) {
    auto bytes =
        core::readFileInside(source_.folder, *doc_.pictures[index].uri, source_.allowOutside, source_.bytesLeft);
    if (!bytes)
      return check_.warn(imagePath(index), fmt::format("picture {}: {}: materials go on without it",
                                                       file.filename().string(), bytes.error().what));
    source_.bytesLeft -= bytes->size();
    decode(index, *bytes, out);
  }

  void decode(std::size_t index, std::span<const std::byte> bytes, Picture& out) {
    DecodeLimits limits;
    limits.maxBytes = std::min(limits.maxBytes, decodedLeft_);
    auto image = decoder_.decode(bytes, out.name, limits);
    if (!image)
      return check_.warn(imagePath(index), fmt::format("picture {} cannot be used: {}: materials go on without it",
                                                       out.name, image.error().what));
    decodedLeft_ -= std::min<std::uint64_t>(decodedLeft_, image->byteSize());
    out.pixels = std::move(*image);
  }

  Check& check_;
  const Document& doc_;
  Source& source_;
  ImageDecoder& decoder_;
  std::uint64_t decodedLeft_ = std::uint64_t(8) << 30;  // pixels of all pictures together, bytes
};

}  // namespace

std::vector<Picture> loadPictures(Check& check, const Document& doc, Source& source, ImageDecoder& decoder) {
  std::vector<Picture> out(doc.pictures.size());
  const std::vector<bool> used = usedPictures(doc);
  Loader loader(check, doc, source, decoder);
  for (std::size_t i = 0; check.ok() && i < out.size(); ++i) loader.load(i, used[i], out[i]);
  return out;
}

void dropMissingTextures(Check& check, std::vector<Material>& materials, const std::vector<Texture>& textures,
                         const std::vector<Picture>& pictures) {
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const auto slot : kSlots) {
      TextureRef& ref = materials[i].*slot;
      if (!ref) continue;
      const int picture = textures[std::size_t(ref.texture)].picture;
      if (picture >= 0 && !pictures[std::size_t(picture)].pixels.empty()) continue;
      if (picture < 0)
        check.warn(fmt::format("/textures/{}", ref.texture),
                   "the texture has no picture that can be read: materials go on without it");
      ref.texture = -1;
    }
}

}  // namespace burnish::asset
