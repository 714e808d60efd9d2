// What probes are captured with: six views of a point, and the rungs of them.
#pragma once
#include <burnish/plan.h>

#include <array>

namespace burnish::plan {

/// The rungs that a capture uses: those of the quality, without what belongs to the picture or the screen.
Quality captureQuality(const Quality& quality);
/// Metres, under which a capture of that scene sees nothing: 1e-5 of its diagonal or less, a power of two, so that it stays while the scene changes a little.
float captureNear(const Scene& scene);
/// The six views of a cube's faces, in OpenGL's order, `size` pixels square each, in two rows of three whose lower left corner is at `corner` of a target. Row 0 of a face, as OpenGL stores it, is
/// the lowest of its viewport. Nothing nearer than `near` metres is seen, and there is no far end.
std::array<View, 6> faceViews(glm::dvec3 point, float near, int size, glm::ivec2 corner = {0, 0});

}  // namespace burnish::plan
