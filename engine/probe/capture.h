// Light that arrives at a point, drawn by the engine's own renderer: six views, linear output, only the effects that a capture needs.
#pragma once
#include <burnish/probe.h>

namespace burnish::probe {

/// The scene as captures see it: surfaces that reflect more than the limit (diffuse and specular together) are darkened to it, with one warning a material.
Scene limited(const Scene& scene, double albedoLimit, Report& report);

/// The rungs that a capture uses: those of the quality, without what belongs to the picture or the screen.
Quality captureQuality(const Quality& quality);

class Capture {
 public:
  /// `scene` is what limited() gave; its probes light the captures, and what they do not reach the sky lights. `quality`: of the picture; captureQuality() is taken here.
  static Result<std::unique_ptr<Capture>> create(const ProcAddress& getProcAddress, Scene scene, const Quality& quality);
  virtual ~Capture() = default;
  /// The probes' light from now on.
  virtual void setProbes(ProbeSet probes) = 0;
  /// Radiance in cd/m² from a point, axes of the world: six faces of `size`. Values are finite and at least 0.
  virtual Result<CubeLevel> radiance(glm::dvec3 point, int size) = 0;
};

}  // namespace burnish::probe
