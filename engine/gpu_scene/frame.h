// What the passes of one view share: the plan, its resolved programs and targets, and what is drawn. Passes meet here and nowhere else.
#pragma once
#include <burnish/plan.h>

#include <array>
#include <map>
#include <optional>
#include <string>

#include "gl/objects.h"
#include "gl/program.h"
#include "gpu_scene/gpu_scene.h"
#include "gpu_scene/shadows.h"
#include "scene/motion.h"
#include "scene/probes.h"
#include "scene/transparency.h"

namespace burnish::gpu_scene {

/// The textures and framebuffers of a plan's targets. What a plan no longer lists is kept for a while (kIdleFrames), so that an effect at the edge of the view does not
/// allocate anew in every other frame.
class TargetPool {
 public:
  explicit TargetPool(gl::Device& device) : device_(device) {}
  static constexpr int kIdleFrames = 60;
  /// Allocates what the plan lists; frees what has been idle for long, and at once what a target of the same name with another size or format replaces.
  Result<void> prepare(const FramePlan& plan);
  /// nullptr when the plan has no such target.
  [[nodiscard]] const gl::Texture* texture(std::string_view name) const;
  /// Tells one texture of a target from the next one that takes its place; 0: the plan has no such target.
  [[nodiscard]] std::uint64_t serial(std::string_view name) const;
  /// A framebuffer of the named targets (colours in order; depth optional), made on first use.
  Result<GLuint> framebuffer(std::initializer_list<std::string_view> colors, std::string_view depth = {});
  /// A framebuffer of one layer of a depth target that is an array.
  Result<GLuint> layerFramebuffer(std::string_view depth, int layer);
  /// A framebuffer of one mip level of a target that the plan lists.
  Result<GLuint> levelFramebuffer(std::string_view color, int level);

 private:
  struct Entry {
    TargetPlan plan;
    gl::Texture texture;
    int idle = 0;  // frames since a plan listed it
    std::uint64_t serial = 0;
  };
  gl::Device& device_;
  std::map<std::string, Entry, std::less<>> entries_;
  std::map<std::string, gl::Framebuffer, std::less<>> framebuffers_;
  std::uint64_t made_ = 0;
};

/// The plan's programs, linked.
class ProgramSet {
 public:
  /// onDemand: each is linked when it is first asked for.
  explicit ProgramSet(gl::Device& device, gl::ProgramCache& cache, bool onDemand = false) : device_(device), cache_(cache), onDemand_(onDemand) {}
  /// Links what is missing. Errors name program, file and line.
  Result<void> prepare(const FramePlan& plan);
  /// The plan's program of that name. Asking for one that the plan does not list is a fault of the engine: it returns nullptr. So does one that cannot be linked on demand: see failed().
  [[nodiscard]] const gl::Program* find(std::string_view name) const;
  /// What went wrong since prepare().
  [[nodiscard]] const std::optional<Error>& failed() const { return failed_; }

 private:
  gl::Device& device_;
  gl::ProgramCache& cache_;
  bool onDemand_;
  std::vector<ProgramPlan> plan_;
  mutable std::map<std::string, const gl::Program*, std::less<>> programs_;
  mutable std::optional<Error> failed_;
};
gl::ProgramSource sourceOf(const ProgramPlan& plan);

/// Buffers that each view fills anew. Those that not every plan wants are made on first use.
struct FrameBuffers {
  gl::Buffer frame, draws;
  ShadowBindings shadows;  ///< empty until a plan has shadows
  gl::TextureBuffer probes;  ///< records; empty until a plan reads them
  gl::Buffer grid;           ///< where the ambient lattice lies; likewise
  std::size_t drawStride = 256;
  static Result<FrameBuffers> create(gl::Device& device);
  /// Vertex formats of the geometry programs, made when first asked for.
  const gl::VertexArray& array(gl::Device& device, bool general, bool instanced);
  /// For programs that read no vertices.
  const gl::VertexArray& noVertices(gl::Device& device);

 private:
  static gl::VertexArray makeArray(gl::Device& device, bool general, bool instanced);
  gl::VertexArray arrays[2][2], none_;
};
/// The vertex binding that holds DrawData in instanced programs.
inline constexpr GLuint kDrawBinding = 2;

/// What antialiasing over time knows of the view's frame before.
struct PastFrame {
  bool valid = false;      ///< the history holds it
  bool still = true;       ///< nothing that makes the picture has changed since
  scene::ViewFrame frame;  ///< how it was seen
  float preExposure = 1;   ///< FrameContext::preExposure then
  int sequence = 0, source = 0;  ///< which targets hold it (plan/temporal.h)
};

struct FrameContext {
  gl::Device& device;
  const FramePlan& plan;
  const ProgramSet& programs;
  TargetPool& targets;
  GpuScene& gpuScene;
  FrameBuffers& buffers;
  const Scene& scene;
  const Quality& quality;
  const scene::ViewFrame& view;
  const std::vector<scene::VisibleInstance>& visible;
  std::span<const scene::Batch> batches;  ///< of `visible`; what is drawn by one call each
  const scene::LightSet& lights;
  std::span<const scene::TransparentGroup> transparent{};  ///< farthest first
  scene::ShadowSet* shadows = nullptr;    ///< of the first of `lights`; the pass "shadow_maps" says in which layers its maps are
  const GpuEnvironment* environment = nullptr;
  std::span<const scene::SeenProbe> probes{};  ///< smaller boxes before larger ones
  const GpuGrid* grid = nullptr;               ///< nullptr: the plan reads none
  const GpuProbes* probeLight = nullptr;       ///< nullptr: `probes` is empty
  glm::ivec2 size{0};      ///< of the target
  GLuint output = 0;       ///< the target's framebuffer
  float preExposure = 1;   ///< the light buffer holds radiance times this
  PastFrame past{};        ///< counts while antialiasing over time is on
  std::span<const scene::Moved> moved{};  ///< of `visible`, since the frame before
  std::string picture = "light";  ///< the target that what comes after lighting reads
  Report& report;
  FrameStats& stats;

  /// What lighting writes to: the light buffer (with depth to test against, if asked for and there), or the target where the plan develops in place.
  Result<GLuint> lightFramebuffer(bool depth) const;
  /// Viewport and scissor at the view's rectangle.
  void setViewport() const;
  /// The same on the target.
  void setTargetViewport() const;
  /// A full-screen triangle with the named program into the bound framebuffer.
  Result<void> drawScreen(std::string_view program) const;
};

/// Fills the uniform block of the view.
Result<void> uploadFrameData(FrameContext& context, float displayExposure);
/// Transforms of every visible instance into buffers.draws, in order.
Result<void> uploadDraws(FrameContext& context);
/// The mesh that visible instance i is drawn with; nullptr: it is not there (yet).
const GpuMesh* meshOf(FrameContext& context, std::size_t i);
/// Binds the vertex array, geometry and uniform ranges of visible instance i; false when its mesh is not there (yet). `general`: the program reads the second vertex buffer.
/// `bound` remembers what the last call bound, so that nothing is bound twice in a row (each binding makes a software renderer prepare its state anew);
/// start each pass with an empty one.
struct BoundInstance {
  const GpuMesh* mesh = nullptr;
  GLuint vertices = 0;  ///< the mesh's, or the instance's own deformed ones
  const MaterialBinding* material = nullptr;
  const gl::VertexArray* array = nullptr;
};
bool bindInstance(FrameContext& context, std::size_t i, bool general, BoundInstance& bound);
/// The same for a batch that an instanced program draws.
bool bindInstances(FrameContext& context, scene::Batch batch, bool general, BoundInstance& bound);

}  // namespace burnish::gpu_scene
