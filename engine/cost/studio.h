// A renderer of its own beside the bench's: pictures of other scenes than the bench's, of its scene's light as a display has it, or on another context.
#pragma once
#include "cost/bench.h"

namespace burnish::cost {

/// F32 RGB, cd/m², as Bench::picture makes it but for holding. `key`: as pictureKey makes it.
Result<Image> linearPicture(Renderer& renderer, const OffscreenTarget& target, const Scene& scene, const View& view, const Quality& key);
/// Everything that shades as `quality` does has this key: what develops a picture is taken out.
Quality pictureKey(Quality quality, float exposureEv);

/// What it uploads for a scene goes with the Studio.
class Studio {
 public:
  /// The context must be current and stay so; the bench must outlive the studio.
  static Result<std::unique_ptr<Studio>> create(const ProcAddress& getProcAddress, const Bench& bench);

  /// F32 RGB, cd/m², as Bench::picture.
  Result<Image> picture(const Scene& scene, const Quality& quality);
  /// The frame of `scene` over that of the bench's scene, both with the base quality, each frame between two of the other's.
  Result<Spread> ratio(const Scene& scene, int rounds, const std::function<bool()>& goOn);
  /// Frees what is held for a scene.
  void release(const Scene& scene) { renderer_->release(scene); }

 private:
  explicit Studio(const Bench& bench) : bench_(bench) {}
  Result<double> frame(const Scene& scene);

  const Bench& bench_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<OffscreenTarget> display_, linear_;
};

}  // namespace burnish::cost
