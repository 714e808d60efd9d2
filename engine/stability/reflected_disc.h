// H27: a light's reflection as the renderer samples it: its own cube, its own mapping from roughness to level, GL's seamless bilinear filter.
#pragma once
#include "gl/program.h"
#include "stability/disc.h"

namespace burnish::stability {

struct ReflectedLevel {
  int level = 0;
  double roughness = 0;
  double bilinear = 0;  ///< error of a perfect level's bilinear samples, share of the peak
  double ours = 0;      ///< of the renderer's
  double beyond = 0;    ///< between the two
  double at = 0;        ///< where that is, radians from the disc's middle
};
/// Each level of the renderer's cube but the first, under a lat-long picture of the disc of that width; `lookups` directions out to four half-widths. The context must be current, its state gl::setDefaults'.
Result<std::vector<ReflectedLevel>> reflectedDisc(gl::Device& device, gl::ProgramCache& programs, const Disc& disc, int width, int lookups);

}  // namespace burnish::stability
