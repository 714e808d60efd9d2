// The filter of prefilterCubemap() for any list of levels.
#pragma once
#include <burnish/image.h>

#include <span>
#include <vector>

#include "prefilter/source.h"

namespace burnish::prefilter {

struct LevelSpec {
  int size = 0;          ///< at least 1
  double roughness = 0;  ///< in (0, 1]
};

struct FilterOptions {
  ReflectionLobe lobe = ReflectionLobe::BlinnPhong;
  double error = 1e-4;
  int threads = 1;
  bool clamp = true;  ///< what the transforms round to below zero becomes zero
};

/// Filters a source for all levels; fills the report's levels after those that it holds. progress: share from 0 to 1, from the calling thread.
std::vector<CubeLevel> filterLevels(const Source& source, std::span<const LevelSpec> levels, const FilterOptions& options, PrefilterReport* report = nullptr,
                                    const std::function<void(double)>& progress = {});

}  // namespace burnish::prefilter
