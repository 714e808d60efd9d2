// Pixels that are shaded at a smaller size than the target's (Quality::resolutionScale). Known before anything is looked at: views are made for the smaller size.
#pragma once
#include <burnish/plan.h>

namespace burnish::plan {

/// Quality::resolutionScale, held in 0.25 to 1.
float scaleOf(const Quality& quality);
/// Size of what is shaded, pixels: the target's, or so much of it as the scale says, rounded, at least 1 x 1. Debug views show pixels as they are, and a host's depth has the target's size: with either
/// the scale has no effect.
glm::ivec2 shadedSize(const Quality& quality, const PlanOptions& options);

}  // namespace burnish::plan
