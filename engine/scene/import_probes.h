// Places of probes in a file become the scene's (docs/probes.md, "Placing probes").
#pragma once
#include <burnish/scene.h>

#include <span>

#include "asset/asset.h"

namespace burnish::scene {

/// Fills scene.probes from the asset's nodes, whose rows in the scene are `nodes`. None of them is baked.
void importProbes(const asset::Asset& asset, std::span<const Id<Node>> nodes, Scene& scene, Report& report);

}  // namespace burnish::scene
