// Reflection probes as views see them. No GL; positions relative to the eye.
#pragma once
#include <burnish/scene.h>

#include <cstdint>
#include <vector>

#include "scene/visibility.h"

namespace burnish::scene {

/// A reflection probe that has light.
struct SeenProbe {
  std::uint32_t index = 0;            ///< into ProbeSet::reflections
  std::uint32_t layer = 0;            ///< which cube of those that are usable (usableProbes' order)
  glm::dvec3 center{0}, capture{0};   ///< relative to the eye, metres
};

/// Indices of the probes that can light: baked, with finite numbers, their cubes as large and with as many levels as the first one's, MAX_PROBES at most. `report`: where probes with
/// light that are left out are named.
std::vector<std::uint32_t> usableProbes(const ProbeSet& probes, Report* report);
/// Half extents along the world's axes of the box with its margin, metres.
glm::dvec3 reachOf(const ReflectionProbe& probe);
/// The usable probes whose box with its margin meets the view, smaller boxes before larger ones.
std::vector<SeenProbe> findProbes(const Scene& scene, const ViewFrame& frame, Report& report, Reach reach = Reach::InView);

}  // namespace burnish::scene
