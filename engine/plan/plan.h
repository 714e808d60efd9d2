// makePlan for callers that have looked already.
#pragma once
#include "plan/situation.h"

namespace burnish::plan {

/// `whole`: facts of the whole scene, so that the reasons of what is off can name what is out of view; nullptr: they do not.
FramePlan planOf(const Scene& scene, std::span<const Seen> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options, const Facts* whole);

/// Some pass of the plan reads the table or target of that name.
bool reads(const FramePlan& plan, std::string_view what);

}  // namespace burnish::plan
