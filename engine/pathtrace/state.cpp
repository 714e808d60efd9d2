#include "pathtrace/state.h"

#include <cstring>
#include <system_error>

#include "core/file.h"
#include "scene/scene_hash.h"
#include "scene/visibility.h"

namespace burnish::pathtrace {
namespace {

using core::Hash128;
using core::Hasher;

/// In front of the pixels; the hash of all before it comes last.
struct Header {
  char magic[8] = {'B', 'U', 'R', 'N', 'R', 'E', 'F', '\n'};
  std::uint32_t version = 1;
  std::int32_t width = 0, height = 0, samples = 0;
  std::uint64_t dropped = 0;
  Hash128 key;
};
static_assert(sizeof(Header) == 48);

tl::unexpected<Error> damaged(const std::filesystem::path& file, const char* what) { return fail(file.string(), what, "remove it and begin again, or name another file"); }

}  // namespace

Hash128 keyOf(const Scene& scene, const View& view, const shading::Rungs& rungs, const ReferenceOptions& options) {
  Hasher h;
  scene::Derived derived;
  derived.update(scene);
  scene::SceneHashes hashes(scene);
  scene::eachPlaced(scene, derived, glm::dvec3(0), [&](const scene::Placed& p) { h.hash(hashes.look(p)); });
  scene.lights.each([&](Id<Light>, const Light& light) { h.hash(hashes.light(light)); });
  h.hash(scene::hashOf(scene.environment)), h.hash(scene::hashOf(scene.fog));
  for (int i = 0; i < 3; ++i) {
    h.value(view.eye[i]);
    for (int k = 0; k < 3; ++k) h.value(view.axes[i][k]);
  }
  h.value(view.orthographic), h.value(view.fovY), h.value(view.height), h.value(view.near), h.value(view.far);
  for (const int rung : {rungs.specular, rungs.distribution, rungs.geometry, rungs.normalization, rungs.lobe, rungs.fresnel, rungs.diffuse, rungs.compensation, rungs.anisotropic, rungs.roughDiffuse})
    h.value(rung);
  h.value(options.size.x), h.value(options.size.y), h.value(options.seed), h.value(options.bounces < 0 ? -1 : options.bounces), h.value(options.pixelArea);
  return h.finish();
}

Result<void> writeState(const std::filesystem::path& file, const Hash128& key, const Film& film) {
  Header header;
  header.width = film.size().x;
  header.height = film.size().y;
  header.samples = film.samples;
  header.dropped = film.dropped;
  header.key = key;
  const std::span<const std::byte> pixels = std::as_bytes(film.pixels());
  std::vector<std::byte> bytes(sizeof header + pixels.size() + sizeof(Hash128));
  std::memcpy(bytes.data(), &header, sizeof header);
  std::memcpy(bytes.data() + sizeof header, pixels.data(), pixels.size());
  const Hash128 seal = core::hashOf(std::span(bytes).first(bytes.size() - sizeof(Hash128)));
  std::memcpy(bytes.data() + bytes.size() - sizeof seal, &seal, sizeof seal);
  return core::writeFileAtomic(file, bytes);
}

Result<bool> readState(const std::filesystem::path& file, const Hash128& key, Film& film) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) return false;
  const std::size_t pixels = film.pixels().size() * sizeof(Pixel), size = sizeof(Header) + pixels + sizeof(Hash128);
  auto bytes = core::readFile(file, std::uint64_t(1) << 36);
  if (!bytes) return fail(bytes.error());
  Header header;
  const Header good;
  if (bytes->size() < sizeof header + sizeof(Hash128)) return damaged(file, "is no state of a reference picture");
  std::memcpy(&header, bytes->data(), sizeof header);
  if (std::memcmp(header.magic, good.magic, sizeof good.magic) != 0 || header.version != good.version) return damaged(file, "is no state of a reference picture, or of another version");
  Hash128 seal;
  std::memcpy(&seal, bytes->data() + bytes->size() - sizeof seal, sizeof seal);
  if (core::hashOf(std::span(*bytes).first(bytes->size() - sizeof seal)) != seal) return damaged(file, "is damaged: its contents do not have its checksum");
  if (header.key != key || header.width != film.size().x || header.height != film.size().y || bytes->size() != size || header.samples < 0)
    return fail(file.string(), "is the state of another picture: scene, camera, size, rungs, seed, bounces or the place of samples in a pixel differ", "give the same options, or name another file");
  std::memcpy(film.pixels().data(), bytes->data() + sizeof header, pixels);
  film.samples = header.samples;
  film.dropped = header.dropped;
  return true;
}

}  // namespace burnish::pathtrace
