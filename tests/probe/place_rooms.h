// Flats and other scenes with rooms, and what is found in them.
#pragma once
#include <burnish/probe.h>

#include <iostream>

#include "place_scenes.h"

namespace burnish::test {

using glm::vec2;

inline ProbeSet placed(const Scene& scene, const PlacementOptions& options = {}, Report* into = nullptr) {
  Report report;
  auto set = placeProbes(scene, options, into ? *into : report);
  if (!set) FAIL(set.error().message());
  return std::move(*set);
}
inline PlacementOptions withoutGrid() {
  PlacementOptions o;
  o.grid = false;
  return o;
}

inline void describe(const ProbeSet& set) {
  for (const ReflectionProbe& p : set.reflections)
    std::cout << p.name << ": center " << p.center.x << " " << p.center.y << " " << p.center.z << " half " << p.halfSize.x << " " << p.halfSize.y << " " << p.halfSize.z << " capture " << p.capture.x << " "
              << p.capture.y << " " << p.capture.z << " fade " << p.fade.x << " margin " << p.margin << "\n";
  if (set.grid) {
    int valid = 0;
    for (const auto& q : set.grid->points) valid += q.valid;
    std::cout << "grid " << set.grid->counts.x << " " << set.grid->counts.y << " " << set.grid->counts.z << " spacing " << set.grid->spacing.x << " " << set.grid->spacing.y << " " << set.grid->spacing.z << " valid "
              << valid << "\n";
  }
}

/// The probe's corners against a box that is turned about +Y: the largest distance, metres.
inline double corners(const ReflectionProbe& p, dvec3 low, dvec3 high, const glm::dmat4& at) {
  double worst = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner = dvec3(at * glm::dvec4(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z, 1));
    double nearest = INFINITY;
    for (int k = 0; k < 8; ++k) nearest = std::min(nearest, glm::length(p.center + p.axes * (p.halfSize * dvec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)) - corner));
    worst = std::max(worst, nearest);
  }
  return worst;
}
inline bool inBox(const ReflectionProbe& p, dvec3 point, double slack = 0) { return glm::all(glm::lessThanEqual(glm::abs(glm::transpose(p.axes) * (point - p.center)), p.halfSize + slack)); }

/// A wall across x = at from z0 to z1, two sheets 20 cm apart, with a door from the floor.
inline void wallWithDoor(Scene& s, const glm::dmat4& to, float at, float z0, float z1, float height, float doorZ, float doorWidth, float doorHeight) {
  const float a = doorZ - doorWidth / 2, b = doorZ + doorWidth / 2;
  place(s, box({at - 0.1f, 0, z0}, {at + 0.1f, height, a}), {}, to);
  place(s, box({at - 0.1f, 0, b}, {at + 0.1f, height, z1}), {}, to);
  place(s, box({at - 0.1f, doorHeight, a}, {at + 0.1f, height, b}), {}, to);
}

/// Two rooms of 5 x 2.7 x 4 and 3 x 2.7 x 4 metres.
inline Scene flat(const glm::dmat4& to = glm::dmat4(1), float doorWidth = 0.9f, float doorHeight = 2.05f) {
  Scene s;
  place(s, box({0, 0, 0}, {8.2f, 2.7f, 4}, true), {}, to);
  wallWithDoor(s, to, 5.1f, 0, 4, 2.7f, 1.3f, doorWidth, doorHeight);
  return s;
}

/// Floor, ceiling and walls of an L: 8 x 3 and 3 x 7 metres.
inline Scene ell(const glm::dmat4& to) {
  const float h = 2.6f;
  const vec2 plan[] = {{0, 0}, {8, 0}, {8, 3}, {3, 3}, {3, 7}, {0, 7}};
  Scene s;
  for (int i = 0; i < 6; ++i) {
    const vec3 a(plan[i].x, 0, plan[i].y), b(plan[(i + 1) % 6].x, 0, plan[(i + 1) % 6].y);
    place(s, quad((a + b) * 0.5f + vec3(0, h / 2, 0), (a - b) * 0.5f, {0, -h / 2, 0}), {}, to);
  }
  for (const auto& [low, high] : {std::pair(vec2(0, 0), vec2(8, 3)), std::pair(vec2(0, 3), vec2(3, 7))}) {
    const vec3 c((low.x + high.x) / 2, 0, (low.y + high.y) / 2), u((high.x - low.x) / 2, 0, 0), v(0, 0, (high.y - low.y) / 2);
    place(s, quad(c, v, u), {}, to);
    place(s, quad(c + vec3(0, h, 0), u, v), {}, to);
  }
  return s;
}

/// A table top on four legs and a cupboard that does not reach the ceiling.
inline void furnish(Scene& s, const glm::dmat4& to) {
  place(s, box({1.5f, 0.7f, 1.2f}, {3.5f, 0.75f, 2.6f}), {}, to);
  for (const float x : {1.55f, 3.4f})
    for (const float z : {1.25f, 2.5f}) place(s, box({x, 0, z}, {x + 0.06f, 0.7f, z + 0.06f}), {}, to);
  place(s, box({0.02f, 0, 0.3f}, {0.55f, 2, 2.3f}), {}, to);
  place(s, sphere(0.2f, 8, 16), {}, to * translation({2.5, 2.2, 1.9}));  // a lamp
}

}  // namespace burnish::test
