// Antialiasing over time: when a frame has it, where its samples lie, and what its history is called.
#pragma once
#include <burnish/plan.h>

#include <string>

namespace burnish::plan {

/// The frame joins the mean of those before. Known before anything is looked at: views are then jittered.
bool keepsHistory(const Quality& quality, const PlanOptions& options);
/// Where frame number `frame` (from 0) samples each pixel, in pixels from its middle, [-1/2, 1/2): Halton's sequence in bases 2 and 3 (Halton 1960).
glm::dvec2 jitterOf(unsigned frame);
/// The two targets that take turns, 0 and 1: pictures, and 1/distance of what they show.
std::string historyName(int sequence, int which);
std::string historyDistanceName(int sequence, int which);
/// Most samples in the mean of a picture that changes.
inline constexpr int kMovingSamples = 16;

}  // namespace burnish::plan
