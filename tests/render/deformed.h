// Deformed meshes and where they should be: in double, from the scene's tables alone.
#pragma once
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "render/scenes.h"

namespace burnish::test {

struct Vertex {
  dvec3 position, normal, tangent;
};

/// The instance's vertices in the world: morph targets, then joints (or its node), positions and cofactors in double.
inline std::vector<Vertex> deformedBy(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = *scene.meshes.get(instance.mesh);
  const Skin* skin = scene.skins.get(instance.skin);
  std::vector<Vertex> out(mesh.positions.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    dvec3 p(mesh.positions[v]), n(mesh.normals[v]), t = mesh.tangents.empty() ? dvec3(0) : dvec3(mesh.tangents[v]);
    for (std::size_t k = 0; k < std::min(mesh.targets.size(), instance.morphWeights.size()); ++k) {
      const MorphTarget& target = mesh.targets[k];
      const double w = double(instance.morphWeights[k]);
      if (!target.positions.empty()) p += w * dvec3(target.positions[v]);
      if (!target.normals.empty()) n += w * dvec3(target.normals[v]);
      if (!target.tangents.empty()) t += w * dvec3(target.tangents[v]);
    }
    glm::dmat4 m = scene.world(instance.node);
    if (skin) {
      m = glm::dmat4(0);
      for (int c = 0; c < 4; ++c) {
        const std::size_t j = mesh.joints[v][c];
        m += double(mesh.weights[v][c]) * (scene.world(skin->joints[j]) * glm::dmat4(skin->inverseBind[j]));
      }
    }
    const glm::dmat3 a(m);
    const glm::dmat3 cofactor(glm::cross(a[1], a[2]), glm::cross(a[2], a[0]), glm::cross(a[0], a[1]));
    out[v].position = dvec3(m * glm::dvec4(p, 1));
    out[v].normal = glm::normalize(cofactor * n) * (glm::determinant(a) < 0 ? -1.0 : 1.0);
    if (t != dvec3(0)) out[v].tangent = glm::normalize(a * t);
  }
  return out;
}

/// A mesh with those vertices, rigid, in the world less `origin`.
inline Mesh frozen(const Scene& scene, const Instance& instance, dvec3 origin = dvec3(0)) {
  Mesh mesh = *scene.meshes.get(instance.mesh);
  const std::vector<Vertex> vertices = deformedBy(scene, instance);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    mesh.positions[v] = vec3(vertices[v].position - origin);
    mesh.normals[v] = vec3(vertices[v].normal);
    if (!mesh.tangents.empty()) mesh.tangents[v] = vec4(vec3(vertices[v].tangent), mesh.tangents[v].w);
  }
  mesh.joints.clear();
  mesh.weights.clear();
  mesh.targets.clear();
  return mesh;
}

/// A tube along x from 0 to `joints` - 1 metres, hanging on a chain of that many joints a metre apart (node k + 1 below node k); weights run from one joint to the next.
struct Arm {
  Scene scene;
  std::vector<Id<Node>> joints;
  Id<Skin> skin;
  Id<Mesh> mesh;
  Id<Instance> instance;

  explicit Arm(int count = 4, dvec3 origin = dvec3(0), bool morphs = false) {
    Skin s;
    for (int k = 0; k < count; ++k) {
      joints.push_back(addNode(scene, translation(k == 0 ? origin : dvec3(1, 0, 0)), k == 0 ? Id<Node>{} : joints.back()));
      s.inverseBind.push_back(glm::mat4(translation({-double(k), 0, 0})));
    }
    s.joints = joints;
    skin = scene.skins.add(s);
    mesh = scene.meshes.add(tube(count, morphs));
    Instance i;
    i.name = "arm";
    i.mesh = mesh;
    i.skin = skin;
    i.material = scene.materials.add(Material{});
    i.node = addNode(scene, translation({50, 60, 70}));  // it counts for nothing
    instance = scene.instances.add(i);
  }
  [[nodiscard]] const Instance& row() const { return *scene.instances.get(instance); }
  /// Turns joint k about an axis through it.
  void turn(int k, double angle, dvec3 axis = {0, 0, 1}) {
    Node& node = *scene.nodes.edit(joints[std::size_t(k)]);
    const dvec3 at(node.local[3]);
    node.local = glm::rotate(translation(at), angle, axis);
  }

 private:
  static Mesh tube(int count, bool morphs) {
    constexpr int kAround = 12, kAlong = 8;
    Mesh m;
    const int rings = (count - 1) * kAlong;
    for (int r = 0; r <= rings; ++r)
      for (int a = 0; a <= kAround; ++a) {
        const double x = double(r) / kAlong, angle = 2 * kPi * a / kAround;
        const dvec3 n(0, std::cos(angle), std::sin(angle));
        m.positions.push_back(vec3(dvec3(x, 0, 0) + n * 0.25));
        m.normals.push_back(vec3(n));
        m.tangents.emplace_back(1, 0, 0, 1);
        m.uv0.emplace_back(float(x), float(a) / kAround);
        const int low = std::min(int(x), count - 2);
        m.joints.emplace_back(low, low + 1, 0, 0);
        m.weights.emplace_back(1 - (x - low), x - low, 0, 0);
      }
    for (int r = 0; r < rings; ++r)
      for (int a = 0; a < kAround; ++a) {
        const std::uint32_t i = std::uint32_t(r * (kAround + 1) + a), j = i + kAround + 1;
        m.indices.insert(m.indices.end(), {i, i + 1, j + 1, i, j + 1, j});
      }
    if (!morphs) return m;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> some(-0.2f, 0.2f);
    for (int k = 0; k < 3; ++k) {
      MorphTarget t;
      for (std::size_t v = 0; v < m.positions.size(); ++v) {
        t.positions.emplace_back(some(random), some(random), some(random));
        t.normals.emplace_back(some(random), some(random), some(random));
        t.tangents.emplace_back(some(random), some(random), some(random));
      }
      if (k == 1) t.normals.clear();
      if (k == 2) t.tangents.clear();
      m.targets.push_back(t);
    }
    return m;
  }
};

}  // namespace burnish::test
