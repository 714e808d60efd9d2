// The frame plan: what one frame will do and why, as data. A pure function of scene, views, quality and capabilities; no GL context is needed to make, print or compare one.
// After it, what goes into a frame besides the scene, and what comes out: the target, the host's depth and drawing, timing, statistics.
#pragma once
#include <burnish/context.h>
#include <burnish/quality.h>
#include <burnish/scene.h>

namespace burnish {

/// Where the eye is and what part of the target it fills.
struct View {
  glm::dvec3 eye{0, 0, 0};
  glm::dmat3 axes{1};       ///< columns: right, up, back, world space, orthonormal (the eye looks along -back)
  bool orthographic = false;
  float fovY = 0.8726646f;  ///< radians
  float height = 2;         ///< metres (orthographic)
  float near = 0.05f, far = 0;  ///< as Camera's
  glm::ivec4 viewport{0};   ///< x, y (from the bottom), width, height in pixels; zero size: the whole target
  bool cut = false;         ///< the camera jumped: antialiasing=temporal begins anew in this frame
};
/// eye, target and up in metres, world space. Degenerate input (eye = target, up parallel) gives a valid view that looks somewhere sensible.
BURNISH_API View lookAt(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up = {0, 1, 0}, float fovY = 0.8726646f);
BURNISH_API View viewOf(const Scene& scene, const Camera& camera);
/// A view that shows the scene's bounds whole, from above the front right.
BURNISH_API View framingView(const Scene& scene, float aspect);

enum class Output : std::uint8_t {
  Display,  ///< tone mapped, exposed, sRGB-encoded
  Linear,   ///< linear radiance in cd/m², untouched by exposure, float
};
/// What is drawn in place of the final picture.
enum class DebugView : std::uint8_t { Final, Albedo, Substance, Normal, Roughness, Depth, Position, Occlusion, Lights, Nonfinite, Anisotropy, DiffuseRoughness };
BURNISH_API std::span<const std::string_view> debugViewNames();  ///< in the order of the enum

enum class CalledBy : std::uint8_t { Scene, Setting };
/// What an effect is. The whole list, in the order in which a plan judges them:
struct EffectInfo {
  std::string_view name;
  CalledBy calledBy = CalledBy::Scene;  ///< by what is in view, or by a setting or request
  std::string_view what;                ///< one line
};
BURNISH_API std::span<const EffectInfo> effectList();

struct EffectPlan {
  std::string name;
  bool on = false;
  CalledBy calledBy = CalledBy::Scene;
  std::string reason;  ///< why it is on, or what would call for it
  int objects = 0;     ///< instances or lights in view that call for it, counted once a view; 0 where it is off, or called for by a setting or the surroundings
  std::vector<std::string> passes, programs, targets;  ///< those that it calls for, alone or with others; empty when it is off
  std::uint64_t bytes = 0;                             ///< of those targets
};
struct PassPlan {
  std::string name;
  std::vector<std::string> effects;        ///< that call for it and are on
  std::vector<std::string> reads, writes;  ///< names of targets and tables
  std::vector<std::string> programs;       ///< names, each in FramePlan::programs
};
struct TargetPlan {
  std::string name, format;  ///< format: GL's name without the prefix ("RGBA16F")
  int width = 0, height = 0;
  int levels = 1;  ///< of its mip chain
  int layers = 0;  ///< of an array; 0: it is none
  std::uint64_t bytes = 0;
  std::vector<std::string> effects;  ///< that call for it and are on
  friend bool operator==(const TargetPlan&, const TargetPlan&) = default;
};
/// One program: entry points and the definitions that are specialised into it.
struct ProgramPlan {
  std::string name;               ///< "gbuffer", "gbuffer+alpha", "lighting/tile4", ...
  std::string vertex, fragment;   ///< shader files, "lighting/tile.frag"
  std::vector<std::string> defines;  ///< "NAME value", sorted
  std::string compute;               ///< in place of the two other files
  friend bool operator==(const ProgramPlan&, const ProgramPlan&) = default;
};

struct FramePlan {
  std::vector<EffectPlan> effects;
  std::vector<PassPlan> passes;
  std::vector<ProgramPlan> programs;
  std::vector<TargetPlan> targets;
  int gbufferBytesPerPixel = 0;  ///< colour targets, depth aside
  [[nodiscard]] BURNISH_API bool on(std::string_view effect) const;
  [[nodiscard]] BURNISH_API const PassPlan* pass(std::string_view name) const;
  [[nodiscard]] BURNISH_API const TargetPlan* target(std::string_view name) const;
};

/// How light culling learns the depth range of each tile. Both give the same lists.
enum class TileBounds : std::uint8_t {
  Automatic,  ///< Readback on software renderers, Reduction elsewhere
  Readback,   ///< the depth buffer is read back and reduced on the CPU
  Reduction,  ///< a pass reduces it; one texel a tile is read back
};

struct PlanOptions {
  glm::ivec2 size{0};  ///< of the target, pixels
  Output output = Output::Display;
  DebugView debugView = DebugView::Final;
  bool hostDepthIn = false, hostDepthOut = false, hostDraw = false;
  bool countNonfinite = false;
  int sequence = 0;  ///< RenderRequest::sequence
  bool displayLight = false;  ///< RenderRequest::displayLight
  TileBounds tileBounds = TileBounds::Automatic;
  /// Plans as if everything in the scene were in view: what Renderer::warmUp wants, so that turning around compiles nothing. An executed plan is of what the views see.
  bool wholeScene = false;
  /// Effects taken off the list: never planned, not even listed. Unknown names do nothing.
  std::vector<std::string> removed;
  /// Effects called by the scene that are planned though nothing in view calls for them. Unknown names and effects called by settings do nothing.
  std::vector<std::string> forced;
};
BURNISH_API FramePlan makePlan(const Scene& scene, std::span<const View> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options);

/// Depth that the host brings or takes. Texture: 2D DEPTH_COMPONENT*, the target's size.
struct HostDepth {
  unsigned texture = 0;
  float near = 0.1f, far = 1000;  ///< of the host's projection; far 0: infinite
  bool reversed = false;          ///< 1 at the near plane
};

/// What the host's draw callback gets: bound framebuffer (light buffer + depth), matrices, pre-exposure. It may change any GL state that HostState::Save lists.
struct HostDraw {
  unsigned framebuffer = 0;
  glm::mat4 viewProjection{1};  ///< camera-relative world space (world minus eye) to clip space, depth reversed in [0,1]; with antialiasing=temporal it moves by parts of a pixel
  glm::dvec3 eye{0};
  glm::ivec4 viewport{0};       ///< of the framebuffer, which is smaller than the target where Quality::resolutionScale is below 1
  float exposure = 1;           ///< multiply radiance in cd/m² by this before writing it
};

struct Target {
  unsigned framebuffer = 0;  ///< drawn to; colour attachment 0 (8-bit for Output::Display: the engine encodes sRGB itself)
  glm::ivec2 size{0};
  std::optional<HostDepth> depthIn;   ///< occludes the engine's scene (Target must be written by the host first)
  std::optional<HostDepth> depthOut;  ///< receives the engine's depth (of the nearest pixel, where Quality::resolutionScale is below 1)
};

enum class TimingMode : std::uint8_t { Off, Async, Profile };  ///< Profile finishes between passes: right on software renderers, slow on others

struct PassTime {
  std::string name;
  double gpuMs = 0, cpuMs = 0;  ///< cpuMs: user + system time of the process between the pass's ends; only with Profile
};
struct FrameStats {
  std::vector<PassTime> passes;  ///< of the latest frame whose queries have arrived (Async: some frames ago)
  int draws = 0, lightsInView = 0, lights = 0;
  std::uint64_t triangles = 0;
  int shadowMapsDrawn = 0, shadowMapsKept = 0;          ///< drawn in this frame; still right from an earlier one
  int shadowDraws = 0;                                  ///< calls that drew casters into them
  std::uint64_t uploadedBytes = 0, pendingUploads = 0;  ///< pending: resources still waiting for their turn
  std::uint64_t textureBytes = 0;                       ///< all textures and targets alive
  std::uint64_t nonfinitePixels = 0;                    ///< in the light buffer; only with RenderRequest::countNonfinite
  std::vector<std::string> glErrors;                    ///< debug messages of type error and glGetError's
  float exposureEv = 0;                                 ///< EV100 that the picture was developed with; automatic exposure: only with RenderRequest::countNonfinite, else 0
};

struct RenderRequest {
  Output output = Output::Display;
  DebugView debugView = DebugView::Final;
  TimingMode timing = TimingMode::Off;
  bool displayLight = false;    ///< with Output::Linear: radiance is gathered as for a display (Quality::lightBuffer's format, pre-exposed), so that its rounding shows; else in 32-bit floats
  bool countNonfinite = false;  ///< waits for the GPU; with automatic exposure it reads FrameStats::exposureEv too
  /// Which pictures this one follows: antialiasing=temporal keeps a history for each number, and in it one for each view in order. Calls that take turns (two windows, a mirror) give
  /// each its own.
  int sequence = 0;
  std::function<void(const HostDraw&)> hostDraw;  ///< called after lighting, before tone mapping, once per view
};

}  // namespace burnish
