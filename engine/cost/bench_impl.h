// What a bench holds.
#pragma once
#include "cost/assistant.h"
#include "cost/bench.h"

namespace burnish::cost {

struct Bench::Impl {
  Impl(const Scene& s, const View& v, glm::ivec2 pixels, const Quality& q, Report& r) : scene(s), view(v), size(pixels), base(q), report(r) {}

  const Scene& scene;
  const View& view;
  glm::ivec2 size;
  Quality base;
  Report& report;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<OffscreenTarget> display, linear;
  float exposureEv = 0;
  void (*finish)() = nullptr;  ///< glFinish

  struct Kept {
    Quality key;
    Image picture;
  };
  std::vector<std::unique_ptr<Kept>> pictures;
  std::unique_ptr<Assistant> assistant;  ///< makes pictures too; goes before what it reads

  [[nodiscard]] const Image* kept(const Quality& key) const;
  Result<Image> shoot(const Quality& key);  ///< with the bench's own renderer

  std::vector<TargetPlan> targets;     ///< of the frame before
  std::vector<double> baseMedians;     ///< of the calls of time()
  std::vector<double> lastBaseFrames;  ///< of the last call
  int baseCount = 0;                   ///< frames of all calls

  /// One frame, milliseconds of its passes.
  struct Frame {
    double total = 0;
    std::map<std::string, double> passes;
    bool settled = false;  ///< nothing was made, uploaded or kept out that the next frame of this quality would not have either
  };
  Result<Frame> drawOnce(const Quality& quality);
  /// The medians of a few frames where they are short.
  Result<Frame> draw(const Quality& quality);
  /// Draws until a frame is settled, three times at most; also again where it took more than thrice the least so far: the driver had dropped a program's code and made it anew. `least` is brought up
  /// to date.
  Result<Frame> settledFrame(const Quality& quality, double& least);
};

}  // namespace burnish::cost
