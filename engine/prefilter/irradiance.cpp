#include "prefilter/irradiance.h"

#include <algorithm>
#include <cmath>

#include "prefilter/cube.h"
#include "prefilter/filter.h"
#include "prefilter/parallel.h"

namespace burnish::prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::array<double, 9> basisAt(const glm::dvec3& d) { return {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y}; }

// Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": eq. 3 (the basis' constants, here squared: they come once from the projection and once from the
// evaluation), eq. 8 (A_l / π = 1, 2/3, 1/4).
constexpr double kFactor[9] = {1 / (4 * kPi),          3 / (4 * kPi) * 2 / 3, 3 / (4 * kPi) * 2 / 3,   3 / (4 * kPi) * 2 / 3, 15 / (4 * kPi) / 4,
                               15 / (4 * kPi) / 4,     5 / (16 * kPi) / 4,    15 / (4 * kPi) / 4,      15 / (16 * kPi) / 4};

/// row(i, sums): adds radiance · solid angle · basis of row i to sums. Rows are summed up in their order.
template <class Row>
IrradianceSh summed(int rows, int threads, const Row& row) {
  std::vector<IrradianceSh> parts(std::size_t(rows), IrradianceSh{});
  forEachPiece(rows, threads, [&](int i) { row(i, parts[std::size_t(i)]); });
  IrradianceSh all{};
  for (const IrradianceSh& part : parts)
    for (std::size_t k = 0; k < 9; ++k) all[k] += part[k];
  for (std::size_t k = 0; k < 9; ++k) all[k] *= kFactor[k];
  return all;
}

/// Least over the sphere of any channel: a grid of directions.
double least(const IrradianceSh& sh) {
  double lowest = 1e300;
  constexpr int kSize = 24;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const glm::dvec3 e = irradianceAt(sh, texelDirection(kSize, face, x, y));
        lowest = std::min({lowest, e.x, e.y, e.z});
      }
  return lowest;
}

IrradianceSh windowed(const IrradianceSh& sh, double lambda) {
  IrradianceSh out = sh;
  for (std::size_t k = 1; k < 9; ++k) out[k] /= 1 + lambda * (k < 4 ? 4 : 36);
  return out;
}

}  // namespace

IrradianceSh irradianceOf(const CubeLevel& cube, int threads) {
  const std::vector<double> weight = texelSolidAngles(cube.size);
  const std::size_t n = std::size_t(cube.size);
  return summed(6 * cube.size, threads, [&](int row, IrradianceSh& sums) {
    const float* p = cube.texels.data() + 3 * std::size_t(row) * n;
    for (std::size_t x = 0; x < n; ++x, p += 3) {
      const std::array<double, 9> basis = basisAt(texelDirection(cube.size, row / cube.size, int(x), row % cube.size));
      const glm::dvec3 light = glm::dvec3(p[0], p[1], p[2]) * weight[std::size_t(row % cube.size) * n + x];
      for (std::size_t k = 0; k < 9; ++k) sums[k] += light * basis[k];
    }
  });
}

IrradianceSh irradianceOf(const Image& latLong, int threads) {
  const int width = latLong.width, height = latLong.height;
  std::vector<double> sine, cosine;
  for (int x = 0; x < width; ++x) {
    const double longitude = ((x + 0.5) / width - 0.5) * 2 * kPi;
    sine.push_back(std::sin(longitude));
    cosine.push_back(std::cos(longitude));
  }
  return summed(height, threads, [&](int y, IrradianceSh& sums) {
    const double polar = (y + 0.5) / height * kPi, s = std::sin(polar), up = std::cos(polar), solidAngle = 2 * s * std::sin(kPi / 2 / height) * 2 * kPi / width;
    const float* p = latLong.f32() + std::size_t(y) * std::size_t(width) * std::size_t(latLong.channels);
    // Along a row the basis is a polynomial of sine and cosine: six sums make the nine.
    glm::dvec3 one(0), byS(0), byC(0), bySc(0), byCc(0);
    for (std::size_t x = 0; x < std::size_t(width); ++x, p += latLong.channels) {
      const glm::dvec3 light(p[0], p[1], p[2]);
      one += light, byS += light * sine[x], byC += light * cosine[x], bySc += light * (sine[x] * cosine[x]), byCc += light * (cosine[x] * cosine[x]);
    }
    // The direction is (s sine, up, -s cosine).
    const glm::dvec3 values[9] = {one, one * up, -byC * s, byS * s, byS * (s * up), -byC * (s * up), byCc * (3 * s * s) - one, -bySc * (s * s), (one - byCc) * (s * s) - one * (up * up)};
    for (std::size_t k = 0; k < 9; ++k) sums[k] += values[k] * solidAngle;
  });
}

glm::dvec3 irradianceAt(const IrradianceSh& sh, const glm::dvec3& n) {
  const std::array<double, 9> basis = basisAt(n);
  glm::dvec3 sum(0);
  for (std::size_t k = 0; k < 9; ++k) sum += sh[k] * basis[k];
  return sum;
}

double deRing(IrradianceSh& sh) {
  if (least(sh) >= 0) return 0;
  double low = 0, high = 1e-3;
  while (least(windowed(sh, high)) < 0 && high < 1e6) high *= 2;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (least(windowed(sh, middle)) < 0 ? low : high) = middle;
  }
  sh = windowed(sh, high * 1.02);  // between the grid's directions
  return high * 1.02;
}

// The lobe of power 0 is the cosine.
CubeLevel irradianceCube(const Source& source, int size, double error, int threads) {
  const LevelSpec spec{size, 1};
  FilterOptions options;
  options.error = error;
  options.threads = threads;
  return filterLevels(source, {&spec, 1}, options).front();
}

}  // namespace burnish::prefilter
