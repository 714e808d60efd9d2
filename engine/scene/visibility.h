// What a view sees: instances inside its frustum, nearest first, with their transforms relative to the eye; and the lights.
// Everything is relative to the eye in world axes, subtracted in double precision, so that a camera far from the origin loses nothing.
#pragma once
#include <burnish/plan.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "scene/pose.h"

namespace burnish::scene {

/// What is known of a mesh's outside: all of it in one plane; a part of a convex body's surface, seen from outside or from inside; anything else.
enum class MeshShape : std::uint8_t { Flat, Convex, Hollow, General };
MeshShape shapeOf(const Mesh& mesh);

/// World matrices, mesh bounds and poses of one scene, kept until the tables change.
class Derived {
 public:
  /// What is mended in skins and morph weights goes into the report, if there is one.
  void update(const Scene& scene, Report* report = nullptr);
  [[nodiscard]] const glm::dmat4& world(Id<Node> node) const;
  [[nodiscard]] const Bounds& bounds(Id<Mesh> mesh) const { return bounds_[mesh.index].bounds; }
  /// How the instance is deformed; nullptr: it is rigid.
  [[nodiscard]] const Pose* pose(Id<Instance> instance) const { return instance.index < poses_.size() ? poses_[instance.index].get() : nullptr; }
  /// Where the instance's vertices (deformed ones, where it has a pose) stand: their space to the world.
  [[nodiscard]] const glm::dmat4& placement(Id<Instance> id, const Instance& instance) const;
  /// Found when first asked for (transparent meshes alone want it).
  [[nodiscard]] MeshShape shape(Id<Mesh> id, const Mesh& mesh) const;

 private:
  void updatePoses(const Scene& scene, Report* report);

  struct MeshBounds {
    std::uint64_t revision = 0;
    Bounds bounds;
    std::uint64_t extentsRevision = 0;
    std::unique_ptr<Extents> extents;  // only of meshes that are deformed
    mutable std::optional<MeshShape> shape;
  };
  std::vector<glm::dmat4> world_;
  std::vector<MeshBounds> bounds_;
  std::vector<std::unique_ptr<Pose>> poses_;  // by instance
  std::uint64_t nodesRevision_ = ~0ull, meshesRevision_ = ~0ull, instancesRevision_ = ~0ull, skinsRevision_ = ~0ull;
};

/// The view's geometry in numbers that passes and culling share.
struct ViewFrame {
  glm::ivec4 viewport{0};                 ///< of the pixels that are shaded
  glm::ivec4 target{0};                   ///< on the target: the same, unless pixels are shaded at a smaller size
  bool orthographic = false;
  glm::dvec3 eye{0};
  glm::dmat3 axes{1};                     ///< right, up, back
  double tanX = 1, tanY = 1;              ///< half extents of the image plane at depth 1 (perspective) or in metres (orthographic)
  double near = 0.05, far = 0;            ///< far 0: infinite
  glm::dvec2 depthParams{0};              ///< perspective: depth w = x / (z + y); orthographic: w = x - z y
  glm::dmat4 viewProjection{1};           ///< camera-relative world to clip, depth reversed in [0,1], jitter included
  glm::dvec2 jitter{0};                   ///< pixels from their middles to where they are sampled (antialiasing over time), right and up
};
/// Viewport and projection of a view on a target. Values out of range (fov, near, NaN) are clamped to what can be drawn. `shaded`: the size at which pixels are shaded, for the whole target; none: the
/// target's.
ViewFrame frameOf(const View& view, glm::ivec2 targetSize, glm::dvec2 jitter = {0, 0}, glm::ivec2 shaded = {0, 0});
/// ViewFrame::viewProjection as if pixels were sampled in their middles.
glm::dmat4 withoutJitter(const ViewFrame& frame);
/// The same frame narrowed to one pixel of the viewport, drawn to a 1x1 target (picking).
ViewFrame narrowed(const ViewFrame& frame, glm::ivec2 pixel);

/// The view's volume: planes in camera-relative world space.
class Frustum {
 public:
  explicit Frustum(const ViewFrame& frame);
  /// False only when the box (half extents along the world's axes) is outside.
  [[nodiscard]] bool meetsBox(glm::dvec3 center, glm::dvec3 halfExtent) const;
  [[nodiscard]] bool meetsSphere(glm::dvec3 center, double radius) const;

 private:
  glm::dvec4 plane_[6];  // pointing inward: dot(n, p) + d >= 0
  int count_ = 0;
};

/// What is looked for: what the frustum holds, or all that there is.
enum class Reach : std::uint8_t { InView, Everywhere };

struct VisibleInstance {
  Id<Instance> id;
  const Instance* instance = nullptr;
  const Mesh* mesh = nullptr;
  const Pose* pose = nullptr;  ///< how it is deformed; nullptr: it is rigid. Lives until the scene's tables change.
  glm::vec4 model[3];   ///< rows: object to camera-relative world
  glm::vec3 normal[3];  ///< rows of the cofactor matrix, times the sign of the determinant
  bool flipped = false;  ///< the transform mirrors
  float distance = 0;   ///< from the eye to the centre of the bounds, metres
  glm::vec3 center{0}, extent{0};  ///< box around it along the world's axes, camera-relative: middle and half extents
};
/// Sets model, normal and flipped from where the instance's vertices stand in the world; false when that is not finite.
bool setPlacement(VisibleInstance& instance, const glm::dmat4& world, glm::dvec3 eye);
/// Takes the pose away: the mesh as it is, at the instance's node.
void makeRigid(const Scene& scene, const Derived& derived, const ViewFrame& frame, VisibleInstance& instance);
/// An instance that can be drawn, and where it is.
struct Placed {
  Id<Instance> id;
  const Instance* instance = nullptr;
  const Mesh* mesh = nullptr;
  const Pose* pose = nullptr;  ///< nullptr: it is rigid
  glm::dmat4 placement{1};     ///< of its vertices, to the world
  glm::dvec3 center{0}, extent{0};  ///< its box: middle relative to the eye, half extents along the world's axes
};
/// Every visible instance with a mesh, bounds and a finite transform, in order of the table.
void eachPlaced(const Scene& scene, const Derived& derived, glm::dvec3 eye, const std::function<void(const Placed&)>& f);
/// Takes the pose away: the mesh as it is, at the instance's node. The box stays.
void makeRigid(const Scene& scene, const Derived& derived, Placed& placed);
/// Instances whose bounds meet the frustum, sorted by distance. Non-finite transforms are left out.
void findVisible(const Scene& scene, const Derived& derived, const ViewFrame& frame, std::vector<VisibleInstance>& out, Reach reach = Reach::InView);

/// Visible instances in a row that one call can draw: the same mesh and material, mirrored or not alike.
struct Batch {
  std::uint32_t first = 0, count = 1;
};
/// Batches are made from so many instances on: fewer are drawn one by one, in order of their distance. (docs/benchmarks.md has what it saves; where the line is drawn is a choice.)
inline constexpr std::uint32_t kInstancedFrom = 8;
/// Brings the instances of each batch together, at the place of the nearest one. Every instance is in exactly one batch.
std::vector<Batch> batch(std::vector<VisibleInstance>& instances);
/// A batch for each instance.
std::vector<Batch> singles(const std::vector<VisibleInstance>& instances);

struct DirectionalLight {
  Id<Light> id;
  glm::vec3 toLight{0, 1, 0};
  glm::vec3 illuminance{0};  ///< lux
  float angularDiameter = 0;  ///< radians
  bool castsShadow = false;
};
/// A point or spot light, relative to the eye.
struct LocalLight {
  Id<Light> id;
  glm::vec3 position{0};
  glm::vec3 intensity{0};  ///< candela
  float radius = 0;        ///< metres: it gives nothing beyond
  float invRange4 = 0, bias = 0;  ///< shaders/shading/light.h
  glm::vec3 axis{0, -1, 0};
  float spotScale = 0, spotOffset = 1;
  float cosOuter = -2;     ///< -2: a point light
  float sourceRadius = 0;  ///< metres
  bool castsShadow = false;
};
struct LightSet {
  std::vector<DirectionalLight> directional;  ///< at most MAX_DIRECTIONAL
  std::vector<LocalLight> local;
};
/// Lights of the scene that are on and finite; point and spot lights only where their reach meets the frustum. Ranges that were derived, lights past the limit
/// and lights that are mended are reported.
LightSet gatherLights(const Scene& scene, const Derived& derived, const ViewFrame& frame, const Quality& quality, Report& report, Reach reach = Reach::InView);

}  // namespace burnish::scene
