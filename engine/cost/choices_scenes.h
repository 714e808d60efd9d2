// Choices that change the scene, not the quality: how its surroundings are filtered, and its probes.
#pragma once
#include "cost/studio.h"

namespace burnish::cost {

/// One setting of a scene. It is made on a copy of the bench's scene that has had the others'.
struct SceneSetting {
  std::string name, note;
  bool inForce = false;
  double onceMs = 0;  ///< CPU time that it takes once, before the first frame; 0: none
  std::function<void(Scene&)> apply;
};
struct SceneChoice {
  std::string name, what, calledBy;
  std::vector<SceneSetting> settings;  ///< cheap to exact
  std::size_t exact = 0;
};

/// Sizes and errors of the cube that reflections of the sky are looked up in. Empty settings: `idle` says why.
Result<SceneChoice> filterChoice(const Bench& bench, std::string& idle);

/// Number of reflection probes and of bounces in them: the scene's own, or those of the rooms that are found in it, baked at a small size into a temporary folder. Empty settings: `idle` says why.
/// `secondsLeft`: asked before each bake.
Result<SceneChoice> probeChoice(const ProcAddress& getProcAddress, const Bench& bench, const std::function<double()>& secondsLeft, std::string& idle);

}  // namespace burnish::cost
