#include "renderer/history.h"

#include "plan/temporal.h"

namespace burnish {
namespace {

bool sameView(const View& a, const View& b) {
  return a.eye == b.eye && a.axes == b.axes && a.orthographic == b.orthographic && a.fovY == b.fovY && a.height == b.height && a.near == b.near && a.far == b.far && a.viewport == b.viewport;
}

}  // namespace

void History::begin(const Scene& scene, const scene::Derived& derived, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request,
                    std::uint64_t refreshes) {
  const Environment& e = scene.environment;
  const Fog& f = scene.fog;
  const Environment::Sun sun = e.sun.value_or(Environment::Sun{.radius = 0});
  const Stamp stamp{scene.identity.value(), scene.nodes.revision(), scene.meshes.revision(), scene.textures.revision(), scene.materials.revision(), scene.instances.revision(),
                    scene.lights.revision(), scene.skins.revision(), scene.probes.revision, refreshes, e.revision, e.color, e.scale, e.filterSize, e.filterError,
                    {f.density, f.falloff, f.height, f.albedo.x, f.albedo.y, f.albedo.z, f.anisotropy, f.start},
                    {sun.toSun.x, sun.toSun.y, sun.toSun.z, sun.radiance.x, sun.radiance.y, sun.radiance.z, sun.radius, sun.horizon}, e.background, bool(request.hostDraw), quality};
  // What the host draws is not known to keep still.
  const bool same = stamp == stamp_ && settled_ && !stamp.hostDraws;
  if (stamp.scene != stamp_.scene || target.size != size_ || request.output != output_ || seen_.size() != views.size()) seen_.assign(views.size(), {});
  motion_.update(scene, derived);
  for (std::size_t i = 0; i < views.size(); ++i) {
    Seen& s = seen_[i];
    if (views[i].cut || s.view.viewport != views[i].viewport || s.view.orthographic != views[i].orthographic) s.frames = 0;
    s.still = s.frames > 0 && same && sameView(s.view, views[i]);
    s.view = views[i];
  }
  stamp_ = stamp;
  size_ = target.size;
  output_ = request.output;
}

glm::dvec2 History::jitter(std::size_t view) const { return plan::jitterOf(seen_[view].frames); }

gpu_scene::PastFrame History::past(std::size_t view, std::uint64_t pictures) const {
  const Seen& s = seen_[view];
  gpu_scene::PastFrame past;
  past.valid = s.frames > 0 && pictures == pictures_;
  past.still = s.still || !past.valid;  // the first frame is a mean of one
  past.source = source_;
  past.frame = s.frame;
  past.preExposure = s.preExposure;
  return past;
}

void History::drawn(std::size_t view, const scene::ViewFrame& frame, float preExposure) {
  Seen& s = seen_[view];
  s.frame = frame;
  s.preExposure = preExposure;
  ++s.frames;
}

void History::end(std::uint64_t pictures, bool settled) {
  pictures_ = pictures;
  settled_ = settled;
  source_ = 1 - source_;
}

}  // namespace burnish
