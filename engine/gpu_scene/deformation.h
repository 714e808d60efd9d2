// Deformed vertices: each instance with a pose has a vertex buffer of its own, as GpuMesh's, written by a compute pass when its pose changes and drawn by every pass as any other.
#pragma once
#include <map>
#include <memory>

#include "gl/objects.h"
#include "scene/pose.h"
#include "scene/visibility.h"

namespace burnish::gpu_scene {

struct FrameContext;
struct GpuMesh;

/// What deforms a mesh, on the GPU; made when an instance of it is first deformed.
struct DeformSource {
  gl::Buffer joints;   ///< six words a vertex: joints u16x4, weights f32x4; empty without joints
  gl::Buffer targets;  ///< target by target, vertex by vertex: `words` floats
  int words = 3;       ///< 3: positions; 6: normals too; 9: tangents too
  std::uint64_t mesh = 0;  ///< GpuMesh::serial that it fits
  bool good = false;
};

/// The deformed instances of one scene. Nothing is allocated until deform() has something to do.
class Deformation {
 public:
  /// Once a frame, before any deform(): forgets what is gone or has not been asked for in a while. `previous`: keep the vertices of the frame before from now on (what motion
  /// vectors want); they cost a second buffer for each instance that moves.
  void beginFrame(const Scene& scene, bool previous);
  /// The instance's vertices as deform() last left them; 0: there are none.
  /// Not either when they are of another upload of the mesh than `serial` (GpuMesh).
  [[nodiscard]] GLuint vertices(Id<Instance> id, std::uint64_t serial) const;
  /// Those of the frame before, and where that space stood then (scene::Pose::placement); the same as now for an instance that kept still or is new, or unless asked for.
  [[nodiscard]] GLuint previousVertices(Id<Instance> id) const;
  [[nodiscard]] const glm::dmat4* previousPlacement(Id<Instance> id) const;
  [[nodiscard]] int dispatches() const { return dispatches_; }  ///< in this frame

 private:
  friend Result<void> deform(FrameContext& c, std::span<const scene::VisibleInstance> instances);
  static constexpr int kIdleFrames = 60;
  struct Entry {
    std::uint32_t generation = 0;
    std::uint64_t mesh = 0;  // GpuMesh::serial
    scene::Pose pose;        // that `current` shows
    glm::dmat4 lastPlacement{1};
    gl::Buffer current, last;
    bool moved = false;      // in this frame: `last` holds the frame before
    int idle = 0;
  };
  const DeformSource* sourceOf(FrameContext& c, const scene::VisibleInstance& v, const GpuMesh& mesh);
  bool prepare(FrameContext& c, const scene::VisibleInstance& v, const GpuMesh& mesh);
  [[nodiscard]] const Entry* find(Id<Instance> id) const;

  std::map<std::uint32_t, Entry> entries_;                          // by instance
  std::map<std::uint32_t, std::unique_ptr<DeformSource>> sources_;  // by mesh
  gl::TextureBuffer pose_;
  bool previous_ = false;
  int dispatches_ = 0;
};

/// Brings the vertices of those instances that have a pose up to date; the others, and those whose pose is what it was, cost nothing. For what is in view the pass `deform` calls it;
/// a pass that draws others (casters of shadows out of view) calls it for them before it draws, with their programs on its plan (plan::deformProgram).
Result<void> deform(FrameContext& c, std::span<const scene::VisibleInstance> instances);

}  // namespace burnish::gpu_scene
