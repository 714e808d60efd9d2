#include "cost/front.h"

#include <fmt/format.h>

#include <algorithm>

namespace burnish::cost {
namespace {

constexpr double kSame = 2.9e-4;  ///< of rms: what the light buffer's half floats round off at most, uniform over 2^-11 of a value

bool dominates(const RungCost& a, const Spread& timeA, const RungCost& b, const Spread& timeB) {
  if (timeA.count == 0 || timeB.count == 0) return false;
  const double spread = a.exact.rmsSpread + b.exact.rmsSpread + kSame;
  const bool noSlower = timeA.median <= timeB.high, noWorse = a.exact.rms <= b.exact.rms + spread;
  const bool faster = timeA.high < timeB.low, better = a.exact.rms + spread < b.exact.rms;
  return noSlower && noWorse && (faster || better);
}

template <class T>
void addNumber(std::vector<std::string>& out, const char* name, T value, T base) {
  if (value != base) out.push_back(fmt::format("{}={}", name, value));
}

}  // namespace

std::vector<std::string> settingsOf(const Quality& quality, const Quality& base) {
  std::vector<std::string> out;
  for (std::size_t t = 0; t < terms().size(); ++t)
    if (rungOf(quality, t) != rungOf(base, t)) out.push_back(fmt::format("{}={}", terms()[t].name, terms()[t].rungs[rungOf(quality, t)].name));
  addNumber(out, "shadow-resolution", quality.shadowResolution, base.shadowResolution);
  addNumber(out, "shadow-cascades", quality.shadowCascades, base.shadowCascades);
  addNumber(out, "shadow-distance", quality.shadowDistance, base.shadowDistance);
  addNumber(out, "shadow-maps", quality.shadowMaps, base.shadowMaps);
  addNumber(out, "resolution-scale", quality.resolutionScale, base.resolutionScale);
  addNumber(out, "light-threshold", quality.lightThreshold, base.lightThreshold);
  addNumber(out, "occlusion-radius", quality.occlusionRadius, base.occlusionRadius);
  addNumber(out, "transparent-layers", quality.transparentLayers, base.transparentLayers);
  return out;
}

void sortFront(std::vector<FrontPoint>& front) {
  std::stable_sort(front.begin(), front.end(), [](const FrontPoint& a, const FrontPoint& b) { return a.ms.median < b.ms.median; });
  for (FrontPoint& point : front)
    point.dominated = std::any_of(front.begin(), front.end(), [&](const FrontPoint& other) {
      const bool noWorse = other.ms.median <= point.ms.median && other.error.rms <= point.error.rms;
      return noWorse && (other.ms.median < point.ms.median || other.error.rms < point.error.rms);
    });
}

void markDominated(std::vector<RungCost>& rungs, const std::vector<Spread>& ratios) {
  for (std::size_t b = 0; b < rungs.size(); ++b)
    for (std::size_t a = 0; a < rungs.size(); ++a)
      if (a != b && dominates(rungs[a], ratios[a], rungs[b], ratios[b])) rungs[b].dominated = true;
}

void findContributors(CostReport& report, const std::string& missing) {
  for (const TermCost& term : report.terms) {
    if (term.choice || !term.setting.empty()) continue;
    const auto exact = std::find_if(term.rungs.begin(), term.rungs.end(), [&](const RungCost& r) { return r.name == term.exactRung; });
    if (exact == term.rungs.end() || exact->inForce) continue;
    const auto base = std::find_if(term.rungs.begin(), term.rungs.end(), [](const RungCost& r) { return r.inForce; });
    if (base == term.rungs.end()) continue;
    report.contributors.emplace_back(fmt::format("{}: {} in place of {}", term.name, exact->name, base->name), base->truth.rms - exact->truth.rms);
  }
  report.contributors.emplace_back("all terms at once (the preset exact)", report.base.error.rms - report.exact.error.rms);
  report.contributors.emplace_back(fmt::format("what the preset exact leaves: {}", missing), report.exact.error.rms);
  std::stable_sort(report.contributors.begin(), report.contributors.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
}

}  // namespace burnish::cost
