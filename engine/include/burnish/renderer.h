// The renderer: executes frame plans on one GL context. One object per context; several contexts, threads and renderers live side by side. No globals.
#pragma once
#include <burnish/plan.h>

namespace burnish {

/// What happens to the GL state of a host that owns the context.
enum class HostState : std::uint8_t {
  Save,      ///< every piece of state that the engine touches is put back (costs queries)
  Declared,  ///< the state is left as docs/embedding.md declares: engine objects unbound, pixel store and fixed-function state at GL defaults
  DontCare,  ///< nothing is promised
};

struct RendererOptions {
  HostState hostState = HostState::DontCare;
  std::uint64_t uploadBytesPerFrame = 0;     ///< 0: no limit; else meshes and textures arrive over several frames, nearest first
  std::filesystem::path programCache;        ///< folder for program binaries; empty: none
  std::filesystem::path shaderOverride;      ///< folder that is looked into before the embedded shaders; empty: none
  /// Programs are linked when something is first drawn with them, not all that the plan lists before the frame: for tools that make few pictures of many qualities. A plan lists what the next frames of
  /// a moving view may need, and a game wants that ahead. With it a shader of the override folder that does not compile ends render() amid the frame.
  bool linkOnDemand = false;
  TileBounds tileBounds = TileBounds::Automatic;
  std::vector<std::string> removedEffects;   ///< PlanOptions::removed of every frame
  std::vector<std::string> forcedEffects;    ///< PlanOptions::forced of every frame
  bool debugOutput = false;                  ///< collect GL debug messages as errors (needs a debug context to be complete)
  LogSink log;                               ///< warnings; Info: each effect that goes on or off, with its reason
};

/// How far a probe's refresh is.
struct ProbeRefresh {
  int done = 0, total = 0;  ///< pieces: six faces, the filter's slices, the change
  bool ready = false;       ///< the new light is in force from the next render() on
};

class BURNISH_API Renderer {
 public:
  /// The context must be current on this thread, here and in every later call, and outlive the renderer.
  static Result<std::unique_ptr<Renderer>> create(const ProcAddress& getProcAddress, const RendererOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  [[nodiscard]] const Capabilities& capabilities() const;
  /// Compiles and links what the plan needs ahead of the first frame. Returns the number of programs built (not taken from memory).
  Result<int> warmUp(const FramePlan& plan);
  /// Draws the views into the target. Never partially: on error nothing was drawn to the target (but see RendererOptions::linkOnDemand).
  Result<FrameStats> render(const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request = {});
  /// The plan that the last render() executed.
  [[nodiscard]] const FramePlan& lastPlan() const;
  /// The instance that covers a pixel (x right, y up from the target's lower left corner); empty id where there is none.
  Result<Id<Instance>> pick(const Scene& scene, const View& view, glm::ivec2 targetSize, glm::ivec2 pixel);
  /// Captures a reflection probe of the scene again and filters it on the GPU, a piece of the work a call (a face, a slice of the filter), so that frames stay short: call it after render() of a frame, until
  /// `ready`. Faces show the scene as it is in their call, lit by the probes as they are: each refresh of all probes is a bounce more. Until then the old light holds; it waits for nothing. Another
  /// probe than in the call before begins anew, and so does a set whose revision moved, which also takes back what refreshes wrote. The probe needs light of a size (a power of two, 16 or more) and
  /// number of levels: black levels do. Radiance over 65504 cd/m² is held there. The lattice (AmbientGrid) is not refreshed.
  Result<ProbeRefresh> refreshProbe(const Scene& scene, std::size_t probe, const Quality& quality);
  /// Frees what the renderer holds for a scene (its uploads live until this, or until the renderer goes).
  void release(const Scene& scene);
  [[nodiscard]] const Report& report() const;  ///< warnings of uploads and light ranges so far

 private:
  Renderer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// An off-screen target: colour RGBA8 (Display) or RGBA32F (Linear). Owns a framebuffer in the current context.
class BURNISH_API OffscreenTarget {
 public:
  static Result<std::unique_ptr<OffscreenTarget>> create(const ProcAddress& getProcAddress, glm::ivec2 size, Output output);
  ~OffscreenTarget();
  [[nodiscard]] Target target() const;
  /// Reads the picture back, rows from top to bottom: U8 RGBA or F32 RGBA.
  [[nodiscard]] Result<Image> read() const;

 private:
  OffscreenTarget();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace burnish
