#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "inspect.h"
#include "messages.h"

namespace cli {
namespace {

using burnish::CubeLevel;
using burnish::EnvironmentFile;

constexpr double kNarrowLobe = 2.5;   // texels; bilinear sampling of narrower lobes errs by more than 2.5 % of the peak
constexpr int kSmallFace = 8;
constexpr double kMeanDrift = 0.02;   // of the mean radiance, which a filter does not change
constexpr std::string_view kFaces[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

struct LevelCount {
  float least = INFINITY, most = -INFINITY;
  double sum = 0, weight = 0;  ///< by solid angle
  std::uint64_t nan = 0, infinite = 0, negative = 0, overHalf = 0;
  std::size_t firstBad = 0;  ///< value index of the first that is NaN, infinite or negative
  [[nodiscard]] std::uint64_t bad() const { return nan + infinite + negative; }
  [[nodiscard]] double mean() const { return weight > 0 ? sum / weight : NAN; }
};

LevelCount count(const CubeLevel& level) {
  LevelCount out;
  const auto n = std::size_t(level.size);
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    const float v = level.texels[i];
    if (!(v >= 0 && std::isfinite(v))) {
      if (out.bad() == 0) out.firstBad = i;
      std::isnan(v) ? ++out.nan : std::isinf(v) ? ++out.infinite : ++out.negative;
      if (!std::isfinite(v)) continue;
    }
    const double u = 2 * (double(i / 3 % n) + 0.5) / double(n) - 1, w = 2 * (double(i / 3 / n % n) + 0.5) / double(n) - 1;
    const double angle = std::pow(1 + u * u + w * w, -1.5);
    out.sum += angle * double(v);
    out.weight += angle;
    out.least = std::min(out.least, v);
    out.most = std::max(out.most, v);
    out.overHalf += v > kMostHalf ? 1 : 0;
  }
  return out;
}

double powerOf(double roughness) { return 2 / std::pow(roughness, 4) - 2; }

/// What is wrong with one level, in words.
void faults(const EnvironmentFile& file, std::size_t k, const LevelCount& found, double firstMean, std::vector<std::string>& out) {
  const CubeLevel& level = file.cube.levels[k];
  const auto n = std::size_t(level.size);
  if (found.bad() > 0)
    out.push_back(fmt::format("level {}: {} NaN, {} infinite, {} negative values, the first on face {}, column {}, row {}", k, found.nan, found.infinite, found.negative,
                              kFaces[found.firstBad / 3 / n / n], found.firstBad / 3 % n, found.firstBad / 3 / n % n));
  if (found.overHalf > 0) out.push_back(fmt::format("level {}: {} values above 65504, which half floats do not hold", k, found.overHalf));
  if (found.most <= 0) out.push_back(fmt::format("level {}: black", k));
  if (!file.cube.lobe || k == 0) return;
  // Half-width of the lobe in texels at a face's centre: 1.06 α N (docs/shading.md, section 5).
  const double width = 1.06 * level.roughness * level.roughness * level.size;
  if (level.roughness > 0 && width < kNarrowLobe) out.push_back(fmt::format("level {}: the lobe's half-width is {:.2f} texels, under {}: bilinear sampling will show it", k, width, kNarrowLobe));
  if (level.size < kSmallFace) out.push_back(fmt::format("level {}: faces under {}x{}: bilinear sampling will show them", k, kSmallFace, kSmallFace));
  if (std::abs(found.mean() / firstMean - 1) > kMeanDrift) out.push_back(fmt::format("level {}: its mean is {:.1f} % off level 0's; a filter keeps it", k, 100 * (found.mean() / firstMean - 1)));
}

}  // namespace

void printCubemap(const EnvironmentFile& file, const burnish::Report& report, const std::string& name) {
  fmt::print("{}\n", shown(name));
  fmt::print("format: {}{}\n", shown(file.layout), file.writer.empty() ? "" : ", written by " + shown(file.writer));
  if (!file.isCube()) return;
  const auto& levels = file.cube.levels;
  fmt::print("size: {0}x{0}, 6 faces, {1} level{2}\n", levels[0].size, levels.size(), levels.size() == 1 ? "" : "s");
  fmt::print("lobe: {}\n", !file.cube.lobe ? "none: not filtered, or by a program that does not say for which" : *file.cube.lobe == burnish::ReflectionLobe::Ggx ? "ggx" : "blinn-phong");
  fmt::print("  {:>5} {:>5} {:>9} {:>12} {:>12} {:>12} {:>12}\n", "level", "size", "roughness", "power", "min", "max", "mean");
  std::vector<std::string> wrong;
  double firstMean = 0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const LevelCount found = count(levels[k]);
    if (k == 0) firstMean = found.mean();
    const std::string power = levels[k].roughness > 0 ? fmt::format("{:.2f}", powerOf(levels[k].roughness)) : "-";
    fmt::print("  {:>5} {:>5} {:>9} {:>12} {:>12.6g} {:>12.6g} {:>12.6g}\n", k, levels[k].size, file.cube.lobe ? fmt::format("{:.4f}", levels[k].roughness) : "-", power, found.least, found.most, found.mean());
    faults(file, k, found, firstMean, wrong);
  }
  for (const burnish::Warning& warning : report.warnings()) wrong.push_back(warning.what);
  fmt::print("wrong: {}\n", wrong.empty() ? "nothing" : "");
  for (const std::string& text : wrong) fmt::print("  {}\n", shown(text));
}

}  // namespace cli
