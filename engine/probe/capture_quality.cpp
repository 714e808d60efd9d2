#include "probe/capture.h"

namespace burnish::probe {

Quality captureQuality(const Quality& quality) {
  Quality q = quality;
  q.antialiasing = Antialiasing::None;
  q.specularAntialiasing = SpecularAntialiasing::None;
  q.bloom = Bloom::None;
  q.toneMap = ToneMap::None;
  // What the screen hides depends on where the eye is: light that probes bring has its shadows already.
  if (q.occlusion > Occlusion::Baked) q.occlusion = Occlusion::Baked;
  q.exposureEv.reset();
  return q;
}

}  // namespace burnish::probe
