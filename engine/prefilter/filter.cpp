#include "prefilter/filter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "prefilter/cube.h"
#include "prefilter/lobe.h"
#include "prefilter/parallel.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kExactSize = 16;  ///< up to these faces bands are summed at the texels themselves

double wallMilliseconds() { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

NearLobe nearLobeOf(const Lobe& lobe, const Split& split) {
  NearLobe n;
  n.ggx = lobe.shape == ReflectionLobe::Ggx;
  n.slope = float((1 / lobe.alpha2 - 1) / 2);
  n.end = float(split.end);
  // Only where floats may need it (roughness under 0.025): c of x^6 grows like end^-6.
  const double scale = n.ggx || split.end > 1e-5 || !(split.end > 0) ? 1 : std::exp2(std::floor(-std::log2(split.end)));
  n.scale = float(scale);
  double power = 1;
  for (std::size_t k = 0; k < split.c.size(); ++k, power /= scale) n.c[k] = float(split.c[k] * power);
  return n;
}

FullLobe fullLobeOf(const Lobe& lobe) {
  FullLobe f;
  f.ggx = lobe.shape == ReflectionLobe::Ggx;
  f.halfPower = lobe.power / 2;
  f.slope = (1 / lobe.alpha2 - 1) / 2;
  f.end = f.ggx || lobe.power < 100 ? 1 : std::min(1.0, 4 / lobe.power * 46);  // e^-46 = 1e-20 of the peak
  return f;
}

/// Where a lobe is so narrow that it falls between the texels: the quotient of the sums is that of weights over the largest of them, those of the nearest texels. sums: as out of sumNear.
void sumNarrowest(const Source& source, const TexelsView& texels, const glm::dvec3& direction, const Lobe& lobe, double reach, double sums[4]) {
  std::vector<Run> runs;
  const glm::dvec3 r = aboutY(direction);
  // What the nearest texel's weight does not dwarf lies within the lobe's own reach of it.
  for (double angle = source.texelAngle() + 1.2 * reach;; angle *= 2) {
    const double end = angle < 1 ? 1 - std::cos(angle) : 2;
    if (angle < 0.25)
      source.runsNear(direction, end, runs);
    else
      runs.assign(1, {0, std::uint32_t(source.texels())});
    const auto each = [&](const auto& visit) {
      for (const Run& run : runs)
        for (std::size_t i = run.first; i < std::size_t(run.first) + run.count; ++i) {
          const glm::dvec3 d = glm::dvec3(texels.x[i], texels.y[i], texels.z[i]) - r;
          visit(i, glm::dot(d, d) / 2);
        }
    };
    double nearest = 4;
    each([&](std::size_t, double x) { nearest = std::min(nearest, x); });
    if (nearest > end && angle < 1) continue;
    const double top = std::log1p(-std::min(nearest, 1.0) / 2);
    std::fill(sums, sums + 4, 0.0);
    each([&](std::size_t i, double x) {
      if (x >= 1) return;
      const double w = std::exp(lobe.power / 2 * (std::log1p(-x / 2) - top)) * (1 - x);
      sums[0] += w * double(texels.r[i]), sums[1] += w * double(texels.g[i]), sums[2] += w * double(texels.b[i]), sums[3] += w * double(texels.solidAngle[i]);
    });
    // Bright texels are not in the arrays' light.
    for (std::size_t k = 0; k < source.bright.size(); k += 6) {
      const double* s = source.bright.data() + k;
      const glm::dvec3 d = glm::dvec3(s[0], s[1], s[2]) - r;
      const double x = glm::dot(d, d) / 2;
      if (x >= 1) continue;
      const double w = std::exp(lobe.power / 2 * (std::log1p(-x / 2) - top)) * (1 - x);
      for (int c = 0; c < 3; ++c) sums[c] += w * s[3 + c];
    }
    return;
  }
}

glm::dvec3 directionOf(const SortedPoints& points, std::size_t j) { return {points.x[j], points.z[j], points.y[j]}; }

CubeLevel filterLevel(const Source& source, const LevelSpec& spec, const Lobe& lobe, const Split& split, const Harmonics& harmonics, const FilterOptions& options, double* made) {
  const int threads = options.threads;
  std::shared_ptr<const RingGrid> grid;
  if (!split.far.empty() && spec.size > kExactSize) grid = ringGrid(split.bands(), gridChoice(options.error), made);
  const SortedPoints points = cubePoints(spec.size, grid ? grid->count() : 16, false, true);
  std::vector<double> sums(points.count() * 4, 0.0);
  double constant = 0;
  if (!split.far.empty()) {
    // Band 0 of the rest is nothing, and of the solid angles known: it is left to no rounding.
    std::vector<double> factor = split.far;
    constant = factor[0];
    factor[0] = 0;
    if (grid)
      evaluateAtPoints(harmonics, factor, *grid, points, threads, sums);
    else
      evaluateExactly(harmonics, factor, points, threads, sums);
  }
  const TexelsView* texels = split.end > 0 || split.all ? &source.texelArrays(threads) : nullptr;
  const NearLobe nearLobe = nearLobeOf(lobe, split);
  const FullLobe full = fullLobeOf(lobe);
  CubeLevel out{spec.size, spec.roughness, std::vector<float>(3 * points.count())};
  const std::size_t kPiece = split.all ? 1 : 512;
  const int pieces = int((points.count() + kPiece - 1) / kPiece);
  if (texels) {
    // In the order of texels, whose neighbours read the same part of the source.
    std::vector<std::uint32_t> sorted(points.count());
    for (std::size_t j = 0; j < points.count(); ++j) sorted[points.order[j]] = std::uint32_t(j);
    forEachPiece(pieces, threads, [&](int piece) {
      std::vector<Run> runs;
      for (std::size_t i = std::size_t(piece) * kPiece; i < std::min(points.count(), (std::size_t(piece) + 1) * kPiece); ++i) {
        const std::size_t j = sorted[i];
        const double r[3] = {points.x[j], points.y[j], points.z[j]};
        if (split.all) {
          sumTexels(*texels, 0, source.texels(), r, full, &sums[4 * j]);
          continue;
        }
        source.runsNear(directionOf(points, j), split.end, runs);
        sumNear(*texels, runs.data(), runs.size(), r, nearLobe, &sums[4 * j]);
      }
    });
  }
  forEachPiece(pieces, threads, [&](int piece) {
    const std::size_t first = std::size_t(piece) * kPiece, last = std::min(points.count(), first + kPiece);
    for (std::size_t j = first; j < last; ++j) sums[4 * j + 3] += constant;
    if (!source.bright.empty()) sumBright(points.view(), first, last, source.bright.data(), source.bright.size() / 6, full, sums.data());
    for (std::size_t j = first; j < last; ++j) {
      double* s = &sums[4 * j];
      // Far under the lobe's integral (8 π/p): it has missed the texels, and what was cut of it may count.
      if (split.far.empty() && !split.all && s[3] < 0.3 * 8 * kPi / lobe.power) sumNarrowest(source, *texels, directionOf(points, j), lobe, std::acos(1 - split.end), s);
      float* texel = out.texels.data() + 3 * std::size_t(points.order[j]);
      for (int c = 0; c < 3; ++c) {
        const double value = source.mean[c] + s[c] / s[3];
        texel[c] = float(std::min(options.clamp ? std::max(value, 0.0) : value, double(std::numeric_limits<float>::max())));
      }
    }
  });
  return out;
}

}  // namespace

std::vector<CubeLevel> filterLevels(const Source& source, std::span<const LevelSpec> levels, const FilterOptions& options, PrefilterReport* report, const std::function<void(double)>& progress) {
  std::vector<Lobe> lobes;
  std::vector<Split> splits;
  int bands = 0;
  double made = 0;
  for (const LevelSpec& spec : levels) {
    lobes.push_back(Lobe::of(options.lobe, spec.roughness));
    splits.push_back(splitLobe(lobes.back(), options.error, double(source.texels()), 6.0 * double(faceTexels(spec.size))));
    bands = std::max(bands, splits.back().bands());
  }
  const auto tell = [&](double share) {
    if (progress) progress(share);
  };
  tell(0);
  const Harmonics harmonics = bands > 0 ? source.analyse(bands, gridChoice(options.error), options.threads, &made) : Harmonics(0);
  tell(0.4);
  std::vector<CubeLevel> out;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double start = wallMilliseconds();
    out.push_back(filterLevel(source, levels[k], lobes[k], splits[k], harmonics, options, &made));
    if (report) {
      PrefilterReport::Level& l = report->levels.emplace_back();
      l.size = levels[k].size;
      l.roughness = levels[k].roughness;
      l.power = lobes[k].power;
      l.bands = splits[k].bands();
      if (splits[k].all) l.samples = int(std::min(source.texels(), std::size_t(1) << 30));
      if (splits[k].end > 0) l.samples = int(std::min(1e9, double(source.texels()) * splits[k].end / 2 * 1.3));
      l.ms = wallMilliseconds() - start;
    }
    tell(0.4 + 0.6 * double(k + 1) / double(levels.size()));
  }
  if (report) report->tablesMs += made;
  return out;
}

}  // namespace burnish::prefilter
