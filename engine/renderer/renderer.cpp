// Executes frame plans: for each view the plan's passes in order, each a function of its module.
#include <burnish/renderer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "gbuffer/geometry_pass.h"
#include "gl/host_state.h"
#include "interface/limits.h"
#include "plan/plan.h"
#include "plan/temporal.h"
#include "renderer/history.h"
#include "renderer/passes.h"

namespace burnish {
namespace {

using gpu_scene::FrameContext;

struct SceneState {
  explicit SceneState(gl::Device& device) : gpu(device) {}
  gpu_scene::GpuScene gpu;
  scene::Derived derived;
};

gl::Timing timingOf(TimingMode mode) { return mode == TimingMode::Async ? gl::Timing::Async : mode == TimingMode::Profile ? gl::Timing::Profile : gl::Timing::Off; }

/// 1 / (1.2 · 2^EV100): radiance that this factor takes to 1 saturates (Lagarde and de Rousiers 2014, section 5.1).
float exposureOf(float ev) { return 1.0f / (1.2f * std::exp2(std::clamp(ev, -30.0f, 40.0f))); }

/// Where the light buffer's range is centred when the exposure is automatic: a rough guess is enough, half floats have nine decades to spare.
float guessedExposure(const scene::LightSet& lights, const gpu_scene::GpuEnvironment* environment, float scale, float places) {
  constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
  float luminance = std::max(environment ? environment->meanLuminance * scale : 0, places);
  for (const scene::DirectionalLight& l : lights.directional) luminance += glm::dot(l.illuminance, kLuminance) * 0.06f;
  float brightest = 0;
  for (const scene::LocalLight& l : lights.local) brightest = std::max(brightest, glm::dot(l.intensity, kLuminance) * 0.02f);
  luminance += brightest;
  if (!(luminance > 0) || !std::isfinite(luminance)) return 1;
  return exposureOf(std::log2(luminance * 8));
}

/// Luminance of the brightest captured place in view, on the mean.
float brightestPlace(const Scene& scene, std::span<const scene::SeenProbe> probes) {
  double brightest = 0;
  for (const scene::SeenProbe& p : probes) {
    const std::array<double, 3>& mean = scene.probes.reflections[p.index].irradiance[0];
    brightest = std::max(brightest, 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2]);
  }
  return std::isfinite(brightest) ? float(brightest) : 0.0f;
}

/// What of the settings is out of range, and what the passes use instead.
std::vector<std::string> heldSettings(const Quality& q) {
  std::vector<std::string> texts;
  const auto check = [&](const char* name, double value, double low, double high, double otherwise) {
    if (value >= low && value <= high) return;
    texts.push_back(fmt::format("Quality::{} is {}, out of {} to {}: {} is used", name, value, low, high, std::isfinite(value) ? std::clamp(value, low, high) : otherwise));
  };
  check("transparentLayers", q.transparentLayers, 1, 64, 1);
  if (q.bloom != Bloom::None) check("bloomShare", double(q.bloomShare), 0, 1, 0);
  if (q.occlusion > Occlusion::Baked) check("occlusionRadius", double(q.occlusionRadius), double(1e-3f), double(1e3f), 1);
  return texts;
}
/// Some pass draws instances: their transforms and materials are wanted.
bool drawsInstances(const FramePlan& plan) { return plan::reads(plan, "meshes"); }

/// The GL state of one call: the host's is saved (HostState::Save) and the engine starts from defaults; at the end, on every path, the host finds what it was promised.
class CallState {
 public:
  CallState(const gl::Device& device, HostState promise) : device_(device) {
    if (promise == HostState::Save)
      guard_.emplace(device);
    else
      gl::setDefaults(device);
    device.gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  }
  ~CallState() {
    if (!guard_) gl::setDefaults(device_);
  }
  CallState(const CallState&) = delete;
  CallState& operator=(const CallState&) = delete;

 private:
  const gl::Device& device_;
  std::optional<gl::HostStateGuard> guard_;
};

}  // namespace

struct Renderer::Impl {
  RendererOptions options;
  std::unique_ptr<gl::Device> device;
  std::unique_ptr<gl::ProgramCache> programs;
  std::unique_ptr<gpu_scene::TargetPool> targets;
  std::unique_ptr<gpu_scene::ProgramSet> programSet;
  std::unique_ptr<Modules> modules;
  std::unique_ptr<gl::FrameTimers> timers;
  gpu_scene::FrameBuffers buffers;
  std::map<std::uint64_t, std::unique_ptr<SceneState>> scenes;
  FramePlan plan;
  Report report;
  std::size_t reported = 0;
  std::optional<Quality> reportedQuality;
  std::vector<bool> loggedEffects;
  std::vector<plan::Seen> seen;  // of each view
  float preExposure = 1;         // of the view drawn last
  std::map<int, History> histories;  // by sequence, while antialiasing over time is on

  SceneState& stateOf(const Scene& scene) {
    std::unique_ptr<SceneState>& s = scenes[scene.identity.value()];
    if (!s) s = std::make_unique<SceneState>(*device);
    return *s;
  }
  void logNewWarnings() {
    for (; reported < report.warnings().size(); ++reported)
      if (options.log) options.log(LogLevel::Warning, report.warnings()[reported].message());
  }
  /// Every effect that went on or off since the last frame, with its reason.
  void logEffects() {
    if (!options.log) return;
    loggedEffects.resize(plan.effects.size());
    for (std::size_t i = 0; i < plan.effects.size(); ++i) {
      const EffectPlan& e = plan.effects[i];
      if (e.on != loggedEffects[i]) options.log(LogLevel::Info, fmt::format("effect '{}' {}: {}", e.name, e.on ? "on" : "off", e.reason));
      loggedEffects[i] = e.on;
    }
  }
  /// Says once what the quality asks for and does not get as asked.
  void reportQuality(const Quality& quality) {
    if (quality == reportedQuality) return;
    reportedQuality = quality;
    if (const std::string rung = forwardOnlyRung(quality); !rung.empty() && plan.on("forward_reference"))
      report.warn("quality", fmt::format("{} needs what the G-buffer does not hold: drawn by the forward reference path (slow)", rung));
    for (const std::string& text : idleRungs(quality)) report.warn("quality", text);
    for (const std::string& text : heldSettings(quality)) report.warn("quality", text);
  }
  /// Light lists hold indices of 16 bits, and a buffer texture all lights and the records of their shadows. The rest is off, on every path alike.
  void boundLights(scene::LightSet& lights, const scene::ShadowSet& shadows) {
    const std::size_t room = std::size_t(device->caps.maxTextureBufferTexels) - SHADOW_TEXELS * shadows.locals.size(), most = std::min<std::size_t>(65534, room / LIGHT_TEXELS - 1);
    if (lights.local.size() <= most) return;
    report.warn("lights", fmt::format("{} point and spot lights reach into view: {} is the limit, those past it are off (give them shorter ranges)", lights.local.size(), most));
    lights.local.resize(most);
  }
  PlanOptions planOptions(const Target& target, const RenderRequest& request) const {
    PlanOptions o;
    o.size = target.size;
    o.output = request.output;
    o.debugView = request.debugView;
    o.hostDepthIn = target.depthIn.has_value();
    o.hostDepthOut = target.depthOut.has_value();
    o.hostDraw = bool(request.hostDraw);
    o.countNonfinite = request.countNonfinite;
    o.sequence = request.sequence;
    o.tileBounds = options.tileBounds;
    o.removed = options.removedEffects;
    o.forced = options.forcedEffects;
    return o;
  }
  Result<void> checkRequest(const Target& target, std::span<const View> views) const;
  /// What is remembered of the sequence, ready for this frame; nullptr: nothing is, antialiasing over time is off.
  History* historyOf(const Scene& scene, const scene::Derived& derived, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request, const PlanOptions& planned);
  Result<void> renderView(SceneState& state, const Scene& scene, plan::Seen& view, const gpu_scene::PastFrame& past, const Target& target, const Quality& quality, const RenderRequest& request, FrameStats& stats);
};

Result<void> Renderer::Impl::checkRequest(const Target& target, std::span<const View> views) const {
  if (target.size.x <= 0 || target.size.y <= 0)
    return fail("target", fmt::format("its size is {} x {} pixels", target.size.x, target.size.y), "give it at least 1 x 1, or skip the frame while the window is minimised");
  const int limit = device->caps.maxTextureSize;
  if (target.size.x > limit || target.size.y > limit)
    return fail("target", fmt::format("its size is {} x {} pixels and {} is the device's limit", target.size.x, target.size.y, limit), "render a smaller picture");
  if (views.empty()) return fail("views", "there is none", "give at least one View");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const glm::ivec4 v = views[i].viewport;
    const bool whole = v.z <= 0 || v.w <= 0;
    if (!whole && (v.x < 0 || v.y < 0 || v.x + v.z > target.size.x || v.y + v.w > target.size.y))
      return fail(fmt::format("view {}", i), fmt::format("its viewport ({}, {}, {}, {}) leaves the target of {} x {}", v.x, v.y, v.z, v.w, target.size.x, target.size.y), "keep it inside");
  }
  return {};
}

History* Renderer::Impl::historyOf(const Scene& scene, const scene::Derived& derived, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request, const PlanOptions& planned) {
  if (!plan::keepsHistory(quality, planned)) {
    histories.erase(request.sequence);
    if (quality.antialiasing == Antialiasing::Temporal && planned.hostDepthIn) report.warn("antialiasing", "temporal is off where the target brings depth: what the host drew has no history; use antialiasing=edge");
    return nullptr;
  }
  History& history = histories[request.sequence];
  history.begin(scene, derived, views, target, quality, request);
  return &history;
}

Result<void> Renderer::Impl::renderView(SceneState& state, const Scene& scene, plan::Seen& view, const gpu_scene::PastFrame& past, const Target& target, const Quality& quality, const RenderRequest& request, FrameStats& stats) {
  const gpu_scene::GpuEnvironment* environment = nullptr;
  if (plan.on("environment_lighting") || plan.on("background")) {
    auto found = state.gpu.environment(scene, {.cube = plan::reads(plan, "environment cube"), .picture = plan::reads(plan, "environment")}, report);
    if (!found) return fail(found.error());
    environment = *found;
  }
  const gpu_scene::GpuProbes* probeLight = nullptr;
  if (plan::reads(plan, "probe cubes")) {
    auto found = state.gpu.probes(scene, report);
    if (!found) return fail(found.error());
    probeLight = *found;
  }
  const gpu_scene::GpuGrid* grid = nullptr;
  if (plan::reads(plan, "ambient lattice")) {
    auto found = state.gpu.grid(scene, report);
    if (!found) return fail(found.error());
    grid = *found;
  }
  FrameContext c{.device = *device, .plan = plan, .programs = *programSet, .targets = *targets, .gpuScene = state.gpu, .buffers = buffers, .scene = scene, .quality = quality, .view = view.frame,
                 .visible = view.instances, .batches = view.batches, .lights = view.lights, .transparent = view.transparent, .shadows = &view.shadows, .environment = environment, .probes = view.probes, .grid = grid, .probeLight = probeLight, .size = target.size, .output = target.framebuffer, .past = past, .moved = view.moved, .report = report, .stats = stats};
  const float display = quality.exposureEv ? exposureOf(*quality.exposureEv) : 1;
  if (request.output == Output::Display) c.preExposure = quality.exposureEv ? display : guessedExposure(view.lights, environment, scene.environment.scale, std::max(brightestPlace(scene, view.probes), grid ? grid->luminance : 0.0f));
  preExposure = c.preExposure;
  if (auto done = gpu_scene::uploadFrameData(c, display); !done) return done;
  if (drawsInstances(plan))
    if (auto done = gpu_scene::uploadDraws(c); !done) return done;
  if (plan::reads(plan, "probe records"))
    if (auto done = gpu_scene::uploadProbeRecords(c); !done) return done;
  if (grid)
    if (auto done = gpu_scene::uploadGridData(c); !done) return done;
  stats.lightsInView += int(view.lights.directional.size());
  PassCall call{c, *modules, target, request};
  for (const PassPlan& pass : plan.passes)
    if (auto done = runPass(pass, call, *timers); !done) return done;
  return {};
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const ProcAddress& getProcAddress, const RendererOptions& options) {
  std::unique_ptr<Renderer> renderer(new Renderer);
  Impl& m = *renderer->impl_;
  m.options = options;
  auto device = gl::Device::create(getProcAddress, options.debugOutput);
  if (!device) return fail(device.error());
  m.device = std::move(*device);
  const CallState callState(*m.device, options.hostState);
  m.programs = std::make_unique<gl::ProgramCache>(*m.device, gl::ShaderLibrary(options.shaderOverride), options.programCache);
  m.targets = std::make_unique<gpu_scene::TargetPool>(*m.device);
  m.programSet = std::make_unique<gpu_scene::ProgramSet>(*m.device, *m.programs);
  m.timers = std::make_unique<gl::FrameTimers>(*m.device);
  auto buffers = gpu_scene::FrameBuffers::create(*m.device);
  if (!buffers) return fail(buffers.error());
  m.buffers = std::move(*buffers);
  m.modules = std::make_unique<Modules>(*m.device);
  return renderer;
}

const Capabilities& Renderer::capabilities() const { return impl_->device->caps; }
const FramePlan& Renderer::lastPlan() const { return impl_->plan; }
const Report& Renderer::report() const { return impl_->report; }
void Renderer::release(const Scene& scene) { impl_->scenes.erase(scene.identity.value()); }

Result<int> Renderer::warmUp(const FramePlan& plan) {
  std::vector<gl::ProgramSource> sources;
  for (const ProgramPlan& p : plan.programs) sources.push_back(gpu_scene::sourceOf(p));
  return impl_->programs->warmUp(sources);
}

Result<FrameStats> Renderer::render(const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request) {
  Impl& m = *impl_;
  if (auto good = m.checkRequest(target, views); !good) return fail(good.error());
  const CallState callState(*m.device, m.options.hostState);
  SceneState& state = m.stateOf(scene);
  state.derived.update(scene, &m.report);
  const PlanOptions options = m.planOptions(target, request);
  History* history = m.historyOf(scene, state.derived, views, target, quality, request, options);
  m.seen.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    plan::look(scene, state.derived, views[i], target.size, quality, m.report, m.seen[i], history ? history->jitter(i) : glm::dvec2(0));
    m.boundLights(m.seen[i].lights, m.seen[i].shadows);
    m.seen[i].moved = history ? history->motion().among(m.seen[i].instances) : std::vector<scene::Moved>{};
  }
  m.plan = plan::planOf(scene, m.seen, quality, m.device->caps, options, nullptr);
  for (plan::Seen& seen : m.seen) {
    if (!m.plan.on("directional_lights")) seen.lights.directional.clear();
    if (!m.plan.on("local_lights")) seen.lights.local.clear();
    if (!m.plan.on("reflection_probes")) seen.probes.clear();
    if (!m.plan.on("shadows")) seen.shadows = {};
    if (!m.plan.on("directional_lights")) scene::dropShadows(seen.shadows, true);
    if (!m.plan.on("local_lights")) scene::dropShadows(seen.shadows, false);
    if (m.plan.on("deformation")) continue;
    std::erase_if(seen.moved, [&seen](const scene::Moved& moved) { return seen.instances[moved.visible].pose != nullptr; });
    for (scene::VisibleInstance& v : seen.instances)
      if (v.pose) scene::makeRigid(scene, state.derived, seen.frame, v);
    for (scene::ShadowCaster& caster : seen.shadows.casters)
      if (caster.placed.pose) scene::makeRigid(scene, state.derived, caster.placed);
  }
  if (m.plan.on("forward_reference") && target.depthIn)
    return fail("target", "it brings depth, which the forward reference path cannot take in", "leave depthIn empty, or use path=deferred and rungs that are not forward-only");
  m.reportQuality(quality);
  m.logEffects();
  FrameStats stats;
  Result<void> done = m.programSet->prepare(m.plan);
  if (done) done = m.targets->prepare(m.plan);
  state.gpu.beginFrame(scene, m.options.uploadBytesPerFrame);
  if (done && drawsInstances(m.plan)) done = state.gpu.updateMaterials(scene);
  state.gpu.deformation().beginFrame(scene, history != nullptr);
  m.timers->beginFrame(timingOf(request.timing));
  for (std::size_t i = 0; i < views.size() && done; ++i) {
    gpu_scene::PastFrame past;
    if (history) past = history->past(i, m.targets->serial(plan::historyName(request.sequence, history->source())));
    past.sequence = request.sequence;
    done = m.renderView(state, scene, m.seen[i], past, target, quality, request, stats);
    if (history) history->drawn(i, m.seen[i].frame, m.preExposure);
  }
  m.timers->endFrame();
  if (history && done) history->end(m.targets->serial(plan::historyName(request.sequence, 1 - history->source())), state.gpu.pending() == 0);
  if (!done) m.histories.erase(request.sequence);
  if (m.options.debugOutput) stats.glErrors = m.device->takeErrors();
  m.logNewWarnings();
  if (!done) return fail(done.error());
  for (const gl::PassSample& s : m.timers->latest()) stats.passes.push_back({s.name, s.gpuMs, s.cpuMs});
  stats.lights = int(scene.lights.size());
  stats.uploadedBytes = state.gpu.uploadedBytes();
  stats.pendingUploads = state.gpu.pending();
  stats.textureBytes = std::uint64_t(m.device->textureBytes());
  if (quality.exposureEv) stats.exposureEv = *quality.exposureEv;
  return stats;
}

Result<Id<Instance>> Renderer::pick(const Scene& scene, const View& view, glm::ivec2 targetSize, glm::ivec2 pixel) {
  Impl& m = *impl_;
  Target target;
  target.size = targetSize;
  if (auto good = m.checkRequest(target, {&view, 1}); !good) return fail(good.error());
  if (scene.instances.capacity() >= (1u << 24) - 1) return fail("pick", fmt::format("the scene has {} instances and ids are exact up to {}", scene.instances.capacity(), (1u << 24) - 2), "pick in a smaller scene");
  const scene::ViewFrame whole = scene::frameOf(view, targetSize);
  const glm::ivec2 local = pixel - glm::ivec2(whole.viewport.x, whole.viewport.y);
  if (local.x < 0 || local.y < 0 || local.x >= whole.viewport.z || local.y >= whole.viewport.w) return Id<Instance>{};
  const CallState callState(*m.device, m.options.hostState);
  // A frame of one pixel whose only pass draws ids.
  FramePlan plan;
  plan.targets = {{"pick", "R32UI", 1, 1, 4}, {"pick_depth", "DEPTH_COMPONENT32F", 1, 1, 4}};
  for (int key = 0; key < 4; ++key) plan.programs.push_back(plan::geometryProgram(plan::GeometryPass::Pick, {(key & 1) != 0, (key & 2) != 0, false}, false));
  SceneState& state = m.stateOf(scene);
  state.derived.update(scene, &m.report);
  plan::Seen seen;
  seen.frame = scene::narrowed(whole, local);
  scene::findVisible(scene, state.derived, seen.frame, seen.instances);
  seen.batches = scene::singles(seen.instances);  // the programs that draw ids draw one at a time
  for (const plan::DeformVariant& v : plan::factsOf(scene, {&seen, 1}, {}, {}).deformVariants) plan.programs.push_back(plan::deformProgram(v));
  gpu_scene::ProgramSet programs(*m.device, *m.programs);
  gpu_scene::TargetPool targets(*m.device);
  if (auto done = programs.prepare(plan); !done) return fail(done.error());
  if (auto done = targets.prepare(plan); !done) return fail(done.error());
  state.gpu.beginFrame(scene, 0);
  if (auto done = state.gpu.updateMaterials(scene); !done) return fail(done.error());
  const Quality quality;
  FrameStats stats;
  FrameContext c{.device = *m.device, .plan = plan, .programs = programs, .targets = targets, .gpuScene = state.gpu, .buffers = m.buffers, .scene = scene, .quality = quality, .view = seen.frame,
                 .visible = seen.instances, .batches = seen.batches, .lights = seen.lights, .size = {1, 1}, .report = m.report, .stats = stats};
  if (auto done = gpu_scene::uploadFrameData(c, 1); !done) return fail(done.error());
  if (auto done = gpu_scene::uploadDraws(c); !done) return fail(done.error());
  if (auto done = gpu_scene::deform(c, seen.instances); !done) return fail(done.error());
  auto framebuffer = targets.framebuffer({"pick"}, "pick_depth");
  if (!framebuffer) return fail(framebuffer.error());
  m.device->gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  const GLuint nothing[4] = {};
  const float far = 0;
  m.device->gl.ClearNamedFramebufferuiv(*framebuffer, GL_COLOR, 0, nothing);
  m.device->gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &far);
  if (auto done = gbuffer::drawPick(c); !done) return fail(done.error());
  GLuint found = 0;
  m.device->gl.GetTextureSubImage(targets.texture("pick")->id(), 0, 0, 0, 0, 1, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT, sizeof found, &found);
  return found == 0 ? Id<Instance>{} : scene.instances.at(found - 1);
}

}  // namespace burnish
