#include "scene/motion.h"

namespace burnish::scene {

void MotionTracker::update(const Scene& scene, const Derived& derived) {
  const bool other = scene_ != scene.identity.value();
  const bool same = !other && nodes_ == scene.nodes.revision() && meshes_ == scene.meshes.revision() && instances_ == scene.instances.revision() && skins_ == scene.skins.revision();
  for (Row& row : rows_) row.moved = false;
  if (same) return;
  scene_ = scene.identity.value();
  nodes_ = scene.nodes.revision();
  meshes_ = scene.meshes.revision();
  instances_ = scene.instances.revision();
  skins_ = scene.skins.revision();
  if (other) rows_.clear();
  rows_.resize(scene.instances.capacity());
  for (std::uint32_t i = 0; i < rows_.size(); ++i) {
    const Id<Instance> id = scene.instances.at(i);
    Row& row = rows_[i];
    if (!id) {
      row = {};
      continue;
    }
    const glm::dmat4& now = derived.placement(id, *scene.instances.get(id));
    const Pose* pose = derived.pose(id);
    const bool known = row.known && row.generation == id.generation && row.pose.has_value() == (pose != nullptr);
    row.moved = known && (row.placement != now || (pose && !row.pose->sameShape(*pose)));
    row.before = row.placement;
    row.placement = now;
    row.generation = id.generation;
    row.known = true;
    if (pose)
      row.pose = *pose;
    else
      row.pose.reset();
  }
}

std::vector<Moved> MotionTracker::among(const std::vector<VisibleInstance>& instances) const {
  std::vector<Moved> moved;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const Id<Instance> id = instances[i].id;
    if (id.index < rows_.size() && rows_[id.index].generation == id.generation && rows_[id.index].moved) moved.push_back({i, rows_[id.index].before});
  }
  return moved;
}

}  // namespace burnish::scene
