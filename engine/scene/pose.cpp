#include "scene/pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/transforms.h"

namespace burnish::scene {
namespace {

bool finiteVector(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void grow(Bounds& b, glm::vec3 p) {
  b.min = glm::min(b.min, p);
  b.max = glm::max(b.max, p);
}

bool wholeStreams(const Mesh& mesh) { return !mesh.joints.empty() && mesh.joints.size() == mesh.positions.size() && mesh.weights.size() == mesh.positions.size(); }

std::uint32_t lastJoint(const Mesh& mesh) {
  std::uint32_t last = 0;
  for (const glm::u16vec4& j : mesh.joints) last = std::max({last, std::uint32_t(j.x), std::uint32_t(j.y), std::uint32_t(j.z), std::uint32_t(j.w)});
  return last;
}

// Each vertex to the boxes of the joints that it hangs on, as validation mends its weights: without any it hangs on its first.
void addJoints(const Mesh& mesh, std::uint32_t vertex, Extents& e) {
  const glm::u16vec4 joints = mesh.joints[vertex];
  const glm::vec4 weights = mesh.weights[vertex];
  bool any = false;
  for (int c = 0; c < 4; ++c) {
    if (!(weights[c] > 0) || !std::isfinite(weights[c])) continue;
    any = true;
    grow(e.joints[joints[c]], mesh.positions[vertex]);
  }
  if (!any) grow(e.joints[joints.x], mesh.positions[vertex]);
}

std::string place(const Instance& instance) { return instance.name.empty() ? "an unnamed instance" : fmt::format("instance '{}'", instance.name); }

// Weighed extents of all targets, added to a box.
Bounds morphed(Bounds box, const Pose& pose, const Extents& e) {
  for (const auto& [target, weight] : pose.targets) {
    const glm::vec3 a = e.least[target] * weight, b = e.most[target] * weight;
    box.min += glm::min(a, b);
    box.max += glm::max(a, b);
  }
  return box;
}

void weigh(const Instance& instance, const Mesh& mesh, Pose& pose, Report* report) {
  const std::size_t count = std::min(instance.morphWeights.size(), mesh.targets.size());
  for (std::size_t t = 0; t < count; ++t) {
    const float w = instance.morphWeights[t];
    if (!std::isfinite(w)) {
      if (report) report->warn(place(instance), "has morph weights that are not finite: they count as 0");
    } else if (w != 0) {
      pose.targets.emplace_back(std::uint32_t(t), w);
    }
  }
  pose.morphed = !pose.targets.empty();
}

// Where the skin's joints take mesh space in the world, in double; those that overflow leave it where it is.
std::vector<glm::dmat4> jointMatrices(const Scene& scene, const Skin& skin, const std::vector<glm::dmat4>& world) {
  std::vector<glm::dmat4> out(skin.joints.size(), glm::dmat4(1));
  for (std::size_t j = 0; j < out.size(); ++j) {
    if (scene.nodes.has(skin.joints[j])) out[j] = world[skin.joints[j].index];
    if (j < skin.inverseBind.size())
      if (const glm::dmat4 inverse(skin.inverseBind[j]); finite(inverse)) out[j] *= inverse;
    if (!finite(out[j])) out[j] = glm::dmat4(1);
  }
  return out;
}

void addSkin(const Scene& scene, const Skin& skin, const Extents& extents, const std::vector<glm::dmat4>& world, Pose& pose) {
  const std::vector<glm::dmat4> matrices = jointMatrices(scene, skin, world);
  // Near the vertices: the middle of what hangs on the joints, in the world.
  std::vector<std::pair<std::size_t, Bounds>> boxes;
  glm::dvec3 least(INFINITY), most(-INFINITY);
  int mirrored = 0;
  for (std::size_t j = 0; j < std::min(matrices.size(), extents.joints.size()); ++j) {
    if (extents.joints[j].empty()) continue;
    boxes.emplace_back(j, morphed(extents.joints[j], pose, extents));
    const glm::dvec3 middle(matrices[j] * glm::dvec4((glm::dvec3(boxes.back().second.min) + glm::dvec3(boxes.back().second.max)) * 0.5, 1));
    least = glm::min(least, middle);
    most = glm::max(most, middle);
    const double determinant = glm::determinant(glm::dmat3(matrices[j]));
    mirrored += determinant < 0 ? 1 : determinant > 0 ? -1 : 0;
  }
  const glm::dvec3 anchor = boxes.empty() ? glm::dvec3(0) : (least + most) * 0.5;
  pose.placement = glm::dmat4(1);
  pose.placement[3] = glm::dvec4(anchor, 1);
  pose.flipped = mirrored > 0;
  for (const glm::dmat4& m : matrices) {
    glm::dmat4 near = m;
    near[3] -= glm::dvec4(anchor, 0);
    pose.joints.emplace_back(near);
  }
  // A vertex lies between the places that its joints take it to: the box around the joints' boxes holds it.
  pose.bounds = {};
  for (const auto& [j, box] : boxes) {
    const Bounds b = transformed(box, glm::dmat4(pose.joints[j]));
    if (b.empty()) {
      pose.bounds = {};  // not finite: nothing that could be drawn
      return;
    }
    grow(pose.bounds, b.min);
    grow(pose.bounds, b.max);
  }
}

}  // namespace

Bounds transformed(const Bounds& box, const glm::dmat4& matrix) {
  if (box.empty()) return {};
  const glm::dvec3 half = (glm::dvec3(box.max) - glm::dvec3(box.min)) * 0.5, middle = (glm::dvec3(box.max) + glm::dvec3(box.min)) * 0.5;
  const glm::dmat3 m(matrix);
  const glm::dvec3 center = m * middle + glm::dvec3(matrix[3]);
  const glm::dvec3 extent = glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y + glm::abs(m[2]) * half.z;
  // Deformed positions are sums of floats: a few roundings of the largest term.
  const glm::dvec3 slack = (glm::abs(center) + extent) * 1e-6;
  Bounds out;
  out.min = glm::vec3(center - extent - slack);
  out.max = glm::vec3(center + extent + slack);
  return finiteVector(out.min) && finiteVector(out.max) ? out : Bounds{};
}

Extents extentsOf(const Mesh& mesh) {
  Extents e;
  e.all = boundsOf(mesh);
  const bool joints = wholeStreams(mesh);
  if (joints) e.joints.resize(lastJoint(mesh) + 1);
  for (const MorphTarget& target : mesh.targets) {
    glm::vec3 least(0), most(0);
    if (target.positions.size() == mesh.positions.size())
      for (const glm::vec3& d : target.positions)
        if (finiteVector(d)) least = glm::min(least, d), most = glm::max(most, d);
    e.least.push_back(least);
    e.most.push_back(most);
  }
  if (!joints) return e;
  std::vector<bool> done(mesh.positions.size());
  for (const std::uint32_t i : mesh.indices) {
    if (i >= mesh.positions.size() || done[i] || !finiteVector(mesh.positions[i])) continue;
    done[i] = true;
    addJoints(mesh, i, e);
  }
  return e;
}

bool deforms(const Scene& scene, const Instance& instance, const Mesh& mesh) {
  if (!mesh.joints.empty() && scene.skins.has(instance.skin)) return true;
  const std::size_t count = std::min(instance.morphWeights.size(), mesh.targets.size());
  return std::any_of(instance.morphWeights.begin(), instance.morphWeights.begin() + std::ptrdiff_t(count), [](float w) { return w != 0; });
}

Pose poseOf(const Scene& scene, const Instance& instance, const Mesh& mesh, const Extents& extents, const std::vector<glm::dmat4>& world, Report* report) {
  Pose pose;
  if (scene.nodes.has(instance.node)) pose.placement = world[instance.node.index];
  weigh(instance, mesh, pose, report);
  const Skin* skin = scene.skins.get(instance.skin);
  pose.skinned = skin && !extents.joints.empty() && extents.joints.size() <= skin->joints.size();
  if (skin && !mesh.joints.empty() && !pose.skinned && report)
    report->warn(place(instance), fmt::format("its mesh hangs on {} joints where its skin has {}: it is shown in its bind pose", extents.joints.size(), skin->joints.size()));
  if (pose.skinned)
    addSkin(scene, *skin, extents, world, pose);
  else
    pose.bounds = morphed(extents.all, pose, extents);
  return pose;
}

}  // namespace burnish::scene
