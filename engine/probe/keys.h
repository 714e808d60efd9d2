// Keys of captures: hashes of all that a capture's bytes depend on, so that a scene change bakes again what it touches (docs/probe_files.md, "Keys").
#pragma once
#include <burnish/probe.h>

#include <span>
#include <vector>

#include "core/hash.h"

namespace burnish::probe {

struct Geometry;

class Keys {
 public:
  /// `scene`: as captures see it (limited()); `geometry`: its surfaces; `places`: with the grid's valid points and their distances, light does not count.
  static Keys make(const Scene& scene, const Geometry& geometry, const ProbeSet& places, const BakeOptions& options, const Capabilities& capabilities);

  /// Of each capture point in a bounce. `before`: hashes of the points' light in the bounce before; empty: all is black.
  [[nodiscard]] std::vector<core::Hash128> ofBounce(std::span<const core::Hash128> before) const;

 private:
  /// What lights a surface beside lights: reflection probes whose boxes it reaches, and capture points of the grid's lattice around it.
  struct Surface {
    core::Hash128 lit;  ///< the instance, the lights that reach it, what stands in them
    std::vector<std::uint32_t> probes;         ///< indices
    std::vector<std::uint32_t> gridPoints;     ///< indices of the grid's points, valid or not
  };
  struct Point {
    core::Hash128 own;                   ///< the kind of point, where it is, how it is captured
    std::vector<std::uint32_t> surfaces;
  };
  friend class KeyMaker;

  bool fog_ = false;  ///< light of everywhere may be in it
  core::Hash128 base_;
  std::vector<Surface> surfaces_;
  std::vector<Point> points_;
  std::vector<core::Hash128> probePlaces_, gridPlaces_;  ///< of reflection probes; of all points of the grid
  std::vector<std::int32_t> gridCapture_;                ///< the capture point of each, -1: not valid
};

/// Hash of a capture point's result: what another bounce depends on.
core::Hash128 contentOf(const IrradianceSh& irradiance, const core::Hash128& radiance);

}  // namespace burnish::probe
