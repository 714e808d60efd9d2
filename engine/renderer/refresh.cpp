#include "renderer/refresh.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/capture_views.h"
#include "scene/probes.h"

namespace burnish {

Result<void> ProbeRefresher::prepare(gl::ProgramCache& programs, int size, int levels, ReflectionLobe wanted) {
  if (!series) {
    auto made = Series::create(device, programs, false);
    if (!made) return fail(made.error());
    series = std::move(*made);
  }
  if (!filter || lobe != wanted) filter = std::make_unique<gpu_scene::CubeFilter>(device, programs, gpu_scene::CubeFilterOptions{.lobe = wanted});
  lobe = wanted;
  if (source && source.width == size && target.levels == levels) return {};
  source = {};
  target = {};
  auto captured = gl::Texture::create(device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = size, .height = size}, "probe refresh: captured");
  if (!captured) return fail(captured.error());
  auto filtered = gl::Texture::create(device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = size, .height = size, .levels = levels}, "probe refresh: filtered");
  if (!filtered) return fail(filtered.error());
  for (int face = 0; face < 6; ++face) {
    const gl::Attachment attachment(*captured, 0, face);
    auto framebuffer = gl::Framebuffer::create(device, {&attachment, 1}, std::nullopt, "probe refresh: face");
    if (!framebuffer) return fail(framebuffer.error());
    faces[std::size_t(face)] = std::move(*framebuffer);
  }
  source = std::move(*captured);
  target = std::move(*filtered);
  return {};
}

namespace {

/// The cube's layer in the array of the scene's usable probes; -1: it is not among them.
int layerOf(const ProbeSet& probes, std::size_t probe) {
  const std::vector<std::uint32_t> usable = scene::usableProbes(probes, nullptr);
  const auto found = std::find(usable.begin(), usable.end(), std::uint32_t(probe));
  return found == usable.end() ? -1 : int(found - usable.begin());
}

}  // namespace

Result<void> Renderer::Impl::captureFace(const Scene& scene, const ReflectionProbe& probe, const Quality& quality) {
  ProbeRefresher& r = *refresher;
  const int size = r.source.width;
  Target target;
  target.framebuffer = r.faces[std::size_t(r.drawn)].id();
  target.size = {size, size};
  View view = plan::faceViews(probe.capture, plan::captureNear(scene), size)[std::size_t(r.drawn)];
  view.viewport = {};
  RenderRequest request;
  request.output = Output::Linear;
  PlanOptions planned = planOptions(target, request);
  // The sun's disc is a directional light's; what lights is captured whether it is shown or not.
  planned.removed.emplace_back("sun_disc");
  if (scene.environment.map.empty() ? scene.environment.color != glm::vec3(0) : true) planned.forced.emplace_back("background");
  auto drawn = draw(*r.series, scene, {&view, 1}, target, plan::captureQuality(quality), request, planned);
  if (!drawn) return fail(drawn.error());
  // What has not been uploaded yet would be missing: the face is drawn again.
  if (drawn->pendingUploads == 0) ++r.drawn;
  return {};
}

Result<void> Renderer::Impl::takeRefreshed(const Scene& scene, int layer) {
  ProbeRefresher& r = *refresher;
  auto probes = stateOf(scene).gpu.probes(scene, true, report);
  if (!probes) return fail(probes.error());
  for (int k = 0; k < r.target.levels; ++k) {
    const int size = std::max(r.target.width >> k, 1);
    device->gl.CopyImageSubData(r.target.id(), GL_TEXTURE_CUBE_MAP, k, 0, 0, 0, (*probes)->cubes.id(), GL_TEXTURE_CUBE_MAP_ARRAY, k, 0, 0, 6 * layer, size, size, 6);
  }
  (*probes)->lights[std::size_t(layer)] = {1, r.filter->readIrradiance()};
  ++refreshes;
  return {};
}

Result<ProbeRefresh> Renderer::refreshProbe(const Scene& scene, std::size_t index, const Quality& quality) {
  Impl& m = *impl_;
  if (index >= scene.probes.reflections.size()) return fail("refreshProbe", fmt::format("reflection probe {} of {}", index, scene.probes.reflections.size()), "give an index into Scene::probes.reflections");
  const ReflectionProbe& probe = scene.probes.reflections[index];
  const int layer = layerOf(scene.probes, index);
  if (layer < 0) return fail("refreshProbe", fmt::format("reflection probe '{}' has no light that the renderer uses", probe.name), "bake it, or give it black levels of the others' size");
  const CallState callState(*m.device, m.options.hostState);
  if (!m.refresher) m.refresher = std::make_unique<ProbeRefresher>(*m.device);
  ProbeRefresher& r = *m.refresher;
  const ProbeRefresher::Work wanted{scene.identity.value(), scene.probes.revision, index};
  if (r.work != wanted) {
    r.work.reset();
    r.forgetFence();
    r.drawn = 0;
    const std::vector<CubeLevel>& levels = probe.radiance.levels;
    if (auto ready = r.prepare(*m.programs, levels[0].size, int(levels.size()), probe.radiance.lobe.value_or(ReflectionLobe::BlinnPhong)); !ready) return fail(ready.error());
    if (auto begun = r.filter->begin(r.source, r.target); !begun) return fail(begun.error());
    r.work = wanted;
  }
  ProbeRefresh state{.total = 6 + r.filter->slices() + 1};
  const auto piece = [&]() -> Result<void> {
    if (r.drawn < 6) return m.captureFace(scene, probe, quality);
    if (r.filter->slicesDone() < r.filter->slices()) {
      auto done = r.filter->filterSlice();
      if (!done) return fail(done.error());
      if (*done) r.fence = m.device->gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
      return {};
    }
    if (r.fence && m.device->gl.ClientWaitSync(r.fence, GL_SYNC_FLUSH_COMMANDS_BIT, 0) == GL_TIMEOUT_EXPIRED) return {};
    r.forgetFence();
    if (auto taken = m.takeRefreshed(scene, layer); !taken) return taken;
    state.ready = true;
    return {};
  };
  auto done = piece();
  state.done = state.ready ? state.total : r.drawn + r.filter->slicesDone();
  if (!done || state.ready) r.work.reset();
  if (!done) return fail(done.error());
  return state;
}

}  // namespace burnish
