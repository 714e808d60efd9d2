// The frame plan: what one frame will do and why, as data. A pure function of scene, views, quality and capabilities; no GL context is needed to make, print or compare one.
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
  TileBounds tileBounds = TileBounds::Automatic;
  /// Plans as if everything in the scene were in view: what Renderer::warmUp wants, so that turning around compiles nothing. An executed plan is of what the views see.
  bool wholeScene = false;
  /// Effects taken off the list: never planned, not even listed. Unknown names do nothing.
  std::vector<std::string> removed;
  /// Effects called by the scene that are planned though nothing in view calls for them. Unknown names and effects called by settings do nothing.
  std::vector<std::string> forced;
};
BURNISH_API FramePlan makePlan(const Scene& scene, std::span<const View> views, const Quality& quality, const Capabilities& caps, const PlanOptions& options);

}  // namespace burnish
