// Executes frame plans: for each view the plan's passes in order, each a function of its module.
#include <burnish/renderer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "gbuffer/geometry_pass.h"
#include "gl/host_state.h"
#include "gl/timers.h"
#include "gpu_scene/frame.h"
#include "lighting/lighting_pass.h"
#include "post/post_pass.h"

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
float guessedExposure(const scene::LightSet& lights, const gpu_scene::GpuEnvironment* environment, float scale) {
  constexpr glm::vec3 kLuminance(0.2126f, 0.7152f, 0.0722f);
  float luminance = environment ? environment->meanLuminance * scale : 0;
  for (const scene::DirectionalLight& l : lights.directional) luminance += glm::dot(l.illuminance, kLuminance) * 0.06f;
  float brightest = 0;
  for (const scene::LocalLight& l : lights.local) brightest = std::max(brightest, glm::dot(l.intensity, kLuminance) * 0.02f);
  luminance += brightest;
  if (!(luminance > 0) || !std::isfinite(luminance)) return 1;
  return exposureOf(std::log2(luminance * 8));
}

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
  std::unique_ptr<lighting::LightingPass> lighting;
  std::unique_ptr<gl::FrameTimers> timers;
  gpu_scene::FrameBuffers buffers;
  std::map<std::uint64_t, std::unique_ptr<SceneState>> scenes;
  FramePlan plan;
  Report report;
  std::size_t reported = 0;
  std::optional<Quality> reportedQuality;
  std::vector<scene::VisibleInstance> visible;

  SceneState& stateOf(const Scene& scene) {
    std::unique_ptr<SceneState>& s = scenes[scene.identity.value()];
    if (!s) s = std::make_unique<SceneState>(*device);
    return *s;
  }
  void logNewWarnings() {
    for (; reported < report.warnings().size(); ++reported)
      if (options.log) options.log(LogLevel::Warning, report.warnings()[reported].message());
  }
  /// Says once what the quality asks for and does not get as asked.
  void reportQuality(const Quality& quality) {
    if (quality == reportedQuality) return;
    reportedQuality = quality;
    if (const std::string rung = forwardOnlyRung(quality); !rung.empty() && plan.on("forward_reference"))
      report.warn("quality", fmt::format("{} needs what the G-buffer does not hold: drawn by the forward reference path (slow)", rung));
    for (const std::string& text : idleRungs(quality)) report.warn("quality", text);
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
    o.tileBounds = options.tileBounds;
    return o;
  }
  Result<void> checkRequest(const Target& target, std::span<const View> views) const;
  Result<void> renderView(SceneState& state, const Scene& scene, const View& view, const Target& target, const Quality& quality, const RenderRequest& request, bool first, FrameStats& stats);
  Result<void> runPass(const PassPlan& pass, FrameContext& c, const Target& target, const RenderRequest& request);
  void callHost(FrameContext& c, const RenderRequest& request, GLuint framebuffer);
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

void Renderer::Impl::callHost(FrameContext& c, const RenderRequest& request, GLuint framebuffer) {
  HostDraw draw;
  draw.framebuffer = framebuffer;
  draw.viewProjection = glm::mat4(c.view.viewProjection);
  draw.eye = c.view.eye;
  draw.viewport = c.view.viewport;
  draw.exposure = c.preExposure;
  c.device.gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  c.setViewport();
  c.device.gl.Enable(GL_DEPTH_TEST);
  c.device.gl.DepthFunc(GL_GREATER);
  request.hostDraw(draw);
  // The callback may have changed anything: back to the state that passes start from.
  gl::setDefaults(c.device);
  c.device.gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  c.buffers.frame.bindBase(GL_UNIFORM_BUFFER, BINDING_FRAME);
}

Result<void> Renderer::Impl::runPass(const PassPlan& pass, FrameContext& c, const Target& target, const RenderRequest& request) {
  gl::DebugGroup group(*device, pass.name);
  gl::PassTimer timer(*timers, pass.name);
  const auto writesHalf = [&c]() -> Result<GLuint> { return c.targets.texture("depth") ? c.targets.framebuffer({"light"}, "depth") : c.targets.framebuffer({"light"}); };
  if (pass.name == "depth_in") return post::takeHostDepth(c, *target.depthIn);
  if (pass.name == "gbuffer") return gbuffer::drawGBuffer(c);
  if (pass.name == "forward") {
    if (auto bound = lighting->bindForward(c); !bound) return bound;
    return gbuffer::drawForward(c);
  }
  if (pass.name == "tiles") return lighting->buildTiles(c);
  if (pass.name == "lighting") return lighting->shadeTiles(c);
  if (pass.name == "emissive") return gbuffer::drawEmissive(c);
  if (pass.name == "background") return lighting->drawBackground(c);
  if (pass.name == "host_draw") {
    auto framebuffer = writesHalf();
    if (!framebuffer) return fail(framebuffer.error());
    callHost(c, request, *framebuffer);
    return {};
  }
  if (pass.name == "exposure") return post::measureExposure(c);
  if (pass.name == "nonfinite_count") {
    c.stats.nonfinitePixels += post::countNonfinite(c);
    if (plan.on("auto_exposure")) c.stats.exposureEv = post::readExposure(c);
    return {};
  }
  if (pass.name == "tonemap") return post::drawTonemap(c, target.framebuffer);
  if (pass.name == "debug_view") {
    if (request.debugView != DebugView::Lights) return post::drawDebugView(c, target.framebuffer);
    c.device.gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    c.device.gl.Disable(GL_DEPTH_TEST);
    if (const gl::Program* program = c.programs.find("debug_lights")) program->use();
    lighting->drawAllTiles(c);
    return {};
  }
  if (pass.name == "depth_out") return post::giveHostDepth(c, *target.depthOut);
  return fail("frame plan", fmt::format("pass '{}' is unknown", pass.name), "report this as a fault of the engine");
}

Result<void> Renderer::Impl::renderView(SceneState& state, const Scene& scene, const View& view, const Target& target, const Quality& quality, const RenderRequest& request, bool first,
                                        FrameStats& stats) {
  const scene::ViewFrame frame = scene::frameOf(view, target.size);
  scene::findVisible(scene, state.derived, frame, visible);
  const scene::LightSet lights = scene::gatherLights(scene, state.derived, frame, quality, report);
  const gpu_scene::GpuEnvironment* environment = nullptr;
  if (plan.on("environment_lighting") || plan.on("background")) {
    auto found = state.gpu.environment(scene, report);
    if (!found) return fail(found.error());
    environment = *found;
  }
  FrameContext c{*device, plan, *programSet, *targets, state.gpu, buffers, scene, quality, frame, visible, lights, environment, target.size, 1, plan.target("tile_depth") != nullptr, first, report, stats};
  const float display = quality.exposureEv ? exposureOf(*quality.exposureEv) : 1;
  if (request.output == Output::Display) c.preExposure = quality.exposureEv ? display : guessedExposure(lights, environment, scene.environment.scale);
  if (auto done = gpu_scene::uploadFrameData(c, display); !done) return done;
  if (auto done = gpu_scene::uploadDraws(c); !done) return done;
  // Where no pass covers the whole light buffer, it starts black.
  if (plan.target("light") && !plan.pass("background")) {
    auto framebuffer = c.targets.framebuffer({"light"});
    if (!framebuffer) return fail(framebuffer.error());
    c.setViewport();
    const float black[4] = {0, 0, 0, 1};
    device->gl.ClearNamedFramebufferfv(*framebuffer, GL_COLOR, 0, black);
  }
  if (request.debugView == DebugView::Lights) {
    c.setViewport();
    const float black[4] = {0, 0, 0, 1};
    device->gl.ClearNamedFramebufferfv(target.framebuffer, GL_COLOR, 0, black);
  }
  for (const PassPlan& pass : plan.passes)
    if (auto done = runPass(pass, c, target, request); !done) return done;
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
  auto lighting = lighting::LightingPass::create(*m.device);
  if (!lighting) return fail(lighting.error());
  m.lighting = std::move(*lighting);
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
  m.plan = makePlan(scene, views, quality, m.device->caps, m.planOptions(target, request));
  if (m.plan.on("forward_reference") && target.depthIn)
    return fail("target", "it brings depth, which the forward reference path cannot take in", "leave depthIn empty, or use path=deferred and rungs that are not forward-only");
  m.reportQuality(quality);
  FrameStats stats;
  Result<void> done = m.programSet->prepare(m.plan);
  if (done) done = m.targets->prepare(m.plan);
  SceneState& state = m.stateOf(scene);
  if (done) done = state.gpu.beginFrame(scene, m.options.uploadBytesPerFrame, m.report);
  state.derived.update(scene);
  m.timers->beginFrame(timingOf(request.timing));
  for (std::size_t i = 0; i < views.size() && done; ++i) done = m.renderView(state, scene, views[i], target, quality, request, i == 0, stats);
  m.timers->endFrame();
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
  const scene::ViewFrame whole = scene::frameOf(view, targetSize);
  const glm::ivec2 local = pixel - glm::ivec2(whole.viewport.x, whole.viewport.y);
  if (local.x < 0 || local.y < 0 || local.x >= whole.viewport.z || local.y >= whole.viewport.w) return Id<Instance>{};
  const CallState callState(*m.device, m.options.hostState);
  // A frame of one pixel whose only pass draws ids.
  FramePlan plan;
  plan.targets = {{"pick", "R32UI", 1, 1, 4}, {"pick_depth", "DEPTH_COMPONENT32F", 1, 1, 4}};
  for (int key = 0; key < 4; ++key) plan.programs.push_back(plan::geometryProgram(plan::GeometryPass::Pick, {(key & 1) != 0, (key & 2) != 0, false}, false));
  gpu_scene::ProgramSet programs(*m.device, *m.programs);
  gpu_scene::TargetPool targets(*m.device);
  if (auto done = programs.prepare(plan); !done) return fail(done.error());
  if (auto done = targets.prepare(plan); !done) return fail(done.error());
  SceneState& state = m.stateOf(scene);
  if (auto done = state.gpu.beginFrame(scene, 0, m.report); !done) return fail(done.error());
  state.derived.update(scene);
  const scene::ViewFrame frame = scene::narrowed(whole, local);
  scene::findVisible(scene, state.derived, frame, m.visible);
  const scene::LightSet lights;
  const Quality quality;
  FrameStats stats;
  FrameContext c{*m.device, plan, programs, targets, state.gpu, m.buffers, scene, quality, frame, m.visible, lights, nullptr, {1, 1}, 1, false, true, m.report, stats};
  if (auto done = gpu_scene::uploadFrameData(c, 1); !done) return fail(done.error());
  if (auto done = gpu_scene::uploadDraws(c); !done) return fail(done.error());
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
