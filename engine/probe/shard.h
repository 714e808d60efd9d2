// One part of one bounce, by one of several processes that share a folder.
#pragma once
#include "probe/bake.h"

namespace burnish::probe {

Result<BakeReport> bakeShard(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, const BakeJob& job, Report& report);
/// work/places: the places as a set without light, for whoever has no scene.
Result<void> writePlaces(const Paths& paths, const ProbeSet& places);

}  // namespace burnish::probe
