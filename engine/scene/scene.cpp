#include <burnish/scene.h>

#include <cmath>
#include <unordered_set>

#include "scene/pose.h"
#include "scene/transforms.h"

namespace burnish {
namespace scene {

bool finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return false;
  return true;
}

namespace {
glm::dmat4 localOf(const Node& node) { return finite(node.local) ? node.local : glm::dmat4(1); }
}  // namespace

// Depth-first towards the root with a stack of our own: hierarchies may be 100,000 nodes deep.
std::vector<glm::dmat4> worldMatrices(const Scene& scene) {
  enum class State : std::uint8_t { New, Open, Done };
  const std::uint32_t count = std::uint32_t(scene.nodes.capacity());
  std::vector<glm::dmat4> world(count, glm::dmat4(1));
  std::vector<State> state(count, State::New);
  std::vector<std::uint32_t> path;
  for (std::uint32_t start = 0; start < count; ++start) {
    for (std::uint32_t i = start; state[i] == State::New;) {
      const Node* node = scene.nodes.get(scene.nodes.at(i));
      if (!node) {
        state[i] = State::Done;
        break;
      }
      state[i] = State::Open;
      path.push_back(i);
      if (!scene.nodes.has(node->parent)) break;
      i = node->parent.index;
    }
    for (; !path.empty(); path.pop_back()) {
      const std::uint32_t i = path.back();
      const Node& node = *scene.nodes.get(scene.nodes.at(i));
      // A parent that is still open closes a cycle: the path from `start` ran back into itself. It is cut there.
      const bool above = scene.nodes.has(node.parent) && state[node.parent.index] == State::Done;
      world[i] = above ? world[node.parent.index] * localOf(node) : localOf(node);
      state[i] = State::Done;
    }
  }
  return world;
}

}  // namespace scene

glm::dmat4 Scene::world(Id<Node> node) const {
  glm::dmat4 m(1);
  const Node* n = nodes.get(node);
  if (!n) return m;
  const auto apply = [&m](const Node& at) { m = (scene::finite(at.local) ? at.local : glm::dmat4(1)) * m; };
  std::size_t steps = 0;
  for (const Node* at = n; at && steps <= nodes.size(); at = nodes.get(at->parent), ++steps) apply(*at);
  if (steps <= nodes.size()) return m;
  // More steps than nodes: a cycle. Go up once more and stop before the first node that was met already.
  m = glm::dmat4(1);
  std::unordered_set<const Node*> met;
  for (const Node* at = n; at && met.insert(at).second; at = nodes.get(at->parent)) apply(*at);
  return m;
}

Bounds Scene::bounds() const {
  Bounds all;
  const std::vector<glm::dmat4> world = scene::worldMatrices(*this);
  std::vector<std::optional<Bounds>> meshBounds(meshes.capacity());
  std::vector<std::optional<scene::Extents>> extents(meshes.capacity());
  const auto add = [&all](const Bounds& b, const glm::dmat4& m) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec4 p(corner & 1 ? b.max.x : b.min.x, corner & 2 ? b.max.y : b.min.y, corner & 4 ? b.max.z : b.min.z, 1);
      const glm::vec3 w(m * p);
      if (!std::isfinite(w.x + w.y + w.z)) continue;
      all.min = glm::min(all.min, w);
      all.max = glm::max(all.max, w);
    }
  };
  instances.each([&](Id<Instance>, const Instance& instance) {
    const Mesh* mesh = meshes.get(instance.mesh);
    if (!instance.visible || !mesh) return;
    if (scene::deforms(*this, instance, *mesh)) {
      std::optional<scene::Extents>& e = extents[instance.mesh.index];
      if (!e) e = scene::extentsOf(*mesh);
      const scene::Pose pose = scene::poseOf(*this, instance, *mesh, *e, world, nullptr);
      if (!pose.bounds.empty()) add(pose.bounds, pose.placement);
      return;
    }
    std::optional<Bounds>& b = meshBounds[instance.mesh.index];
    if (!b) b = boundsOf(*mesh);
    if (b->empty()) return;
    add(*b, nodes.has(instance.node) ? world[instance.node.index] : glm::dmat4(1));
  });
  return all;
}

Bounds boundsOf(const Mesh& mesh) {
  Bounds b;
  for (const std::uint32_t i : mesh.indices) {
    if (i >= mesh.positions.size()) continue;
    const glm::vec3 p = mesh.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    b.min = glm::min(b.min, p);
    b.max = glm::max(b.max, p);
  }
  return b;
}

}  // namespace burnish
