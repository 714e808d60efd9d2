#include <fmt/format.h>

#include "core/file.h"
#include "probe/folder.h"
#include "probe/payload.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

Result<std::vector<std::byte>> manifestBytes(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) return fail(folder.string(), "there is no such folder", "name a folder that burnish bake wrote");
  if (!fs::is_directory(status)) return fail(folder.string(), "is no folder", "name a folder that burnish bake wrote");
  if (!fs::exists(fs::symlink_status(folder / kManifestName, error))) return fail(folder.string(), fmt::format("holds no {}", kManifestName), "name a folder with a finished bake");
  auto bytes = core::readFileInside(folder, kManifestName, false, kMostManifestBytes);
  if (!bytes) return fail((folder / kManifestName).string(), bytes.error().what, bytes.error().remedy);
  return bytes;
}

Result<void> readReflections(const fs::path& folder, StoredSet& out) {
  std::uint64_t decoded = 0;
  for (const Manifest::Reflection& r : out.manifest.reflections) {
    ReflectionProbe& p = out.set.reflections.emplace_back(r.probe);
    if (!r.file) continue;
    decoded += 6ull * 12 * 4 / 3 * std::uint64_t(r.size) * std::uint64_t(r.size);
    if (decoded > kMostDecodedBytes) return fail(folder.string(), fmt::format("its cubes take more than {} bytes", kMostDecodedBytes), "bake fewer or smaller probes");
    const auto bytes = readPayload(folder, *r.file);
    if (!bytes) return fail(bytes.error());
    auto cube = decodeRadiance(*bytes, (folder / r.file->name).string(), r, out.manifest.lobe);
    if (!cube) return fail(cube.error());
    p.radiance = std::move(*cube);
  }
  return {};
}

Result<void> readGrid(const fs::path& folder, StoredSet& out) {
  const Manifest::Grid& g = *out.manifest.grid;
  AmbientGrid& grid = out.set.grid.emplace(g.grid);
  for (const auto& [file, decode] : {std::pair(&g.irradiance, &decodeIrradiance), std::pair(&g.distances, &decodeDistances)}) {
    if (!*file) continue;
    const auto bytes = readPayload(folder, **file);
    if (!bytes) return fail(bytes.error());
    if (auto ok = decode(*bytes, (folder / (*file)->name).string(), grid); !ok) return ok;
  }
  return {};
}

Result<StoredSet> readOnce(const fs::path& folder, std::span<const std::byte> text, Report& report) {
  StoredSet out;
  auto manifest = parseManifest(text, (folder / kManifestName).string(), report);
  if (!manifest) return fail(manifest.error());
  out.manifest = std::move(*manifest);
  if (auto ok = readReflections(folder, out); !ok) return fail(ok.error());
  if (out.manifest.grid)
    if (auto ok = readGrid(folder, out); !ok) return fail(ok.error());
  out.set.revision = 1;
  return out;
}

}  // namespace

Result<std::vector<std::byte>> readPayload(const fs::path& folder, const FileEntry& file) {
  const std::string name = (folder / file.name).string();
  auto bytes = core::readFileInside(folder, file.name, false, file.bytes);
  if (!bytes) return fail(name, bytes.error().what, "restore the file, or bake again");
  if (bytes->size() != file.bytes) return fail(name, fmt::format("is {} bytes long, the manifest says {}", bytes->size(), file.bytes), "restore the file, or bake again");
  if (const core::Hash128 hash = core::hashOf(*bytes); hash != file.hash)
    return fail(name, fmt::format("is damaged: its XXH3-128 is {}, the manifest says {}", hash.hex(), file.hash.hex()), "restore the file, or bake again");
  return bytes;
}

Result<Manifest> readManifest(const fs::path& folder, Report& report) {
  const auto text = manifestBytes(folder);
  if (!text) return fail(text.error());
  return parseManifest(*text, (folder / kManifestName).string(), report);
}

Result<StoredSet> readSet(const fs::path& folder, Report& report) {
  auto text = manifestBytes(folder);
  if (!text) return fail(text.error());
  // A bake may put a new set in place meanwhile, whose manifest names other files.
  for (int tries = 0;; ++tries) {
    auto read = readOnce(folder, *text, report);
    if (read || tries == 3) return read;
    auto again = manifestBytes(folder);
    if (!again || *again == *text) return read;
    text = std::move(again);
  }
}

}  // namespace burnish::probe

namespace burnish {

Result<ProbeSet> readProbes(const std::filesystem::path& folder, Report& report) {
  try {
    auto read = probe::readSet(folder, report);
    if (!read) return fail(read.error());
    return std::move(read->set);
  } catch (const std::bad_alloc&) {
    return fail(folder.string(), "there is not enough memory to read it", "bake fewer or smaller probes");
  }
}

}  // namespace burnish
