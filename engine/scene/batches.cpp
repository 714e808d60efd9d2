// Instances that share mesh and material are drawn together; deformed ones have vertices of their own.
#include <unordered_map>

#include "scene/visibility.h"

namespace burnish::scene {
namespace {

struct Key {
  const Mesh* mesh;
  const Pose* pose;
  std::uint32_t material;
  bool flipped;
  friend bool operator==(const Key&, const Key&) = default;
};
struct HashKey {
  std::size_t operator()(const Key& k) const { return (std::hash<const void*>()(k.mesh) + std::hash<const void*>()(k.pose)) * 31 + k.material * 2 + std::size_t(k.flipped); }
};

}  // namespace

std::vector<Batch> singles(const std::vector<VisibleInstance>& instances) {
  std::vector<Batch> batches(instances.size());
  for (std::size_t i = 0; i < instances.size(); ++i) batches[i].first = std::uint32_t(i);
  return batches;
}

std::vector<Batch> batch(std::vector<VisibleInstance>& instances) {
  // Members of each group, in order of distance.
  std::unordered_map<Key, std::uint32_t, HashKey> groups;
  std::vector<std::vector<std::uint32_t>> members;
  std::vector<std::uint32_t> groupOf(instances.size());
  bool any = false;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const VisibleInstance& v = instances[i];
    const auto [at, fresh] = groups.try_emplace({v.mesh, v.pose, v.instance->material.index, v.flipped}, std::uint32_t(members.size()));
    if (fresh) members.emplace_back();
    groupOf[i] = at->second;
    members[at->second].push_back(i);
    any |= members[at->second].size() >= kInstancedFrom;
  }
  if (!any) return singles(instances);
  std::vector<Batch> batches;
  std::vector<VisibleInstance> ordered;
  ordered.reserve(instances.size());
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    std::vector<std::uint32_t>& group = members[groupOf[i]];
    if (group.empty()) continue;  // drawn with its nearest member
    const bool together = group.size() >= kInstancedFrom;
    batches.push_back({std::uint32_t(ordered.size()), together ? std::uint32_t(group.size()) : 1});
    if (!together) {
      ordered.push_back(instances[i]);
      continue;
    }
    for (std::uint32_t m : group) ordered.push_back(instances[m]);
    group.clear();
  }
  instances = std::move(ordered);
  return batches;
}

}  // namespace burnish::scene
