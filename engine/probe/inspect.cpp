// What a folder of probes holds, file by file, and what is wrong with it.
#include <fmt/format.h>

#include "probe/bake.h"
#include "probe/folder.h"
#include "probe/payload.h"

namespace burnish::probe {
namespace {

namespace fs = std::filesystem;

void note(ProbeFolder& out, const Error& error) { out.wrong.push_back(error.place + ": " + error.what); }

void inspectReflections(const fs::path& folder, const Manifest& manifest, ProbeFolder& out) {
  for (const Manifest::Reflection& r : manifest.reflections) {
    ReflectionProbe& p = out.set.reflections.emplace_back(r.probe);
    if (!r.file) continue;
    out.files.push_back({r.file->name, r.file->bytes, r.scale});
    const auto bytes = readPayload(folder, *r.file);
    if (!bytes) {
      note(out, bytes.error());
      continue;
    }
    auto cube = decodeRadiance(*bytes, (folder / r.file->name).string(), r, manifest.lobe);
    if (cube) p.radiance = std::move(*cube);
    else note(out, cube.error());
  }
}

void inspectGrid(const fs::path& folder, const Manifest::Grid& g, ProbeFolder& out) {
  AmbientGrid& grid = out.set.grid.emplace(g.grid);
  for (const auto& [file, decode] : {std::pair(&g.irradiance, &decodeIrradiance), std::pair(&g.distances, &decodeDistances)}) {
    if (!*file) continue;
    out.files.push_back({(*file)->name, (*file)->bytes, 1});
    const auto bytes = readPayload(folder, **file);
    if (!bytes) {
      note(out, bytes.error());
      continue;
    }
    if (auto ok = decode(*bytes, (folder / (*file)->name).string(), grid); !ok) note(out, ok.error());
  }
}

void inspectSet(const fs::path& folder, const Manifest& manifest, ProbeFolder& out) {
  out.writer = manifest.writer;
  inspectReflections(folder, manifest, out);
  if (manifest.grid) inspectGrid(folder, *manifest.grid, out);
  out.set.revision = 1;
  if (!manifest.bake) return;
  out.options = manifest.bake->options.dump();
  out.bounces = manifest.bake->bounces;
  const BounceReport* last = out.bounces.empty() ? nullptr : &out.bounces.back();
  const Json until = manifest.bake->options.value("until", Json()), bounces = manifest.bake->options.value("bounces", Json());
  if (last && until.is_number() && bounces == 0 && !(last->rest <= until.get<double>())) out.wrong.push_back(fmt::format("the estimated rest of the light is {:.3g}, over {:g}", last->rest, until.get<double>()));
}

/// Which shards of the next bounce are there.
std::string partsText(const std::vector<PartRecord>& parts) {
  std::string text;
  for (const PartRecord& p : parts) text += fmt::format("{}{}/{}", text.empty() ? "" : ", ", p.shard + 1, p.shards);
  return text;
}

/// `finished`: the bake whose set is there; none: there is no set, or it cannot be read.
void inspectWork(const Paths& paths, const std::optional<core::Hash128>& finished, bool set, ProbeFolder& out) {
  const StateFolder states(paths.work);
  const auto state = states.state();
  if (!state) return note(out, state.error());
  if (!*state) return;
  const auto joined = states.bounces((*state)->id);
  if (!joined) return note(out, joined.error());
  out.joined = int(joined->size());
  const auto parts = states.parts((*state)->id, out.joined + 1);
  if (!parts) note(out, parts.error());
  Report ignored;
  if (const auto places = readSet(paths.places, ignored); !places) note(out, places.error());
  for (const std::string& name : LightStore(paths.light).damaged()) out.wrong.push_back((paths.light / name).string() + ": is damaged: the next bake with --resume bakes it again");
  if (finished == (*state)->id || (set && out.writer.empty())) return;
  const bool over = !joined->empty() && !wantsMore(reportsOf(*joined), (*state)->stop);
  const std::string done = fmt::format("{} bounces {}{}", joined->size(), over ? "are baked, the set is not written" : "are baked, more are missing", parts && !parts->empty() ? ", of the next one shard " + partsText(*parts) : "");
  out.wrong.push_back(fmt::format("{}: {}: {}", paths.work.string(), out.writer.empty() ? "the bake is not finished" : "the set is outdated: a bake of another scene or with other options was begun", done));
}

}  // namespace
}  // namespace burnish::probe

namespace burnish {

Result<ProbeFolder> inspectProbes(const std::filesystem::path& folder) {
  using namespace probe;
  const Paths paths(folder);
  std::error_code error;
  const bool set = std::filesystem::exists(std::filesystem::symlink_status(folder / kManifestName, error)), work = std::filesystem::exists(paths.work / kLockName, error);
  if (!std::filesystem::is_directory(folder, error)) return fail(folder.string(), "is no folder", "name a folder that burnish bake wrote");
  if (!set && !work) return fail(folder.string(), fmt::format("holds no {}", kManifestName), "name a folder that burnish bake wrote");
  try {
    ProbeFolder out;
    Report report;
    std::optional<core::Hash128> finished;
    if (set) {
      const auto manifest = readManifest(folder, report);
      if (manifest) inspectSet(folder, *manifest, out);
      else note(out, manifest.error());
      if (manifest && manifest->bake) finished = manifest->bake->id;
    }
    for (const Warning& w : report.warnings()) out.wrong.push_back(w.message());
    if (work) inspectWork(paths, finished, set, out);
    return out;
  } catch (const std::bad_alloc&) {
    return fail(folder.string(), "there is not enough memory to read it", "look at it on a machine with more");
  }
}

}  // namespace burnish
