// Light that arrives at a point, drawn by the engine's own renderer: six views, linear output, only the effects that a capture needs.
#pragma once
#include <burnish/probe.h>

namespace burnish::probe {

/// The scene as captures see it: surfaces that reflect more than the limit (0 to 1; diffuse and specular together, as the rungs draw the light of surroundings) are darkened to it, with one
/// warning a material that says how much and where. What needs nothing is as it was.
Scene limited(const Scene& scene, double albedoLimit, const Quality& quality, Report& report);

/// The rungs that a capture uses: those of the quality, without what belongs to the picture or the screen.
Quality captureQuality(const Quality& quality);

/// Metres, under which a capture of that scene sees nothing: 1e-5 of its diagonal or less, a power of two, so that it stays while the scene changes a little.
float captureNear(const Scene& scene);
/// The six views of a cube's faces, in OpenGL's order, `size` pixels square each, in two rows of three whose lower left corner is at `corner` of a target. Row 0 of a face, as OpenGL stores it, is
/// the lowest of its viewport. Nothing nearer than `near` metres is seen, and there is no far end.
std::array<View, 6> faceViews(glm::dvec3 point, float near, int size, glm::ivec2 corner = {0, 0});
/// The cube in the picture that those views drew (3 · size by 2 · size, F32 RGBA, rows from the top). `mended`: values that are not finite or negative, and 0 in the cube.
CubeLevel facesOf(const Image& picture, int size, std::size_t& mended);

class Capture {
 public:
  /// `scene` is what limited() gave; its probes light the captures, and what they do not reach the sky lights. `quality`: of the picture; captureQuality() is taken here.
  /// The context must be current on this thread, here and in every later call, and outlive the capture.
  static Result<std::unique_ptr<Capture>> create(const ProcAddress& getProcAddress, Scene scene, const Quality& quality);
  virtual ~Capture() = default;
  /// The probes' light from now on.
  virtual void setProbes(ProbeSet probes) = 0;
  /// Radiance in cd/m² from a point, axes of the world: six faces of `size`. Values are finite and at least 0.
  virtual Result<CubeLevel> radiance(glm::dvec3 point, int size) = 0;

  /// Values of the latest capture that were not finite or negative, and are 0.
  [[nodiscard]] std::size_t mended() const { return mended_; }
  /// What the renderer had to say so far, each once, and what callers add.
  [[nodiscard]] Report& report() { return report_; }

 protected:
  std::size_t mended_ = 0;
  Report report_;
};

}  // namespace burnish::probe
