#include "plan/temporal.h"

#include <fmt/format.h>

#include <algorithm>

namespace burnish::plan {
namespace {

// The digits of i in a base, mirrored at the point: [0, 1).
double mirrored(unsigned i, unsigned base) {
  double value = 0, place = 1;
  for (; i > 0; i /= base) {
    place /= base;
    value += place * (i % base);
  }
  return value;
}

std::string numbered(std::string_view name, int sequence, int which) { return sequence == 0 ? fmt::format("{}_{}", name, "ab"[which]) : fmt::format("{}_{}_{}", name, "ab"[which], sequence); }

}  // namespace

bool keepsHistory(const Quality& quality, const PlanOptions& options) {
  const bool listed = std::find(options.removed.begin(), options.removed.end(), "temporal_antialiasing") == options.removed.end();
  return listed && quality.antialiasing == Antialiasing::Temporal && options.debugView == DebugView::Final && !options.hostDepthIn;
}

glm::dvec2 jitterOf(unsigned frame) {
  const unsigned i = frame % 0x10000000u + 1;
  return {mirrored(i, 2) - 0.5, mirrored(i, 3) - 0.5};
}

std::string historyName(int sequence, int which) { return numbered("history", sequence, which); }
std::string historyDistanceName(int sequence, int which) { return numbered("history_distance", sequence, which); }

}  // namespace burnish::plan
