// A scene's surfaces as rays meet them: every visible instance in its pose, in world space.
#pragma once
#include <burnish/scene.h>

#include "reference/rays.h"

namespace burnish::probe {

/// What a surface does to what is behind it. The bits are masks of rays.
enum Look : std::uint32_t {
  kOpaque = 1,
  kCutout = 2,       ///< alpha-tested: holes, whose pattern is not looked at
  kTransparent = 4,  ///< blended or glass
};

/// Who sees through what:
/// - distances of a lattice, and whether a point is inside something, are of opaque surfaces alone: light passes the others;
/// - visible instances are all that a ray passes, up to the first opaque surface;
/// - rooms end at opaque and at transparent surfaces (a window closes a room), and go on behind cutouts (a grille or a plant does not).
struct Geometry {
  struct Surface {
    Id<Instance> instance;
    bool twoSided = false;  ///< its back is no inside
    Look look = kOpaque;
  };
  reference::RayScene rays;
  std::vector<Surface> surfaces;  ///< by Hit::mesh, in order of the scene's table

  /// Errors: too many triangles, memory runs out. What is mended in skins goes into the report, if there is one.
  static Result<Geometry> create(const Scene& scene, Report* report);
};

}  // namespace burnish::probe
