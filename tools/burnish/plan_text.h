// A frame plan for people and for machines; `plan` and `render` share it.
#pragma once
#include <burnish/plan.h>

#include <map>

#include "output.h"

namespace cli {

/// effects, passes, programs, targets; without schema_version.
Json planJson(const burnish::FramePlan& plan);
void printPlan(const burnish::FramePlan& plan);
/// What an effect that is on takes: " [passes; 3 programs; targets: 2.1 MB]", shared with others or not.
std::string costOf(const burnish::EffectPlan& effect);

}  // namespace cli
