// A scene's fog as planning and shading want it, and how much of it a view can show.
#pragma once
#include "scene/visibility.h"

namespace burnish::scene {

/// The scene's fog, finite and in range; what is mended is reported.
Fog fogOf(const Scene& scene, Report* report);
/// An upper bound of the optical depth between the eye and anything that the view shows: the instances' bounds and, where light of a sun or of the surroundings reaches the fog or a
/// background shows through it, the way to the background.
double deepestFog(const Scene& scene, const Derived& derived, const ViewFrame& frame, const std::vector<VisibleInstance>& instances, const LightSet& lights);

/// Fog that takes less than this share of light everywhere in a view is not drawn: a quarter of a display's step.
inline constexpr double kLeastFog = 1.0 / 1024;

}  // namespace burnish::scene
