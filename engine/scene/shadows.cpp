#include "scene/shadows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "interface/limits.h"
#include "scene/shadow_content.h"
#include "scene/transparency.h"

namespace burnish::scene {
namespace {

// Wider spots take the maps of a point light: a single picture would spend its texels on the rim.
constexpr double kWidestCone = 1.0471976;  // radians from the axis, 60 degrees
// What is nearer to a light than this casts no shadow: a lamp has a size (shading/constants.h, BURNISH_GUARD_DISTANCE2).
constexpr double kLightNear = 0.01;

std::string place(const Light* light) { return !light || light->name.empty() ? "an unnamed light" : fmt::format("light '{}'", light->name); }

class Gatherer {
 public:
  Gatherer(const Scene& scene, const Derived& derived, const ViewFrame& frame, const Quality& quality, LightSet& lights, Report& report, ShadowSet& out)
      : scene_(scene), derived_(derived), frame_(frame), quality_(quality), lights_(lights), report_(report), out_(out), reach_(shadowReach(quality.shadow)) {
    resolution_ = held(quality.shadowResolution, 16, 8192, "shadowResolution");
    left_ = held(quality.shadowMaps, 1, 1024, "shadowMaps");
    cascades_ = held(quality.shadowCascades, 1, MAX_CASCADES, "shadowCascades");
  }

  void run(const std::vector<VisibleInstance>& seen, Reach reach) {
    findCasters(seen, reach);
    if (std::none_of(out_.casters.begin(), out_.casters.end(), [](const ShadowCaster& c) { return c.seen; })) return;
    addSuns();
    addLocals();
  }

 private:
  int held(int value, int least, int most, const char* name) {
    const int good = std::clamp(value, least, most);
    if (good != value) report_.warn("quality", fmt::format("{} is {}: {} is used, {} to {} can be", name, value, good, least, most));
    return good;
  }

  void findCasters(const std::vector<VisibleInstance>& seen, Reach reach) {
    std::vector<bool> inView(scene_.instances.capacity(), reach == Reach::Everywhere);
    for (const VisibleInstance& v : seen) inView[v.id.index] = true;
    eachPlaced(scene_, derived_, frame_.eye, [&](const Placed& p) {
      const Material* m = scene_.materials.get(p.instance->material);
      const bool through = m && isTransparent(*m);
      if (through && p.instance->castsShadow) report_.warn(m->name.empty() ? "an unnamed material" : fmt::format("material '{}'", m->name), "is blended or glass: it casts no shadow");
      out_.casters.push_back({p, p.instance->castsShadow && !through, m && m->alphaTest, inView[p.id.index]});
    });
  }

  // Casters inside the map's volume; false when there are none.
  bool fill(ShadowMap& map) {
    ViewFrame volume;
    volume.viewProjection = map.clip;
    const Frustum frustum(volume);
    const glm::dvec3 shift = frame_.eye - map.origin;
    for (std::uint32_t i = 0; i < out_.casters.size(); ++i) {
      const ShadowCaster& c = out_.casters[i];
      if (c.casts && frustum.meetsBox(c.placed.center + shift, c.placed.extent)) map.casters.push_back(i);
    }
    return !map.casters.empty();
  }
  [[nodiscard]] bool showsSomething(const glm::dmat4& clip, glm::dvec3 origin) const {
    ViewFrame volume;
    volume.viewProjection = clip;
    const Frustum frustum(volume);
    return std::any_of(out_.casters.begin(), out_.casters.end(), [&](const ShadowCaster& c) { return c.seen && frustum.meetsBox(c.placed.center + frame_.eye - origin, c.placed.extent); });
  }
  int keep(ShadowMap map) {
    map.content = contentOf(scene_, map, out_.casters, resolution_);
    out_.maps.push_back(std::move(map));
    return int(out_.maps.size()) - 1;
  }
  void noRoom(Id<Light> id) {
    report_.warn(place(scene_.lights.get(id)), fmt::format("casts no shadow where it would take more than {} shadow maps in one view (Quality::shadowMaps)", held(quality_.shadowMaps, 1, 1024, "shadowMaps")));
  }

  // `texels`: no edge is softer than that.
  void checkSoftness(Id<Light> id, double texels) {
    if (quality_.shadow == Shadow::Pcss && texels > SHADOW_WIDEST)
      report_.warn(place(scene_.lights.get(id)), fmt::format("where what casts is far from what it shades, the shadow's edge is held at {} texels to either side, sharper than the light's size makes it (a smaller light, or a lower Quality::shadowResolution)",
                                                             SHADOW_WIDEST));
  }

  // Suns.
  std::vector<glm::dvec2> ranges() {
    std::vector<glm::dvec2> distances;
    const glm::dvec3 forward = -frame_.axes[2];
    double farthest = 0;
    for (const ShadowCaster& c : out_.casters) {
      if (!c.seen) continue;
      const double middle = glm::dot(forward, c.placed.center), half = glm::dot(glm::abs(forward), c.placed.extent);
      glm::dvec2 range(middle - half, middle + half);
      // Of what is large for its distance the view may see the far part alone.
      if (range.y > 2 * range.x) range = distancesOf(frame_, c.placed.center, c.placed.extent);
      if (range.x > range.y) continue;
      distances.push_back(range);
      farthest = std::max(farthest, range.y);
    }
    const float asked = quality_.shadowDistance;
    const bool limited = asked > 0 && std::isfinite(asked);
    if (!limited && asked != 0) report_.warn("quality", "shadowDistance is negative or not finite: shadows reach as far as there is something to see");
    const double end = frame_.far > 0 ? frame_.far : 1e12;
    if (limited && farthest > double(asked) * 1.001) report_.warn("quality", fmt::format("directional lights cast no shadows beyond {:.4g} m from the eye, where there is more to see (Quality::shadowDistance)", asked));
    return splitDistances(std::move(distances), frame_.near, limited ? std::min(end, std::max(double(asked), frame_.near)) : end, cascades_);
  }

  // Depth toward the light reaches as far as there are casters, in whole radii so that it stays.
  bool fillCascade(SunShadow& sun, Cascade& c) {
    const glm::dvec3 shift = frame_.eye - c.center, towards = sun.axes[2];
    ShadowMap map;
    map.sun = true;
    map.origin = c.center;
    double highest = c.near;
    for (std::uint32_t i = 0; i < out_.casters.size(); ++i) {
      const ShadowCaster& s = out_.casters[i];
      if (!s.casts) continue;
      const glm::dvec3 at = s.placed.center + shift, e = s.placed.extent;
      const auto beyond = [&](const glm::dvec3& axis) { return std::abs(glm::dot(axis, at)) - glm::dot(glm::abs(axis), e) > c.radius; };
      const double middle = glm::dot(towards, at), half = glm::dot(glm::abs(towards), e);
      if (beyond(sun.axes[0]) || beyond(sun.axes[1]) || middle + half < -c.far) continue;
      map.casters.push_back(i);
      highest = std::max(highest, middle + half);
    }
    if (map.casters.empty()) return false;
    c.near = std::ceil(highest / c.radius + 1e-9) * c.radius;
    const double depth = c.near + c.far;
    glm::dmat4 projection(1);
    projection[0][0] = projection[1][1] = 1 / c.radius;
    projection[2][2] = 1 / depth;
    projection[3][2] = c.far / depth;
    map.clip = projection * glm::dmat4(glm::transpose(sun.axes));
    c.map = keep(std::move(map));
    return true;
  }

  void addSuns() {
    std::stable_partition(lights_.directional.begin(), lights_.directional.end(), [](const DirectionalLight& l) { return l.castsShadow; });
    std::vector<glm::dvec2> split;
    for (DirectionalLight& l : lights_.directional) {
      if (!l.castsShadow) break;
      if (out_.suns.size() == MAX_SHADOW_SUNS) {
        report_.warn(place(scene_.lights.get(l.id)), fmt::format("is past the limit of {} directional lights that cast shadows: it casts none", MAX_SHADOW_SUNS));
        continue;
      }
      if (split.empty()) split = ranges();
      SunShadow sun;
      sun.axes = sunAxes(glm::normalize(glm::dvec3(l.toLight)));
      sun.tangent = std::tan(double(l.angularDiameter) * 0.5);
      if (int(split.size()) > left_) {
        noRoom(l.id);
        break;
      }
      for (const glm::dvec2& range : split) {
        Cascade c = placeCascade(frame_, sun.axes, range, resolution_, reach_);
        if (fillCascade(sun, c)) checkSoftness(l.id, sun.tangent * (c.near + c.far) / (2 * c.radius / resolution_));
        sun.cascades.push_back(c);
      }
      left_ -= int(split.size());
      callers(l.id);
      out_.suns.push_back(std::move(sun));
    }
  }

  // Point and spot lights.
  void addMap(LocalShadow& s, int part, const glm::dmat3& axes) {
    const double a = s.near * s.far / (s.far - s.near), b = s.near / (s.far - s.near);
    glm::dmat4 projection(0);
    projection[0][0] = projection[1][1] = 1 / s.tangent;
    projection[2][3] = 1;
    projection[2][2] = -b;
    projection[3][2] = a;
    ShadowMap map;
    map.origin = s.origin;
    map.clip = projection * glm::dmat4(glm::transpose(axes));
    if (showsSomething(map.clip, map.origin) && fill(map)) s.maps[std::size_t(part)] = keep(std::move(map));
  }
  LocalShadow shadowOf(const LocalLight& l) {
    LocalShadow s;
    const Light* light = scene_.lights.get(l.id);
    const glm::dmat4 world = light && scene_.nodes.has(light->node) ? derived_.world(light->node) : glm::dmat4(1);
    s.origin = glm::dvec3(world[3]);
    s.near = std::min(kLightNear, double(l.radius) * 0.5);
    s.far = l.radius;
    s.sourceRadius = l.sourceRadius;
    const double outer = l.cosOuter > -1 ? std::acos(std::clamp(double(l.cosOuter), -1.0, 1.0)) : kWidestCone * 2, spare = 1 - 2.0 * reach_ / resolution_;
    s.cube = outer > kWidestCone;
    s.tangent = (s.cube ? 1 : std::max(std::tan(outer), 1e-4)) / std::max(spare, 0.25);
    if (s.cube) {
      for (int face = 0; face < 6; ++face) {
        glm::dmat3 axes(0);
        const int axis = face / 2;
        axes[0][(axis + 1) % 3] = axes[1][(axis + 2) % 3] = 1;
        axes[2][axis] = face % 2 ? -1 : 1;
        if (l.cosOuter > -1 && outsideCone(axes[2], l, outer)) continue;
        addMap(s, face, axes);
      }
    } else {
      s.axes = sunAxes(glm::normalize(glm::dvec3(l.axis)));
      addMap(s, 0, s.axes);
    }
    checkSoftness(l.id, l.sourceRadius / nearestCaster(s) / (2 * s.tangent / resolution_));
    return s;
  }
  // From the light to the nearest box in its maps, m.
  [[nodiscard]] double nearestCaster(const LocalShadow& s) const {
    double nearest = s.far;
    for (const int map : s.maps) {
      if (map < 0) continue;
      for (const std::uint32_t i : out_.maps[std::size_t(map)].casters) {
        const Placed& p = out_.casters[i].placed;
        nearest = std::min(nearest, glm::length(glm::max(glm::abs(p.center + frame_.eye - s.origin) - p.extent, 0.0)));
      }
    }
    return std::max(nearest, s.near);
  }
  // No direction of a face is farther than 54.8 degrees from its axis, and its map is a little wider.
  static bool outsideCone(const glm::dvec3& face, const LocalLight& l, double outer) { return std::acos(std::clamp(glm::dot(face, glm::dvec3(l.axis)), -1.0, 1.0)) > outer + 1.1; }

  void addLocals() {
    std::vector<std::size_t> order(lights_.local.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    // Where there is no room for all, those that are brightest at the eye come first.
    const auto weight = [&](const LocalLight& l) { return std::max({l.intensity.x, l.intensity.y, l.intensity.z}) / std::max(glm::dot(l.position, l.position), 1.0f); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(lights_.local[a]) > weight(lights_.local[b]); });
    std::vector<std::optional<LocalShadow>> made(order.size());
    for (const std::size_t i : order) {
      if (!lights_.local[i].castsShadow) continue;
      const std::size_t before = out_.maps.size();
      LocalShadow s = shadowOf(lights_.local[i]);
      const int count = int(out_.maps.size() - before);
      if (count == 0) continue;
      if (count > left_) {
        noRoom(lights_.local[i].id);
        out_.maps.resize(before);
        continue;
      }
      left_ -= count;
      made[i] = s;
    }
    std::vector<LocalLight> first, rest;
    for (std::size_t i = 0; i < made.size(); ++i) {
      (made[i] ? first : rest).push_back(lights_.local[i]);
      if (!made[i]) continue;
      callers(lights_.local[i].id);
      out_.locals.push_back(*made[i]);
    }
    first.insert(first.end(), rest.begin(), rest.end());
    lights_.local = std::move(first);
  }

  void callers(Id<Light> id) { out_.callers.push_back(scene_.lights.get(id) ? scene_.lights.get(id)->name : std::string()); }

  const Scene& scene_;
  const Derived& derived_;
  const ViewFrame& frame_;
  const Quality& quality_;
  LightSet& lights_;
  Report& report_;
  ShadowSet& out_;
  int reach_, resolution_ = 1024, left_ = 64, cascades_ = 4;
};

}  // namespace

int shadowReach(Shadow rung) { return rung == Shadow::Pcss ? SHADOW_WIDEST + 4 : 6; }

void gatherShadows(const Scene& scene, const Derived& derived, const ViewFrame& frame, const Quality& quality, const std::vector<VisibleInstance>& seen, Reach reach, LightSet& lights, Report& report,
                   ShadowSet& out) {
  out = {};
  const auto casts = [](const auto& l) { return l.castsShadow; };
  if (quality.shadow == Shadow::None) return;
  if (std::none_of(lights.directional.begin(), lights.directional.end(), casts) && std::none_of(lights.local.begin(), lights.local.end(), casts)) return;
  Gatherer(scene, derived, frame, quality, lights, report, out).run(seen, reach);
}

void dropShadows(ShadowSet& set, bool suns) {
  if (suns) {
    set.callers.erase(set.callers.begin(), set.callers.begin() + std::ptrdiff_t(set.suns.size()));
    set.suns.clear();
  } else {
    set.callers.resize(set.suns.size());
    set.locals.clear();
  }
  std::vector<ShadowMap> left;
  std::vector<int> moved(set.maps.size(), -1);
  for (std::size_t i = 0; i < set.maps.size(); ++i)
    if (set.maps[i].sun != suns) {
      moved[i] = int(left.size());
      left.push_back(std::move(set.maps[i]));
    }
  set.maps = std::move(left);
  const auto follow = [&](int& map) { map = map < 0 ? map : moved[std::size_t(map)]; };
  for (SunShadow& s : set.suns)
    for (Cascade& c : s.cascades) follow(c.map);
  for (LocalShadow& s : set.locals)
    for (int& map : s.maps) follow(map);
}

}  // namespace burnish::scene
