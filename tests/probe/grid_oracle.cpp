#include "grid_oracle.h"

#include <algorithm>
#include <cmath>

namespace burnish::test {
namespace {

using glm::dvec3;
constexpr double kPi = 3.14159265358979323846;

/// The share of a plane's cosine-weighted hemisphere (normal n) that a convex polygon takes as seen from the origin; what lies under the horizon is cut off (Lambert 1760; Baum, Rushmeier and Winget
/// 1989, "Improving radiosity solutions through the use of analytically determined form-factors", eq. 8). The polygon's front must face the origin (counter-clockwise from there).
double formFactor(const std::array<dvec3, 4>& corners, const dvec3& n) {
  std::array<dvec3, 5> cut;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 &a = corners[i], &b = corners[(i + 1) % 4];
    const double ha = dot(a, n), hb = dot(b, n);
    if (ha >= 0) cut[count++] = a;
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) cut[count++] = a + (b - a) * (ha / (ha - hb));
    if (count == 5) break;
  }
  if (count < 3) return 0;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const dvec3 &a = cut[i], &b = cut[(i + 1) % count];
    const dvec3 c = cross(a, b);
    const double s = length(c);
    if (s < 1e-15 * (length(a) * length(b))) continue;
    sum += std::atan2(s, dot(a, b)) * dot(c, n) / s;
  }
  return std::max(sum / (2 * kPi), 0.0);
}

/// Borders between cells along a side, denser toward the ends.
std::vector<double> borders(int cells) {
  std::vector<double> all;
  for (int i = 0; i <= cells; ++i) all.push_back((1 - std::cos(kPi * i / cells)) / 2);
  return all;
}

/// Corners counter-clockwise as seen from inside.
std::array<dvec3, 4> rectangle(int wall, double u0, double u1, double v0, double v1) {
  std::array<dvec3, 4> c{wallPoint(wall, u0, v0), wallPoint(wall, u1, v0), wallPoint(wall, u1, v1), wallPoint(wall, u0, v1)};
  if (dot(cross(c[1] - c[0], c[3] - c[0]), wallNormal(wall)) < 0) std::swap(c[1], c[3]);
  // Lambert's sum is positive for polygons that run clockwise about the direction to them.
  std::swap(c[1], c[3]);
  return c;
}

std::array<double, 9> basis(const dvec3& d) {
  return {1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
}

}  // namespace

dvec3 wallNormal(int wall) {
  dvec3 n(0);
  n[wall / 2] = wall % 2 ? -1 : 1;
  return n;
}
dvec3 wallPoint(int wall, double u, double v) {
  dvec3 p;
  const int axis = wall / 2;
  p[axis] = wall % 2;
  p[(axis + 1) % 3] = u;
  p[(axis + 2) % 3] = v;
  return p;
}

CubeOracle::CubeOracle(double albedo, int cells, double emission, bool allEmit) : albedo_(albedo), emission_(emission), allEmit_(allEmit) {
  const std::vector<double> at = borders(cells);
  const std::size_t n = std::size_t(cells);
  for (int wall = 0; wall < 6; ++wall)
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t u = 0; u < n; ++u) cells_.push_back({rectangle(wall, at[u], at[u + 1], at[v], at[v + 1]), wallNormal(wall), 0});
  // The light is the same under turns and mirrors about the vertical: a cell is known by its wall (floor, ceiling, side) and the distances to the nearest edges.
  const auto fold = [&](std::size_t i) { return std::min(i, n - 1 - i); };
  const auto classOf = [&](std::size_t k) {
    const std::size_t wall = k / (n * n), v = k / n % n, u = k % n;
    if (wall / 2 == 1) {
      const std::size_t a = std::min(fold(u), fold(v)), b = std::max(fold(u), fold(v));
      return ((wall % 2) * n + a) * n + b;
    }
    // Sides: axis x has (y, z) as (u, v), axis z has (x, y).
    const std::size_t height = wall / 2 == 0 ? u : v, across = wall / 2 == 0 ? v : u;
    return (2 * n + height) * n + fold(across);
  };
  std::vector<int> row(4 * n * n, -1);
  std::vector<std::size_t> first;
  std::vector<std::size_t> cls(cells_.size());
  for (std::size_t k = 0; k < cells_.size(); ++k) {
    int& r = row[classOf(k)];
    if (r < 0) r = int(first.size()), first.push_back(k);
    cls[k] = std::size_t(r);
  }
  const std::size_t m = first.size();
  std::vector<double> factor(m * m, 0.0), light(m, 0.0), emitted(m), next(m);
  for (std::size_t i = 0; i < m; ++i) {
    const Cell& to = cells_[first[i]];
    const dvec3 p = (to.corner[0] + to.corner[2]) * 0.5;
    const std::size_t wall = first[i] / (n * n);
    emitted[i] = allEmit_ || wall == 3 ? emission_ : 0;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      if (k / (n * n) == wall) continue;
      std::array<dvec3, 4> seen = cells_[k].corner;
      for (dvec3& c : seen) c -= p;
      factor[i * m + cls[k]] += formFactor(seen, to.normal);
    }
  }
  light = emitted;
  for (int turn = 0; turn < 400; ++turn) {
    residual_ = 0;
    for (std::size_t i = 0; i < m; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < m; ++j) sum += factor[i * m + j] * light[j];
      next[i] = emitted[i] + albedo_ * sum;
      residual_ = std::max(residual_, std::abs(next[i] - light[i]));
    }
    light = next;
    if (residual_ < 1e-13) break;
  }
  for (std::size_t k = 0; k < cells_.size(); ++k) cells_[k].radiance = light[cls[k]];
}

double CubeOracle::irradiance(const dvec3& p, const dvec3& n) const {
  double sum = 0;
  for (const Cell& c : cells_) {
    if (std::abs(dot(c.corner[0] - p, c.normal)) < 1e-12) continue;  // the wall that the point lies on
    std::array<dvec3, 4> seen = c.corner;
    for (dvec3& s : seen) s -= p;
    sum += c.radiance * formFactor(seen, n);
  }
  return sum;
}

double CubeOracle::radiance(int wall, const dvec3& p) const { return (allEmit_ || wall == 3 ? emission_ : 0) + albedo_ * irradiance(p, wallNormal(wall)); }

std::array<double, 9> CubeOracle::harmonics(const dvec3& p) const {
  // Integrals of the basis against the cosine lobe, over π (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": A_l = π, 2π/3, π/4).
  static constexpr double kBand[9] = {1 / (4 * kPi),       2 / (4 * kPi),  2 / (4 * kPi),      2 / (4 * kPi), 15 / (16 * kPi), 15 / (16 * kPi), 5 / (64 * kPi),
                                      15 / (16 * kPi), 15 / (64 * kPi)};
  static constexpr double kNode[4] = {-0.861136311594052575, -0.339981043584856265, 0.339981043584856265, 0.861136311594052575};
  static constexpr double kWeight[4] = {0.347854845137453857, 0.652145154862546143, 0.652145154862546143, 0.347854845137453857};
  std::array<double, 9> sum{};
  const auto add = [&](const auto& self, const std::array<dvec3, 4>& c, const dvec3& normal, double radiance) -> void {
    const dvec3 middle = (c[0] + c[2]) * 0.5;
    const dvec3 s = c[1] - c[0], t = c[3] - c[0];
    const double far = length(middle - p), size = std::max(length(s), length(t));
    if (size > 0.5 * far && size > 1e-4) {
      const dvec3 a = c[0] + s * 0.5, b = c[1] + t * 0.5, d = c[3] + s * 0.5, e = c[0] + t * 0.5;
      self(self, {c[0], a, middle, e}, normal, radiance);
      self(self, {a, c[1], b, middle}, normal, radiance);
      self(self, {middle, b, c[2], d}, normal, radiance);
      self(self, {e, middle, d, c[3]}, normal, radiance);
      return;
    }
    const double area = length(cross(s, t)) / 4;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const dvec3 d = middle + s * (kNode[i] / 2) + t * (kNode[j] / 2) - p;
        const double r2 = dot(d, d), r = std::sqrt(r2);
        const double w = radiance * kWeight[i] * kWeight[j] * area * -dot(d, normal) / (r2 * r);
        const std::array<double, 9> y = basis(d / r);
        for (std::size_t k = 0; k < 9; ++k) sum[k] += w * y[k];
      }
  };
  for (const Cell& c : cells_) add(add, c.corner, c.normal, c.radiance);
  for (std::size_t k = 0; k < 9; ++k) sum[k] *= kBand[k];
  return sum;
}

}  // namespace burnish::test
