// The pyramid of the bloom: how many levels a view of some height has, and how much of the scattered light each holds.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace burnish::plan {

/// Octaves of width that scattered light is spread over, equally: light falls off as 1/r², as in eyes and lenses (Spencer, Shirley, Zimmerman and Greenberg 1995, "Physically-Based
/// Glare Effects for Digital Images").
inline constexpr float kBloomOctaves = 6;

/// Weight of level k for a view of that height. A texel of level k is 2^(k+1) pixels wide; widths from 1/512 to 1/4 of the height count, with an octave of ramp at both ends,
/// so that the weights of all levels add up to kBloomOctaves whatever the height. Levels finer than a pixel are not there: their light stays where it is.
inline float bloomWeight(int level, int height) {
  const float octave = float(level + 1) - std::log2(float(std::max(height, 1)));
  return std::clamp(octave + 9.0f, 0.0f, 1.0f) * std::clamp(-2.0f - octave, 0.0f, 1.0f);
}
/// Levels with a weight, and those under them; at least 1.
inline int bloomLevels(int height) { return std::max(1, int(std::ceil(std::log2(float(std::max(height, 1))) - 3))); }
/// Size of level 0: half the picture, rounded up so that every level is half of the last one and holds ceil(size / 2^(k+1)) texels.
inline glm::ivec2 bloomSize(glm::ivec2 size) {
  const int texel = 1 << bloomLevels(size.y);
  return (size + texel - 1) / texel * (texel / 2);
}

}  // namespace burnish::plan
