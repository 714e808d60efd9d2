// Bounces: what a capture point gives, the set lit by it, and the judgement of how much light is still missing (docs/probes.md, "Baking").
#pragma once
#include <span>

#include "probe/capture.h"

namespace burnish::probe {

/// What a capture point gives in one bounce.
struct PointLight {
  Cubemap radiance;           ///< prefiltered; no levels: a grid point
  IrradianceSh irradiance{};  ///< over π, cd/m²
};

/// Capture points of a set: its reflection probes, then the grid's valid points in order.
int captureCount(const ProbeSet& places);

/// CPU time of the process, added to.
struct PointTime {
  double captureMs = 0, filterMs = 0;
};
/// Captures and filters one point, 0 <= index < captureCount(places), lit by the probes that `capture` has. The result depends on the scene, those probes, the point and the options alone.
Result<PointLight> capturePoint(Capture& capture, const ProbeSet& places, int index, const BakeOptions& options, PointTime& time);

/// The places with that light; lights.size() == captureCount(places). A grid's points keep `valid` and `distances`. The revision moves on from places'.
ProbeSet withLight(const ProbeSet& places, std::span<const PointLight> lights);
/// The places with black light: what bounce 1 is lit by. Where there is no light the sky does not get into the probes' boxes either.
ProbeSet blackLight(const ProbeSet& places, const BakeOptions& options);

/// How far two bounces are apart, over capture points, directions and channels: rms of the difference of irradiance over that of `now`, and the latter. 0 of 0 is 0.
struct Change {
  double share = 0;
  double light = 0;  ///< rms of irradiance over π, cd/m²
};
Change changeOf(std::span<const IrradianceSh> before, std::span<const IrradianceSh> now);

/// The log's next line: `before` holds the bounces so far. q is the ratio of what two bounces added (share · light of each, so that it does not shrink because the sum grows); the rest is
/// change · q / (1 - q), infinite where q is not known or at least 1. Error: light that goes on growing, q >= 1 in kGrowing bounces one after the other; it names the bounce.
Result<BounceReport> judge(std::span<const BounceReport> before, const Change& change);
/// Light that few points have and many get (a lamp in a far corner) adds more to the rms for a bounce or two than the bounce before, and no energy is made. Where it is, growth has no end.
constexpr int kGrowing = 3;

/// The first ratio compares light of emission and sky, which points see, with light of surfaces: it takes a second one to stop by.
constexpr int kLeastBounces = 3;
/// true: another bounce is wanted. Past options.maxBounces the answer is no: the caller says that the bake did not converge.
bool wantsMore(std::span<const BounceReport> bounces, const BakeOptions& options);

}  // namespace burnish::probe
