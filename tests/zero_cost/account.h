// Renders a subject under the recorder, and what a frame did that its plan does not say.
#pragma once
#include "recorder/gl_recorder.h"
#include "zero_cost/cases.h"

namespace burnish::test {

struct ObserveOptions {
  std::vector<std::string> removed, forced;  ///< RendererOptions' removedEffects, forcedEffects
  /// Plants calls into the second frame (Recorder::after).
  std::function<void(Recorder&, Function)> plant;
};

/// Two frames of a fresh renderer on a fresh context.
struct Observation {
  FramePlan plan;
  Recording first;   ///< the renderer made, and its first frame
  Recording second;  ///< one more frame of the same
  std::vector<std::string> objects;  ///< Ledger::inventory() after it
  std::int64_t bytes = 0;            ///< of textures and buffers
  Image picture;
  std::vector<std::string> strays;  ///< what the plan does not say, in either frame, and what was left when the renderer had gone
};
Observation observe(const Subject& subject, const ObserveOptions& options = {});

/// In what the two differ, in words; nullopt: passes, programs, targets, objects, bytes and every call of both frames are the same.
std::optional<std::string> difference(const Observation& a, const Observation& b);

/// What a frame did that the plan does not say, one line each; account.cpp has the rules. `steady`: it is the same frame as the one before, so nothing has to be made or uploaded.
std::vector<std::string> strays(const FramePlan& plan, const Scene& scene, const Recording& frame, const Ledger& ledger, bool steady);

}  // namespace burnish::test
