// What moved between two frames: where instances stood, and which are deformed otherwise than they were.
#pragma once
#include <optional>

#include "scene/visibility.h"

namespace burnish::scene {

/// An instance that stands elsewhere, or has another shape, than in the frame before.
struct Moved {
  std::uint32_t visible = 0;  ///< index among the view's instances
  glm::dmat4 placement{1};    ///< where its vertices' space stood then (Derived::placement)
};

/// Remembers one frame of one scene.
class MotionTracker {
 public:
  /// Compares the scene with the frame before and remembers it as it is now. In the first frame, and after a change of scene, nothing has moved.
  void update(const Scene& scene, const Derived& derived);
  /// Those of `instances` that moved. New ones have not.
  [[nodiscard]] std::vector<Moved> among(const std::vector<VisibleInstance>& instances) const;

 private:
  struct Row {
    std::uint32_t generation = 0;
    bool known = false, moved = false;
    glm::dmat4 placement{1}, before{1};
    std::optional<Pose> pose;
  };
  std::vector<Row> rows_;  // by instance
  std::uint64_t scene_ = 0, nodes_ = 0, meshes_ = 0, instances_ = 0, skins_ = 0;
};

}  // namespace burnish::scene
