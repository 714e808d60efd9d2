// Executes frame plans: for each view the plan's passes in order, each a function of its module.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interface/limits.h"
#include "plan/scaling.h"
#include "plan/temporal.h"
#include "renderer/impl.h"
#include "renderer/refresh.h"

namespace burnish {
namespace {

using gpu_scene::FrameContext;

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
  check("resolutionScale", double(q.resolutionScale), 0.25, 1, 1);
  check("transparentLayers", q.transparentLayers, 1, 64, 1);
  if (q.bloom != Bloom::None) check("bloomShare", double(q.bloomShare), 0, 1, 0);
  if (q.occlusion > Occlusion::Baked) check("occlusionRadius", double(q.occlusionRadius), double(1e-3f), double(1e3f), 1);
  return texts;
}
/// Some pass draws instances: their transforms and materials are wanted.
bool drawsInstances(const FramePlan& plan) { return plan::reads(plan, "meshes"); }

}  // namespace

Renderer::Impl::Impl() = default;
Renderer::Impl::~Impl() = default;

Result<std::unique_ptr<Series>> Series::create(gl::Device& device, gl::ProgramCache& programs, bool linkOnDemand) {
  std::unique_ptr<Series> series(new Series(device, programs, linkOnDemand));
  auto buffers = gpu_scene::FrameBuffers::create(device);
  if (!buffers) return fail(buffers.error());
  series->buffers = std::move(*buffers);
  return series;
}

SceneState& Renderer::Impl::stateOf(const Scene& scene) {
  std::unique_ptr<SceneState>& s = scenes[scene.identity.value()];
  if (!s) s = std::make_unique<SceneState>(*device);
  return *s;
}

void Renderer::Impl::logNewWarnings() {
  for (; reported < report.warnings().size(); ++reported)
    if (options.log) options.log(LogLevel::Warning, report.warnings()[reported].message());
}

void Renderer::Impl::logEffects() {
  if (!options.log) return;
  loggedEffects.resize(pictures->plan.effects.size());
  for (std::size_t i = 0; i < pictures->plan.effects.size(); ++i) {
    const EffectPlan& e = pictures->plan.effects[i];
    if (e.on != loggedEffects[i]) options.log(LogLevel::Info, fmt::format("effect '{}' {}: {}", e.name, e.on ? "on" : "off", e.reason));
    loggedEffects[i] = e.on;
  }
}

void Renderer::Impl::reportQuality(const Quality& quality) {
  if (quality == reportedQuality) return;
  reportedQuality = quality;
  if (const std::string rung = forwardOnlyRung(quality); !rung.empty() && pictures->plan.on("forward_reference"))
    report.warn("quality", fmt::format("{} needs what the G-buffer does not hold: drawn by the forward reference path (slow)", rung));
  for (const std::string& text : idleRungs(quality)) report.warn("quality", text);
  for (const std::string& text : heldSettings(quality)) report.warn("quality", text);
}

void Renderer::Impl::boundLights(scene::LightSet& lights, const scene::ShadowSet& shadows) {
  const std::size_t room = std::size_t(device->caps.maxTextureBufferTexels) - SHADOW_TEXELS * shadows.locals.size(), most = std::min<std::size_t>(65534, room / LIGHT_TEXELS - 1);
  if (lights.local.size() <= most) return;
  report.warn("lights", fmt::format("{} point and spot lights reach into view: {} is the limit, those past it are off (give them shorter ranges)", lights.local.size(), most));
  lights.local.resize(most);
}

PlanOptions Renderer::Impl::planOptions(const Target& target, const RenderRequest& request) const {
  PlanOptions o;
  o.size = target.size;
  o.output = request.output;
  o.debugView = request.debugView;
  o.hostDepthIn = target.depthIn.has_value();
  o.hostDepthOut = target.depthOut.has_value();
  o.hostDraw = bool(request.hostDraw);
  o.countNonfinite = request.countNonfinite;
  o.sequence = request.sequence;
  o.displayLight = request.displayLight;
  o.tileBounds = options.tileBounds;
  o.removed = options.removedEffects;
  o.forced = options.forcedEffects;
  return o;
}

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
  history.begin(scene, derived, views, target, quality, request, refreshes);
  return &history;
}

Result<void> Renderer::Impl::renderView(Series& series, SceneState& state, const Scene& scene, plan::Seen& view, const gpu_scene::PastFrame& past, const Target& target, const Quality& quality, const RenderRequest& request, FrameStats& stats) {
  const FramePlan& plan = series.plan;
  const gpu_scene::GpuEnvironment* environment = nullptr;
  if (plan.on("environment_lighting") || plan.on("background")) {
    auto found = state.gpu.environment(scene, {.cube = plan::reads(plan, "environment cube"), .picture = plan::reads(plan, "environment")}, report);
    if (!found) return fail(found.error());
    environment = *found;
  }
  const gpu_scene::GpuProbes* probeLight = nullptr;
  if (plan::reads(plan, "probe records")) {
    auto found = state.gpu.probes(scene, plan::reads(plan, "probe cubes"), report);
    if (!found) return fail(found.error());
    probeLight = *found;
  }
  const gpu_scene::GpuGrid* grid = nullptr;
  if (plan::reads(plan, "ambient lattice")) {
    auto found = state.gpu.grid(scene, report);
    if (!found) return fail(found.error());
    grid = *found;
  }
  FrameContext c{.device = *device, .plan = plan, .programs = series.programs, .targets = series.targets, .gpuScene = state.gpu, .buffers = series.buffers, .scene = scene, .quality = quality, .view = view.frame,
                 .visible = view.instances, .batches = view.batches, .lights = view.lights, .transparent = view.transparent, .shadows = &view.shadows, .environment = environment, .probes = view.probes, .grid = grid, .probeLight = probeLight, .size = target.size, .output = target.framebuffer, .past = past, .moved = view.moved, .report = report, .stats = stats};
  const float display = quality.exposureEv ? exposureOf(*quality.exposureEv) : 1;
  if (request.output == Output::Display || request.displayLight) c.preExposure = quality.exposureEv ? display : guessedExposure(view.lights, environment, scene.environment.scale, std::max(brightestPlace(scene, view.probes), grid ? grid->luminance : 0.0f));
  series.preExposure = c.preExposure;
  if (auto done = gpu_scene::uploadFrameData(c, display); !done) return done;
  if (drawsInstances(plan))
    if (auto done = gpu_scene::uploadDraws(c); !done) return done;
  if (plan::reads(plan, "probe records"))
    if (auto done = gpu_scene::uploadProbeRecords(c); !done) return done;
  if (grid)
    if (auto done = gpu_scene::uploadGridData(c); !done) return done;
  stats.lightsInView += int(view.lights.directional.size());
  PassCall call{c, series.modules, target, request};
  for (const PassPlan& pass : plan.passes)
    if (auto done = runPass(pass, call, series.timers); !done) return done;
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
  auto pictures = Series::create(*m.device, *m.programs, options.linkOnDemand);
  if (!pictures) return fail(pictures.error());
  m.pictures = std::move(*pictures);
  return renderer;
}

const Capabilities& Renderer::capabilities() const { return impl_->device->caps; }
const FramePlan& Renderer::lastPlan() const { return impl_->pictures->plan; }
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
  return m.draw(*m.pictures, scene, views, target, quality, request, m.planOptions(target, request));
}

Result<void> Renderer::Impl::look(Series& series, SceneState& state, const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const PlanOptions& planned, const History* history) {
  series.seen.resize(views.size());
  const glm::ivec2 shaded = plan::shadedSize(quality, planned);
  for (std::size_t i = 0; i < views.size(); ++i) {
    plan::Seen& seen = series.seen[i];
    plan::look(scene, state.derived, views[i], target.size, quality, report, seen, history ? history->jitter(i) : glm::dvec2(0), shaded);
    boundLights(seen.lights, seen.shadows);
    seen.moved = history ? history->motion().among(seen.instances) : std::vector<scene::Moved>{};
  }
  series.plan = plan::planOf(scene, series.seen, quality, device->caps, planned, nullptr);
  const FramePlan& plan = series.plan;
  for (plan::Seen& seen : series.seen) {
    if (!plan.on("directional_lights")) seen.lights.directional.clear();
    if (!plan.on("local_lights")) seen.lights.local.clear();
    if (!plan.on("reflection_probes")) seen.probes.clear();
    if (!plan.on("shadows")) seen.shadows = {};
    if (!plan.on("directional_lights")) scene::dropShadows(seen.shadows, true);
    if (!plan.on("local_lights")) scene::dropShadows(seen.shadows, false);
    if (plan.on("deformation")) continue;
    std::erase_if(seen.moved, [&seen](const scene::Moved& moved) { return seen.instances[moved.visible].pose != nullptr; });
    for (scene::VisibleInstance& v : seen.instances)
      if (v.pose) scene::makeRigid(scene, state.derived, seen.frame, v);
    for (scene::ShadowCaster& caster : seen.shadows.casters)
      if (caster.placed.pose) scene::makeRigid(scene, state.derived, caster.placed);
  }
  if (plan.on("forward_reference") && target.depthIn)
    return fail("target", "it brings depth, which the forward reference path cannot take in", "leave depthIn empty, or use path=deferred and rungs that are not forward-only");
  return {};
}

Result<FrameStats> Renderer::Impl::draw(Series& series, const Scene& scene, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request, const PlanOptions& planned) {
  const bool picture = &series == pictures.get();
  SceneState& state = stateOf(scene);
  state.derived.update(scene, &report);
  History* history = picture ? historyOf(scene, state.derived, views, target, quality, request, planned) : nullptr;
  if (auto seen = look(series, state, scene, views, target, quality, planned, history); !seen) return fail(seen.error());
  if (picture) {
    reportQuality(quality);
    if (planned.hostDepthIn && plan::scaleOf(quality) < 1) report.warn("resolution scale", "it has no effect where the target brings depth, which has the target's size");
    logEffects();
  }
  FrameStats stats;
  Result<void> done = series.programs.prepare(series.plan);
  if (done) done = series.targets.prepare(series.plan);
  state.gpu.beginFrame(scene, options.uploadBytesPerFrame);
  if (done && drawsInstances(series.plan)) done = state.gpu.updateMaterials(scene);
  // A capture shows the moment of the picture before it: what that one remembers of the frame before stays.
  if (picture) state.gpu.deformation().beginFrame(scene, history != nullptr);
  series.timers.beginFrame(timingOf(request.timing));
  for (std::size_t i = 0; i < views.size() && done; ++i) {
    gpu_scene::PastFrame past;
    if (history) past = history->past(i, series.targets.serial(plan::historyName(request.sequence, history->source())));
    past.sequence = request.sequence;
    done = renderView(series, state, scene, series.seen[i], past, target, quality, request, stats);
    if (history) history->drawn(i, series.seen[i].frame, series.preExposure);
  }
  series.timers.endFrame();
  if (history && done) history->end(series.targets.serial(plan::historyName(request.sequence, 1 - history->source())), state.gpu.pending() == 0);
  if (picture && !done) histories.erase(request.sequence);
  if (options.debugOutput) stats.glErrors = device->takeErrors();
  logNewWarnings();
  if (!done) return fail(series.programs.failed().value_or(done.error()));
  for (const gl::PassSample& s : series.timers.latest()) stats.passes.push_back({s.name, s.gpuMs, s.cpuMs});
  stats.lights = int(scene.lights.size());
  stats.uploadedBytes = state.gpu.uploadedBytes();
  stats.pendingUploads = state.gpu.pending();
  stats.textureBytes = std::uint64_t(device->textureBytes());
  if (quality.exposureEv) stats.exposureEv = *quality.exposureEv;
  return stats;
}

}  // namespace burnish
