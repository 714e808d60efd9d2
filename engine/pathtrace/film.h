// What the pixels of a reference picture have gathered so far.
#pragma once
#include <burnish/measure.h>

#include <span>
#include <vector>

#include "pathtrace/sampler.h"
#include "pathtrace/world.h"

namespace burnish::pathtrace {

/// What one path brought.
struct FilmSample {
  glm::dvec3 radiance{0}, direct{0};
  Features features;
};

/// Sums in double, in order of the samples: what the rest of the picture does has no part in them. No padding: it is stored as it lies in memory.
struct Pixel {
  glm::dvec3 mean{0};     ///< of the radiance of the groups that are whole
  glm::dvec3 spread{0};   ///< sum over groups of samples · (group's mean - mean)²; of the first group's samples until the second one is whole
  glm::dvec3 group{0};    ///< sum over the group that is not whole yet
  glm::dvec3 direct{0}, albedo{0}, normal{0};  ///< sums over all samples
  double whole = 0, open = 0;                  ///< samples that count, in groups that are whole and in the open one
  /// `index`: of the sample, counting from 0; samples come in order. Returns false, and leaves it out, where it is not finite.
  bool add(std::uint32_t index, const FilmSample& sample);
  [[nodiscard]] glm::dvec3 radiance() const;
  /// Of radiance(), when `samples` were added. Groups of samples are independent of each other, so their scatter tells; of one sample nothing is known: its square.
  [[nodiscard]] glm::dvec3 variance(int samples) const;

 private:
  void take(const glm::dvec3& value, double count);
};
static_assert(sizeof(Pixel) == 20 * sizeof(double));

class Film {
 public:
  explicit Film(glm::ivec2 size) : size_(size), pixels_(std::size_t(size.x) * std::size_t(size.y)) {}
  [[nodiscard]] glm::ivec2 size() const { return size_; }
  [[nodiscard]] std::span<Pixel> pixels() { return pixels_; }
  [[nodiscard]] std::span<const Pixel> pixels() const { return pixels_; }
  int samples = 0;             ///< that each pixel got
  std::uint64_t dropped = 0;   ///< that were not finite
  /// ReferenceProgress::error.
  [[nodiscard]] double error() const;
  [[nodiscard]] ReferencePicture picture() const;

 private:
  glm::ivec2 size_;
  std::vector<Pixel> pixels_;
};

}  // namespace burnish::pathtrace
