// The node hierarchy is a forest, scenes name its roots, skins and animations fit it. Nothing recurses: files may nest
// nodes as deep as they like.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "asset/document.h"

namespace burnish::asset {
namespace {

std::string nodePath(std::size_t i, const char* member = "") { return fmt::format("/nodes/{}{}", i, member); }

void setParents(Check& check, Document& doc) {
  for (std::size_t i = 0; i < doc.nodes.size(); ++i)
    for (std::size_t c = 0; check.ok() && c < doc.nodes[i].children.size(); ++c) {
      const int child = doc.nodes[i].children[c];
      int& parent = doc.nodes[std::size_t(child)].parent;
      const std::string path = fmt::format("/nodes/{}/children/{}", i, c);
      if (std::size_t(child) == i)
        check.fail(path, fmt::format("node {} is a child of itself: the hierarchy has a loop", child));
      else if (parent >= 0)
        check.fail(path, fmt::format("node {} already has the parent {}", child, parent));
      parent = int(i);
    }
}

// Every node has one parent at most, so a node lies on a loop or under one exactly if no root is above it.
void findLoops(Check& check, Document& doc) {
  enum : char { Unknown, OnTheWay, Rooted };
  std::vector<char> state(doc.nodes.size(), Unknown);
  for (int i = 0; i < int(doc.nodes.size()); ++i) {
    const auto stateOf = [&](int n) -> char& { return state[std::size_t(n)]; };
    const auto parentOf = [&](int n) { return doc.nodes[std::size_t(n)].parent; };
    int n = i;
    for (; n >= 0 && stateOf(n) == Unknown; n = parentOf(n)) stateOf(n) = OnTheWay;
    if (n >= 0 && stateOf(n) == OnTheWay)
      return check.fail(nodePath(std::size_t(n)), "the node is an ancestor of itself: the hierarchy has a loop");
    for (n = i; n >= 0 && stateOf(n) == OnTheWay; n = parentOf(n)) stateOf(n) = Rooted;
  }
}

void checkMeshOfNode(Check& check, const Document& doc, std::size_t index) {
  const NodeSource& n = doc.nodes[index];
  if (n.mesh < 0) return;
  const MeshSource& mesh = doc.meshes[std::size_t(n.mesh)];
  const std::size_t targets = mesh.primitives[0].targets.size();
  if (!n.weights.empty() && n.weights.size() != targets)
    check.fail(nodePath(index, "/weights"), fmt::format("{} weights for {} morph targets", n.weights.size(), targets));
  const bool skinned = std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                                   [](const PrimitiveSource& p) { return p.find("JOINTS_0") >= 0; });
  if (n.skin >= 0 && !skinned)
    check.fail(nodePath(index), fmt::format("the node has a skin, but mesh {} has no joints", n.mesh));
}

void checkScenes(Check& check, const Document& doc) {
  for (std::size_t s = 0; s < doc.scenes.size(); ++s)
    for (std::size_t i = 0; check.ok() && i < doc.scenes[s].nodes.size(); ++i) {
      const int node = doc.scenes[s].nodes[i];
      if (doc.nodes[std::size_t(node)].parent >= 0)
        check.fail(fmt::format("/scenes/{}/nodes/{}", s, i),
                   fmt::format("node {} is no root: it has the parent {}", node, doc.nodes[std::size_t(node)].parent));
    }
}

// Numbers of a depth-first walk: a is an ancestor of b (or b itself) exactly if in[a] <= in[b] < out[a].
struct Walk {
  std::vector<std::uint32_t> in, out;
  std::vector<int> root;
  explicit Walk(const Document& doc) : in(doc.nodes.size()), out(doc.nodes.size()), root(doc.nodes.size(), -1) {
    std::uint32_t clock = 0;
    std::vector<std::pair<int, std::size_t>> stack;
    for (std::size_t r = 0; r < doc.nodes.size(); ++r) {
      if (doc.nodes[r].parent >= 0) continue;
      stack.push_back({int(r), 0});
      while (!stack.empty()) {
        auto& [node, next] = stack.back();
        const std::size_t n = std::size_t(node);
        if (next == 0) {
          in[n] = clock++;
          root[n] = int(r);
        }
        if (next < doc.nodes[n].children.size()) {
          stack.push_back({doc.nodes[n].children[next++], 0});
        } else {
          out[n] = clock;
          stack.pop_back();
        }
      }
    }
  }
  [[nodiscard]] bool above(int a, int b) const {
    return in[std::size_t(a)] <= in[std::size_t(b)] && in[std::size_t(b)] < out[std::size_t(a)];
  }
};

void checkSkin(Check& check, Document& doc, const Walk& walk, std::size_t index) {
  const SkinSource& s = doc.skins[index];
  const std::string path = fmt::format("/skins/{}", index);
  for (const int joint : s.joints) {
    if (walk.root[std::size_t(joint)] != walk.root[std::size_t(s.joints[0])])
      return check.fail(path + "/joints", fmt::format("joints {} and {} have no common root", s.joints[0], joint));
    if (s.skeleton >= 0 && !walk.above(s.skeleton, joint))
      return check.fail(path + "/skeleton", fmt::format("node {} is not above joint {}", s.skeleton, joint));
  }
  if (s.inverseBindMatrices < 0) return;
  const Accessor& a = doc.accessors[std::size_t(s.inverseBindMatrices)];
  const std::string place = path + "/inverseBindMatrices";
  if (a.shape != Shape::Mat4 || a.component != Component::F32)
    return check.fail(place, fmt::format("accessor {} is {}, not MAT4 of FLOAT", s.inverseBindMatrices,
                                         formatName(a.shape, a.component, a.normalized)));
  if (a.count < s.joints.size())
    return check.fail(place, fmt::format("{} matrices for {} joints", a.count, s.joints.size()));
  useView(check, doc, a.view, Usage::Skin, place);
}

// A scene that shows a skinned mesh must hold the skin's joints (glTF 2.0, section 3.7.3.2).
void checkSkinsInScenes(Check& check, const Document& doc, const Walk& walk) {
  std::vector<std::vector<int>> scenesOfRoot(doc.nodes.size());
  for (std::size_t s = 0; s < doc.scenes.size(); ++s)
    for (const int root : doc.scenes[s].nodes) scenesOfRoot[std::size_t(root)].push_back(int(s));
  std::set<std::pair<int, int>> checked;  // a pair of roots need not be compared twice
  for (std::size_t i = 0; check.ok() && i < doc.nodes.size(); ++i) {
    if (doc.nodes[i].skin < 0) continue;
    const int jointRoot = walk.root[std::size_t(doc.skins[std::size_t(doc.nodes[i].skin)].joints[0])];
    if (jointRoot == walk.root[i] || !checked.insert({jointRoot, walk.root[i]}).second) continue;
    for (const int scene : scenesOfRoot[std::size_t(walk.root[i])]) {
      const auto& holds = scenesOfRoot[std::size_t(jointRoot)];
      if (!std::binary_search(holds.begin(), holds.end(), scene))
        return check.fail(nodePath(i), fmt::format("scene {} shows this skinned mesh and lacks its joints", scene));
    }
  }
}

}  // namespace

void validateNodes(Check& check, Document& doc) {
  setParents(check, doc);
  if (check.ok()) findLoops(check, doc);
  if (check.ok()) checkScenes(check, doc);
  for (std::size_t i = 0; check.ok() && i < doc.nodes.size(); ++i) checkMeshOfNode(check, doc, i);
}

void validateSkins(Check& check, Document& doc) {
  if (doc.skins.empty()) return;
  const Walk walk(doc);
  for (std::size_t i = 0; check.ok() && i < doc.skins.size(); ++i) checkSkin(check, doc, walk, i);
  if (check.ok()) checkSkinsInScenes(check, doc, walk);
}

}  // namespace burnish::asset
