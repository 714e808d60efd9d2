#include "probe/keys.h"

#include <algorithm>
#include <cmath>

#include "image/cube_file.h"
#include "probe/capture.h"
#include "probe/geometry.h"
#include "probe/visibility.h"
#include "scene/scene_hash.h"
#include "scene/transparency.h"

namespace burnish::probe {
namespace {

using core::Hash128;
using core::Hasher;

void add(Hasher& h, const glm::dvec3& v) { h.value(v.x), h.value(v.y), h.value(v.z); }
void add(Hasher& h, const glm::dmat3& m) {
  for (int i = 0; i < 3; ++i) add(h, m[i]);
}

/// Rungs and numbers that a capture's quality has; what belongs to the picture is the same in all.
void add(Hasher& h, const Quality& q) {
  for (std::size_t t = 0; t < terms().size(); ++t) h.text(terms()[t].name), h.text(terms()[t].rungs[rungOf(q, t)].name);
  h.value(q.shadowResolution), h.value(q.shadowCascades), h.value(q.shadowDistance), h.value(q.shadowMaps), h.value(q.transparentLayers), h.value(q.lightThreshold);
}

Hash128 placeOf(const ReflectionProbe& p) {
  Hasher h;
  add(h, p.center), add(h, p.axes), add(h, p.halfSize), add(h, p.capture), add(h, p.fade), h.value(p.margin);
  return h.finish();
}

/// Whether boxes may meet: no axis of `box` keeps them apart. `grown`: metres around it.
bool meets(const glm::dvec3& center, const glm::dmat3& axes, const glm::dvec3& half, double grown, const scene::Placed& placed) {
  const glm::dvec3 apart = placed.center - center;
  for (int i = 0; i < 3; ++i)
    if (std::abs(glm::dot(axes[i], apart)) > half[i] + grown + glm::dot(glm::abs(axes[i]), placed.extent)) return false;
  return true;
}
bool meetsSphere(const scene::Placed& placed, const glm::dvec3& center, double radius) {
  const glm::dvec3 apart = glm::max(glm::abs(placed.center - center) - placed.extent, 0.0);
  return glm::dot(apart, apart) <= radius * radius * 1.0001;
}

}  // namespace

class KeyMaker {
 public:
  KeyMaker(const Scene& scene, const ProbeSet& places, const BakeOptions& options) : scene_(scene), places_(places), options_(options), quality_(captureQuality(options.quality)), hashes_(scene) {}

  Keys make(const Geometry& geometry, const Capabilities& capabilities) {
    scene::Derived derived;
    derived.update(scene_);
    surfaceOf_.assign(scene_.instances.capacity(), -1);
    scene::eachPlaced(scene_, derived, glm::dvec3(0), [&](const scene::Placed& p) {
      surfaceOf_[p.id.index] = int(placed_.size());
      placed_.push_back(p);
    });
    gatherLights(derived);
    keys_.fog_ = scene_.fog.density > 0;
    keys_.base_ = baseOf(capabilities);
    for (const ReflectionProbe& p : places_.reflections) keys_.probePlaces_.push_back(placeOf(p));
    addGrid();
    for (const scene::Placed& p : placed_) keys_.surfaces_.push_back(surfaceOf(p));
    addPoints(geometry);
    return std::move(keys_);
  }

 private:
  struct Reach {
    Hash128 light;
    glm::dvec3 position{0};
    double radius = 0;  ///< 0: everywhere
    std::vector<std::uint32_t> casters;
  };

  [[nodiscard]] bool casts(const scene::Placed& p) const {
    const Material* m = scene_.materials.get(p.instance->material);
    return p.instance->castsShadow && !(m && scene::isTransparent(*m));
  }

  void gatherLights(const scene::Derived& derived) {
    Report ignored;
    const scene::ViewFrame frame = scene::frameOf(lookAt(glm::dvec3(0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0), 1), {1, 1});
    const scene::LightSet set = scene::gatherLights(scene_, derived, frame, quality_, ignored, scene::Reach::Everywhere);
    const bool shadows = quality_.shadow != Shadow::None;
    const auto addLight = [&](Id<Light> id, double radius, bool castsShadow) {
      const Light& light = *scene_.lights.get(id);
      Reach r{hashes_.light(light), glm::dvec3(scene_.world(light.node)[3]), radius, {}};
      for (std::uint32_t i = 0; shadows && castsShadow && i < placed_.size(); ++i)
        if (casts(placed_[i]) && (radius == 0 || meetsSphere(placed_[i], r.position, radius))) r.casters.push_back(i);
      mapsWanted_ += !shadows || !castsShadow ? 0 : radius == 0 ? quality_.shadowCascades : 6;
      sunShadows_ = sunShadows_ || (shadows && castsShadow && radius == 0);
      lights_.push_back(std::move(r));
    };
    for (const scene::DirectionalLight& l : set.directional) addLight(l.id, 0, l.castsShadow);
    for (const scene::LocalLight& l : set.local) addLight(l.id, std::max(double(l.radius), 1e-6), l.castsShadow);
  }

  Hash128 baseOf(const Capabilities& capabilities) {
    Hasher h;
    h.text("burnish capture 1");
    h.text(image::writerName());
    h.text(capabilities.vendor), h.text(capabilities.renderer), h.text(capabilities.version);
    add(h, quality_);
    h.value(options_.size), h.value(options_.lobe), h.value(options_.albedoLimit), h.value(captureNear(scene_));
    h.hash(scene::hashOf(scene_.environment)), h.hash(scene::hashOf(scene_.fog));
    // Maps of suns follow the boxes of all that is around; and where there are more maps than a view may have, each light decides about all others.
    const bool crowded = mapsWanted_ > quality_.shadowMaps;
    if (sunShadows_ || crowded)
      for (const scene::Placed& p : placed_) add(h, p.center), add(h, p.extent), h.value(casts(p));
    if (crowded)
      for (const Reach& r : lights_) h.hash(r.light);
    return h.finish();
  }

  void addGrid() {
    if (!places_.grid) return;
    const AmbientGrid& g = *places_.grid;
    int next = int(places_.reflections.size());
    for (const AmbientGrid::Point& p : g.points) {
      Hasher h;
      h.value(p.valid);
      h.list(std::span<const glm::vec2>(p.distances));
      keys_.gridPlaces_.push_back(h.finish());
      keys_.gridCapture_.push_back(p.valid ? next++ : -1);
    }
    Hasher h;
    add(h, g.origin), add(h, g.axes), add(h, g.spacing), h.value(g.margin), h.value(g.counts.x), h.value(g.counts.y), h.value(g.counts.z);
    h.hash(keys_.base_);
    keys_.base_ = h.finish();
  }

  /// Points of all cells that the box touches, and one more around: a point on a cell's face is in both.
  void addGridPoints(const scene::Placed& p, std::vector<std::uint32_t>& out) const {
    if (!places_.grid) return;
    const AmbientGrid& g = *places_.grid;
    glm::ivec3 first, last;
    for (int i = 0; i < 3; ++i) {
      const double middle = glm::dot(g.axes[i], p.center - g.origin), half = glm::dot(glm::abs(g.axes[i]), p.extent), outside = g.margin + g.spacing[i];
      if (middle + half < -outside || middle - half > (g.counts[i] - 1) * g.spacing[i] + outside) return;
      first[i] = int(std::clamp(std::floor((middle - half) / g.spacing[i]) - 1, 0.0, double(g.counts[i] - 1)));
      last[i] = int(std::clamp(std::ceil((middle + half) / g.spacing[i]) + 1, 0.0, double(g.counts[i] - 1)));
    }
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) out.push_back(std::uint32_t(x + g.counts.x * (y + g.counts.y * z)));
  }

  Keys::Surface surfaceOf(const scene::Placed& p) {
    Keys::Surface out;
    Hasher h;
    h.hash(hashes_.look(p));
    for (const Reach& r : lights_) {
      if (r.radius > 0 && !meetsSphere(p, r.position, r.radius)) continue;
      h.hash(r.light);
      for (const std::uint32_t c : r.casters) {
        const Material* m = scene_.materials.get(placed_[c].instance->material);
        h.hash(hashes_.shape(placed_[c], m && m->alphaTest));
      }
    }
    out.lit = h.finish();
    for (std::uint32_t i = 0; i < places_.reflections.size(); ++i) {
      const ReflectionProbe& probe = places_.reflections[i];
      if (meets(probe.center, probe.axes, probe.halfSize, probe.margin, p)) out.probes.push_back(i);
    }
    if (places_.grid && !places_.grid->points.empty()) addGridPoints(p, out.gridPoints);
    return out;
  }

  void addPoint(const Geometry& geometry, const glm::dvec3& at, bool reflection) {
    const int size = reflection ? options_.size : options_.ambientSize;
    Keys::Point point;
    Hasher h;
    h.value(reflection), h.value(size);
    add(h, at);
    point.own = h.finish();
    for (const Id<Instance> id : visibleInstances(geometry, at, size))
      if (surfaceOf_[id.index] >= 0) point.surfaces.push_back(std::uint32_t(surfaceOf_[id.index]));
    keys_.points_.push_back(std::move(point));
  }
  void addPoints(const Geometry& geometry) {
    for (const ReflectionProbe& p : places_.reflections) addPoint(geometry, p.capture, true);
    if (!places_.grid) return;
    const AmbientGrid& g = *places_.grid;
    for (int i = 0; i < int(g.points.size()); ++i)
      if (g.points[std::size_t(i)].valid) addPoint(geometry, g.position({i % g.counts.x, i / g.counts.x % g.counts.y, i / g.counts.x / g.counts.y}), false);
  }

  const Scene& scene_;
  const ProbeSet& places_;
  const BakeOptions& options_;
  Quality quality_;
  scene::SceneHashes hashes_;
  std::vector<scene::Placed> placed_;
  std::vector<int> surfaceOf_;  ///< by the instance's index, -1: none
  std::vector<Reach> lights_;
  int mapsWanted_ = 0;
  bool sunShadows_ = false;
  Keys keys_;
};

Keys Keys::make(const Scene& scene, const Geometry& geometry, const ProbeSet& places, const BakeOptions& options, const Capabilities& capabilities) {
  return KeyMaker(scene, places, options).make(geometry, capabilities);
}

std::vector<Hash128> Keys::ofBounce(std::span<const Hash128> before) const {
  const auto contentAt = [&](Hasher& h, std::size_t capture) { h.hash(before.empty() ? Hash128{} : before[capture]); };
  const auto addProbe = [&](Hasher& h, std::uint32_t i) { h.hash(probePlaces_[i]), contentAt(h, i); };
  const auto addGridPoint = [&](Hasher& h, std::uint32_t i) {
    h.hash(gridPlaces_[i]);
    if (gridCapture_[i] >= 0) contentAt(h, std::size_t(gridCapture_[i]));
  };
  std::vector<Hash128> surfaces;
  for (const Surface& s : surfaces_) {
    Hasher h;
    h.hash(s.lit);
    for (const std::uint32_t i : s.probes) addProbe(h, i);
    for (const std::uint32_t i : s.gridPoints) h.value(i), addGridPoint(h, i);
    surfaces.push_back(h.finish());
  }
  Hasher all;
  all.hash(base_);
  all.value(before.empty());
  if (fog_) {
    for (std::uint32_t i = 0; i < probePlaces_.size(); ++i) addProbe(all, i);
    for (std::uint32_t i = 0; i < gridPlaces_.size(); ++i) addGridPoint(all, i);
  }
  const Hash128 common = all.finish();
  std::vector<Hash128> keys;
  for (const Point& p : points_) {
    Hasher h;
    h.hash(common);
    h.hash(p.own);
    for (const std::uint32_t s : p.surfaces) h.hash(surfaces[s]);
    keys.push_back(h.finish());
  }
  return keys;
}

Hash128 contentOf(const IrradianceSh& irradiance, const Hash128& radiance) {
  Hasher h;
  for (const auto& rgb : irradiance)
    for (const double v : rgb) h.value(v);
  h.hash(radiance);
  return h.finish();
}

}  // namespace burnish::probe
