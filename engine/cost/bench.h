// The bench: pictures and times of one view with any quality, on one renderer. Times are interleaved with the base quality's, so that drift of the machine cancels.
#pragma once
#include <burnish/measure.h>
#include <burnish/renderer.h>

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace burnish::cost {

/// Median of the values; low and high are where a repeat of as many values has its median 19 times in 20 if they scatter as these do. Empty: count 0.
Spread spreadOf(std::vector<double> values);
/// The spread of a product of independent figures: relative widths add up in squares.
Spread times(const Spread& a, const Spread& b);

/// Opens a context and makes it current on the calling thread.
using ContextMaker = std::function<Result<std::unique_ptr<Context>>()>;

/// Times of one quality. Milliseconds of the bench's clock.
struct Timing {
  Spread frame;                          ///< the sum of all passes
  Spread ratio;                          ///< frame over the base's frames beside it: narrower than `frame` where the machine drifts
  Spread passes;                         ///< the sum of the passes that were named
  Spread passesRatio;                    ///< that, over the base's frames beside it
  std::map<std::string, Spread> byPass;  ///< every pass of the frame
};

class Bench {
 public:
  /// The context must be current and stay so; scene and view must outlive the bench and not change. `base` with no exposure: the base picture is metered, and pictures are developed with that.
  static Result<std::unique_ptr<Bench>> create(const ProcAddress& getProcAddress, const Scene& scene, const View& view, glm::ivec2 size, const Quality& base, Report& report);
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  [[nodiscard]] const Capabilities& capabilities() const;
  [[nodiscard]] const char* clock() const;  ///< "CPU time" (software renderers: user + system of the process, each pass finished before the next) or "GPU time"
  [[nodiscard]] const Scene& scene() const;
  [[nodiscard]] const View& view() const;
  [[nodiscard]] glm::ivec2 size() const;
  [[nodiscard]] const Quality& base() const;  ///< as given
  [[nodiscard]] float exposureEv() const;     ///< EV100 that pictures are developed with
  [[nodiscard]] double white() const;         ///< cd/m² that this exposure shows as 1

  /// What the renderer would do for the quality, as it is timed (display output).
  [[nodiscard]] FramePlan plan(const Quality& quality) const;
  /// Pictures hold each channel at this many whites: a display shows what is brighter as it shows this, and a mirrored lamp of a hundred whites would outweigh all other pixels in a mean of squares.
  static constexpr double kShown = 4;
  /// What is brighter is held there, as in pictures.
  void hold(Image& linear) const;
  /// Ground truth as pictures are held against it: radiance and variance. What is held has no noise.
  struct Truth {
    Image radiance, variance;
  };
  [[nodiscard]] Truth held(const ReferencePicture& truth) const;
  /// F32 RGB, cd/m², rows from top to bottom: linear up to kShown whites, without antialiasing, through pixel centres. Rendered once for each quality and kept until forget(); the pointer holds until then.
  /// What only develops a picture (tone map, exposure, bloom, antialiasing) makes no difference.
  Result<const Image*> picture(const Quality& quality);
  /// picture() of each, in their order: the pointers hold until forget(). With an assistant it makes a part of them at the same time. `goOn` is asked before each, on either thread: false leaves
  /// out (nullptr) what is not there yet.
  Result<std::vector<const Image*>> pictures(std::span<const Quality> qualities, const std::function<bool()>& goOn = {});
  /// From now on pictures() has half of its work done on a second thread, whose context `open` makes current there: drivers compile on one thread, and where they keep compiled programs for all contexts (Mesa's
  /// shader cache) those need not be made again here. Where no context comes, all goes on as before, with a warning.
  void assist(ContextMaker open);
  /// Drops all pictures but the base's and those of these qualities.
  void forget(std::span<const Quality> but = {});
  /// U8 RGB: tone map of the base, exposure of the bench (shaders/shading/tonemap.h).
  [[nodiscard]] Image developed(const Image& linear) const;

  /// Times of each quality, in order, over `rounds` rounds (at least 1), each frame between two of the base's. `passes`: whose sum Timing::passes is; names that a frame lacks count nothing.
  /// Frames are as a user's: display output, the quality's own antialiasing and exposure; uploads done, shadow maps drawn, programs compiled before anything counts. `goOn` is asked between rounds and
  /// during the warm-up: false ends with what is there (an error where there is no full round).
  Result<std::vector<Timing>> time(std::span<const Quality> qualities, int rounds, std::span<const std::string> passes = {}, const std::function<bool()>& goOn = {});
  /// The base's frame over everything that was timed so far; count 0 before the first.
  [[nodiscard]] Spread baseFrame() const;

 private:
  Bench();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace burnish::cost
