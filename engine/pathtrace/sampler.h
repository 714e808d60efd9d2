// Random numbers of one sample of one pixel: what they are depends on pixel, sample and seed alone, never on threads or on the order of work.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace burnish::pathtrace {

/// Numbers in [0, 1), evenly spread over the samples of a pixel: Sobol's first two dimensions, shuffled and scrambled anew for each call (Owen 1995; Burley 2020, "Practical Hash-Based
/// Owen Scrambling"). The k-th call of a sample goes with the k-th calls of the pixel's other samples, so ask for the same thing at the same call where you can. Samples come in groups of
/// kGroup: within a group they are spread evenly, and groups are independent of each other, which is what the estimate of the noise rests on.
class Sampler {
 public:
  static constexpr int kGroup = 8;
  /// pixel: any number that tells pixels apart; sample: counting from 0.
  Sampler(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample);
  float next();
  glm::vec2 next2();

 private:
  std::uint32_t index_;  ///< in the group
  std::uint64_t state_;  ///< of pixel, group, seed and the calls so far
};

}  // namespace burnish::pathtrace
