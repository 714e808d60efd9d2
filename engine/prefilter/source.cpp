#include "prefilter/source.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prefilter/cube.h"
#include "prefilter/parallel.h"
#include "prefilter/source_parts.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

class CubeSource final : public Source {
 public:
  CubeSource(const CubeLevel& cube, int threads) : cube_(cube), solidAngle_(texelSolidAngles(cube.size)) {
    const int size = cube.size;
    std::vector<RowSum> rows(std::size_t(6 * size));
    forEachPiece(6 * size, threads, [&](int row) {
      RowSum& sum = rows[std::size_t(row)];
      for (int x = 0; x < size; ++x) {
        const double w = solidAngle_[std::size_t(row % size) * std::size_t(size) + std::size_t(x)];
        const float* p = cube.texels.data() + 3 * (std::size_t(row) * std::size_t(size) + std::size_t(x));
        sum.light += glm::dvec3(p[0], p[1], p[2]) * w;
        sum.solidAngle += w;
      }
    });
    RowSum all;
    for (const RowSum& r : rows) all.light += r.light, all.solidAngle += r.solidAngle;
    const glm::dvec3 average = all.light / all.solidAngle;
    brightTexels_ = brightOf(texels(), std::max({average.x, average.y, average.z}), [&](std::size_t i) { return largest(cube.texels.data() + 3 * i); });
    setMean(all);
  }
  [[nodiscard]] std::size_t texels() const override { return 6 * faceTexels(cube_.size); }
  [[nodiscard]] double texelAngle() const override { return 2 * std::sqrt(2.0) / cube_.size; }

  [[nodiscard]] Harmonics analyse(int bands, const GridChoice& choice, int threads, double* made) const override {
    Harmonics out(bands);
    const auto grid = ringGrid(bands, choice, made);
    SortedPoints points = cubePoints(cube_.size, grid->count(), true, true);
    std::vector<bool> dark;
    if (!brightTexels_.empty()) {
      dark.resize(texels());
      for (const std::uint32_t i : brightTexels_) dark[i] = true;
    }
    constexpr std::size_t kPiece = 1 << 14;
    const double perFace = 1 / double(solidAngle_.size());
    forEachPiece(int((points.count() + kPiece - 1) / kPiece), threads, [&](int piece) {
      for (std::size_t j = std::size_t(piece) * kPiece; j < std::min(points.count(), (std::size_t(piece) + 1) * kPiece); ++j) {
        const std::size_t i = points.order[j];
        const double w = solidAngle_[i - std::size_t((double(i) + 0.5) * perFace) * solidAngle_.size()];  // the remainder, without a division
        for (std::size_t c = 0; c < 3; ++c) points.values[4 * j + c] = !dark.empty() && dark[i] ? 0.0 : (double(cube_.texels[3 * i + c]) - mean[int(c)]) * w;
        points.values[4 * j + 3] = w;
      }
    });
    analysePoints(points, *grid, threads, out);
    return out;
  }

  [[nodiscard]] const TexelsView& texelArrays(int threads) const override {
    if (!arrays_.v.empty()) return arrays_.view;
    arrays_.make(texels());
    const int size = cube_.size;
    forEachPiece(6 * size, threads, [&](int row) {
      const int face = row / size, y = row % size;
      const double v = (2.0 * y + 1) / size - 1;
      for (int x = 0; x < size; ++x) {
        const std::size_t i = std::size_t(row) * std::size_t(size) + std::size_t(x);
        const double w = solidAngle_[std::size_t(y) * std::size_t(size) + std::size_t(x)], u = (2.0 * x + 1) / size - 1;
        const float* p = cube_.texels.data() + 3 * i;
        arrays_.set(i, aboutY(cubeDirection(face, u, v)) / std::sqrt(u * u + v * v + 1), (glm::dvec3(p[0], p[1], p[2]) - mean) * w, w);
      }
    });
    for (const std::uint32_t i : brightTexels_) arrays_.set(i, direction(i), glm::dvec3(0), solidAngle_[i % solidAngle_.size()]);
    return arrays_.view;
  }

  // A cone of less than 17 degrees meets a face's plane in an ellipse: its bounds along u and v.
  void runsNear(const glm::dvec3& d, double end, std::vector<Run>& runs) const override {
    const double cosine = 1 - end, sine2 = end * (2 - end), sine = std::sqrt(sine2);
    const int size = cube_.size;
    runs.clear();
    for (int face = 0; face < 6; ++face) {
      // d along the face's axis and its u and v: cubeDirection().
      const double sign = face % 2 ? -1 : 1, w = sign * d[face / 2];
      const double u = face < 2 ? -sign * d.z : face < 4 ? d.x : sign * d.x, v = face < 2 || face > 3 ? -d.y : sign * d.z;
      // The corners are 54.7 degrees from the axis: (1, 1)/sqrt(3) rotated by the cone's angle.
      if (w < 0.5773 * cosine - 0.8165 * sine) continue;
      const std::size_t base = std::size_t(face) * faceTexels(size);
      const double depth = w * w - sine2;
      if (w <= 0 || depth < 1e-3 || cosine * cosine - u * u < 1e-3) {
        runs.push_back({std::uint32_t(base), std::uint32_t(faceTexels(size))});
        continue;
      }
      const double root = sine * std::sqrt(std::max(v * v + depth, 0.0)), from = (v * w - root) / depth, to = (v * w + root) / depth;
      const int top = std::max(0, int(std::floor(std::clamp((from + 1) / 2 * size - 0.5, -1.0, size + 1.0)))), bottom = std::min(size - 1, int(std::ceil(std::clamp((to + 1) / 2 * size - 0.5, -2.0, double(size)))));
      constexpr int kRows = 64;
      std::int32_t first[kRows + 16], last[kRows + 16];
      for (int y = top; y <= bottom; y += kRows) {
        const int count = std::min(kRows, bottom - y + 1);
        coneRows({u, v, w, cosine * cosine, size}, y, count, first, last);
        for (int i = 0; i < count; ++i) {
          const int left = std::max(first[i], 0), right = std::min(last[i], size - 1);
          if (left <= right) runs.push_back({std::uint32_t(base + std::size_t(y + i) * std::size_t(size) + std::size_t(left)), std::uint32_t(right - left + 1)});
        }
      }
    }
  }

 private:
  [[nodiscard]] glm::dvec3 direction(std::size_t i) const {
    const std::size_t n = std::size_t(cube_.size), inFace = i % faceTexels(cube_.size);
    return aboutY(texelDirection(cube_.size, int(i / faceTexels(cube_.size)), int(inFace % n), int(inFace / n)));
  }
  void setMean(const RowSum& all) {
    RowSum rest = all;
    for (const std::uint32_t i : brightTexels_) {
      const double w = solidAngle_[i % solidAngle_.size()];
      rest.light -= glm::dvec3(cube_.texels[3 * i], cube_.texels[3 * i + 1], cube_.texels[3 * i + 2]) * w;
      rest.solidAngle -= w;
    }
    // What a bright texel hides below the rounding of the whole sum is summed up without it.
    if (!brightTexels_.empty()) rest = darkSum();
    mean = rest.solidAngle > 0 ? rest.light / rest.solidAngle : glm::dvec3(0);
    for (const std::uint32_t i : brightTexels_) {
      const glm::dvec3 at = direction(i), light = (glm::dvec3(cube_.texels[3 * i], cube_.texels[3 * i + 1], cube_.texels[3 * i + 2]) - mean) * solidAngle_[i % solidAngle_.size()];
      bright.insert(bright.end(), {at.x, at.y, at.z, light.x, light.y, light.z});
    }
  }
  [[nodiscard]] RowSum darkSum() const {
    RowSum sum;
    std::size_t next = 0;
    for (std::size_t i = 0; i < texels(); ++i) {
      if (next < brightTexels_.size() && brightTexels_[next] == i) {
        ++next;
        continue;
      }
      const double w = solidAngle_[i % solidAngle_.size()];
      sum.light += glm::dvec3(cube_.texels[3 * i], cube_.texels[3 * i + 1], cube_.texels[3 * i + 2]) * w;
      sum.solidAngle += w;
    }
    return sum;
  }

  const CubeLevel& cube_;
  std::vector<double> solidAngle_;
  mutable TexelArrays arrays_;
};

}  // namespace

SortedPoints cubePoints(int size, int bins, bool values, bool order) {
  SortedPoints p;
  const std::size_t n = std::size_t(size), face = faceTexels(size), count = 6 * face;
  // By symmetry: the four faces around the axis share their heights, the two others their distances from it and, up to a mirror, their azimuths.
  std::vector<std::uint16_t> aroundBin(face), poleBin(face);
  std::vector<float> aroundTurn(n), poleTurn(face);
  std::vector<double> edge(n), aroundZ(face), scale(face);
  const auto binOf = [&](double z) { return std::uint16_t(std::clamp(int(std::acos(float(z)) / float(kPi) * float(bins)), 0, bins - 1)); };
  for (std::size_t i = 0; i < n; ++i) {
    edge[i] = (2.0 * double(i) + 1) / size - 1;
    aroundTurn[i] = float(std::atan(edge[i]) / (2 * kPi));
  }
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t i = y * n + x;
      scale[i] = 1 / std::sqrt(edge[x] * edge[x] + edge[y] * edge[y] + 1);
      aroundZ[i] = -edge[y] * scale[i];
      aroundBin[i] = binOf(aroundZ[i]);
      poleBin[i] = binOf(scale[i]);
      poleTurn[i] = float(std::atan2(float(edge[y]), float(edge[x])) / float(2 * kPi));
    }
  p.firstOfBin.assign(std::size_t(bins) + 1, 0);
  const auto binAt = [&](int f, std::size_t i) { return f == 2 ? poleBin[i] : f == 3 ? std::size_t(bins - 1) - poleBin[i] : aroundBin[i]; };
  for (int f = 0; f < 6; ++f)
    for (std::size_t i = 0; i < face; ++i) ++p.firstOfBin[binAt(f, i) + 1];
  for (std::size_t b = 0; b < std::size_t(bins); ++b) p.firstOfBin[b + 1] += p.firstOfBin[b];
  p.x.resize(count + kRingGroup);
  p.y.resize(count + kRingGroup);
  p.z.resize(count + kRingGroup);
  p.turn.resize(count + kRingGroup);
  for (std::size_t i = count; i < count + kRingGroup; ++i) p.x[i] = p.y[i] = p.z[i] = 0;
  if (order) p.order.resize(count);
  if (values) p.values.resize(4 * count);
  std::vector<std::uint32_t> next = p.firstOfBin;
  // Neighbours in a bin are far apart on the sphere, so that spreading one does not wait for what the one before has stored.
  std::size_t step = std::size_t(0.382 * double(n)) | 1;
  while (std::gcd(step, n) != 1) step += 2;
  for (int f = 0; f < 6; ++f)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t k = 0, x = 0; k < n; ++k, x = (x + step) % n) {
        const std::size_t i = y * n + x, j = next[binAt(f, i)]++;
        const glm::dvec3 d = aboutY(cubeDirection(f, edge[x], edge[y])) * scale[i];
        p.x[j] = d.x;
        p.y[j] = d.y;
        p.z[j] = d.z;
        // Azimuth of (x, y) about the axis: +X at 0, +Z at a quarter.
        float turn = 0;
        switch (f) {
          case 0: turn = -aroundTurn[x]; break;         // (1, -u)
          case 1: turn = 0.5f - aroundTurn[x]; break;   // (-1, u)
          case 2: turn = poleTurn[i]; break;            // (u, v)
          case 3: turn = -poleTurn[i]; break;           // (u, -v)
          case 4: turn = 0.25f - aroundTurn[x]; break;  // (u, 1)
          default: turn = 0.75f - aroundTurn[x]; break; // (-u, -1)
        }
        p.turn[j] = turn < 0 ? turn + 1 : turn;
        if (order) p.order[j] = std::uint32_t(std::size_t(f) * face + i);
      }
  return p;
}

std::unique_ptr<Source> makeSource(const CubeLevel& cube, int threads) { return std::make_unique<CubeSource>(cube, threads); }

}  // namespace burnish::prefilter
