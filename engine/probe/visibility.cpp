#include "probe/visibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prefilter/parallel.h"
#include "reference/shading.h"

namespace burnish::probe {
namespace {

using reference::Hit;
using reference::Ray;
namespace shading = burnish::shading::f64;

constexpr int kLookSize = 8;          // an octahedral map of so many texels a side: directions for the looks around that need no map
constexpr double kSomeBacks = 0.2;    // of the rays that tell: from here on it is asked whether a body is around the point
constexpr int kRaysPerTexelSide = 4;  // of a map of distances: its square: rays a texel

// The middles of texels of a map with an even number of them are symmetric about its middle.
glm::dvec3 lookDirection(int i) { return shading::distanceDirection(i % kLookSize + 0.5, i / kLookSize + 0.5, kLookSize); }  // NOLINT(bugprone-integer-division)

int opposite(int i) {
  const glm::dvec2 texel = glm::floor(shading::distanceTexel(-lookDirection(i), kLookSize));
  return int(texel.x) + kLookSize * int(texel.y);
}

/// One-sided opaque surfaces that the ray leaves more often than it enters them, in order.
std::vector<std::uint32_t> leftBy(const Geometry& geometry, const Ray& ray, std::vector<Hit>& hits) {
  geometry.rays.all(ray, hits);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.mesh < b.mesh; });
  std::vector<std::uint32_t> out;
  for (std::size_t from = 0, to = 0; from < hits.size(); from = to) {
    int balance = 0;
    for (to = from; to < hits.size() && hits[to].mesh == hits[from].mesh; ++to) balance += hits[to].back ? 1 : -1;
    if (balance > 0 && !geometry.surfaces[hits[from].mesh].twoSided) out.push_back(hits[from].mesh);
  }
  return out;
}

/// In all of many directions one and the same instance is left more often than entered.
bool inBody(const Geometry& geometry, glm::dvec3 point) {
  constexpr int kStep = 5;  // every fifth direction: 13 of them, on all sides
  std::vector<Hit> hits;
  std::vector<std::uint32_t> bodies;
  for (int i = 0; i < kLookSize * kLookSize; i += kStep) {
    std::vector<std::uint32_t> now = leftBy(geometry, {point, lookDirection(i), 0, std::numeric_limits<double>::infinity(), kOpaque}, hits);
    if (i > 0) std::erase_if(now, [&](std::uint32_t mesh) { return !std::binary_search(bodies.begin(), bodies.end(), mesh); });
    bodies = std::move(now);
    if (bodies.empty()) return false;
  }
  return true;
}

bool lattice(const AmbientGrid& grid) {
  for (int k = 0; k < 3; ++k)
    if (grid.counts[k] < 1 || !(grid.spacing[k] > 0) || !std::isfinite(grid.spacing[k]) || !std::isfinite(grid.origin[k])) return false;
  return true;
}

}  // namespace

Side sideOf(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  if (geometry.surfaces[hit.mesh].twoSided) return Side::Unknown;
  // The other sheet may be met a little before or behind.
  const double slack = 1e-6 * hit.distance + 4 * geometry.rays.rounding();
  Ray again = ray;
  again.from = std::max(0.0, hit.distance - slack);
  again.to = hit.distance + slack;
  again.cull = true;
  if (hit.back) return geometry.rays.nearest(again) ? Side::Unknown : Side::Back;
  // From the other end what faces this way is a back.
  again.origin = ray.origin + ray.direction * (2 * hit.distance);
  again.direction = -ray.direction;
  return geometry.rays.nearest(again) ? Side::Unknown : Side::Front;
}

bool isFree(const Geometry& geometry, glm::dvec3 point, double touch) {
  constexpr int kDirections = kLookSize * kLookSize;
  int fronts = 0, backs = 0;
  std::array<double, kDirections> distances{};
  for (int i = 0; i < kDirections; ++i) {
    const Ray ray{point, lookDirection(i), 0, std::numeric_limits<double>::infinity(), kOpaque};
    const Hit hit = geometry.rays.nearest(ray);
    distances[std::size_t(i)] = hit.distance;
    if (!hit) continue;
    if (hit.distance < touch) return false;
    const Side side = sideOf(geometry, ray, hit);
    fronts += side == Side::Front;
    backs += side == Side::Back;
  }
  for (int i = 0; i < kDirections; ++i)
    if (distances[std::size_t(i)] + distances[std::size_t(opposite(i))] < kCrack) return false;
  if (backs > fronts) return false;
  return backs == 0 || backs < kSomeBacks * (backs + fronts) || !inBody(geometry, point);
}

double skyShare(const Geometry& geometry, glm::dvec3 point) {
  int open = 0;
  for (int i = 0; i < kLookSize * kLookSize; ++i)
    if (!geometry.rays.occluded({point, lookDirection(i), 0, std::numeric_limits<double>::infinity(), kOpaque | kTransparent})) ++open;
  return double(open) / (kLookSize * kLookSize);
}

AmbientGrid::Point lookAround(const Geometry& geometry, glm::dvec3 point, glm::dvec3 spacing) {
  constexpr int kSize = AmbientGrid::kDistanceSize;
  const double limit = shading::distanceLimit(spacing);
  AmbientGrid::Point out;
  out.valid = isFree(geometry, point, kTouchShare * std::min({spacing.x, spacing.y, spacing.z}));
  out.distances.resize(kSize * kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      double sum = 0, squares = 0;
      for (int r = 0; r < kRaysPerTexelSide * kRaysPerTexelSide; ++r) {
        const double u = x + (r % kRaysPerTexelSide + 0.5) / kRaysPerTexelSide, v = y + (r / kRaysPerTexelSide + 0.5) / kRaysPerTexelSide;  // NOLINT(bugprone-integer-division)
        const double d = std::min(geometry.rays.nearest({point, shading::distanceDirection(u, v, kSize), 0, limit, kOpaque}).distance, limit);
        sum += d;
        squares += d * d;
      }
      constexpr double kShare = 1.0 / (kRaysPerTexelSide * kRaysPerTexelSide);
      out.distances[std::size_t(y * kSize + x)] = {float(sum * kShare), float(squares * kShare)};
    }
  return out;
}

Result<void> fillPoints(const Geometry& geometry, AmbientGrid& grid, int threads, const std::function<void(double)>& progress) {
  if (!lattice(grid)) return fail(fmt::format("lattice '{}'", grid.name), "its counts, spacing or origin are no lattice", "counts of at least 1 and spacing above 0 are needed");
  const double total = double(grid.counts.x) * grid.counts.y * grid.counts.z;
  if (total > double(kMaxLatticePoints)) return fail(fmt::format("lattice '{}'", grid.name), fmt::format("has {:.0f} points, at most {} can be taken", total, kMaxLatticePoints), "enlarge its spacing");
  grid.points.assign(std::size_t(total), {});
  const int rows = grid.counts.y * grid.counts.z;
  constexpr int kBatch = 64;  // rows between two calls of progress
  for (int first = 0; first < rows; first += kBatch) {
    if (progress) progress(double(first) / rows);
    prefilter::forEachPiece(std::min(kBatch, rows - first), prefilter::threadsFor(threads), [&](int piece) {
      const int row = first + piece;
      for (int x = 0; x < grid.counts.x; ++x)
        grid.points[std::size_t(row) * std::size_t(grid.counts.x) + std::size_t(x)] = lookAround(geometry, grid.position({x, row % grid.counts.y, row / grid.counts.y}), grid.spacing);
    });
  }
  if (progress) progress(1);
  return {};
}

std::vector<Id<Instance>> visibleInstances(const Geometry& geometry, glm::dvec3 point, int size) {
  std::vector<bool> seen(geometry.surfaces.size());
  std::vector<Hit> passed;
  const bool seeThrough = std::any_of(geometry.surfaces.begin(), geometry.surfaces.end(), [](const Geometry::Surface& s) { return s.look != kOpaque; });
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < size * size; ++i) {
      glm::dvec3 direction;
      direction[face / 2] = face % 2 ? -1 : 1;
      direction[(face / 2 + 1) % 3] = (2 * (i % size) + 1.0) / size - 1;
      direction[(face / 2 + 2) % 3] = (2 * (i / size) + 1.0) / size - 1;
      Ray ray{point, direction, 0, std::numeric_limits<double>::infinity(), kOpaque, true};
      if (const Hit hit = geometry.rays.nearest(ray)) {
        seen[hit.mesh] = true;
        ray.to = hit.distance;
      }
      if (!seeThrough) continue;
      ray.mask = kCutout | kTransparent;
      geometry.rays.all(ray, passed);
      for (const Hit& hit : passed) seen[hit.mesh] = true;
    }
  std::vector<Id<Instance>> out;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i]) out.push_back(geometry.surfaces[i].instance);
  return out;
}

}  // namespace burnish::probe
