#include "plan/scaling.h"

#include <algorithm>
#include <cmath>

namespace burnish::plan {

float scaleOf(const Quality& quality) { return std::isfinite(quality.resolutionScale) ? std::clamp(quality.resolutionScale, 0.25f, 1.0f) : 1.0f; }

glm::ivec2 shadedSize(const Quality& quality, const PlanOptions& options) {
  const bool listed = std::find(options.removed.begin(), options.removed.end(), "upscaling") == options.removed.end();
  const double scale = double(scaleOf(quality));
  if (!listed || scale >= 1 || options.debugView != DebugView::Final || options.hostDepthIn) return options.size;
  const auto side = [scale](int pixels) { return std::max(int(std::lround(pixels * scale)), std::min(pixels, 1)); };
  return {side(options.size.x), side(options.size.y)};
}

}  // namespace burnish::plan
