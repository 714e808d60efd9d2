#include "lighting/light_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "interface/limits.h"
#include "plan/variants.h"

namespace burnish::lighting {
namespace {

constexpr std::uint8_t kBrushed = 1, kRough = 2;
std::uint8_t bitsOf(plan::Details d) { return std::uint8_t((d.brushed ? kBrushed : 0) | (d.rough ? kRough : 0)); }
plan::Details detailsOf(std::uint8_t bits) { return {(bits & kBrushed) != 0, (bits & kRough) != 0}; }

/// All kinds of lists, each right for what those before it are for.
constexpr std::array kLists = [] {
  std::array<int, std::size(plan::kTileBuckets) + 3> lists{};
  std::copy(std::begin(plan::kTileBuckets), std::end(plan::kTileBuckets), lists.begin());
  std::copy_n(std::array{plan::kLoop, plan::kLoopSpots, plan::kLoopShadows}.begin(), 3, lists.end() - 3);
  return lists;
}();
int rankOf(int bucket) { return int(std::find(kLists.begin(), kLists.end(), bucket) - kLists.begin()); }
/// A program that draws less than this part of the tiles is not worth having.
constexpr std::size_t kFewTiles = 50;

int bucketOf(std::uint32_t count) {
  for (int b : plan::kTileBuckets)
    if (std::uint32_t(b) >= count) return b;
  return plan::kLoop;
}

// The stored depth halfway between two distances.
float middleDepth(float near, float far, glm::dvec2 params, bool orthographic) {
  if (orthographic) return (near + far) * 0.5f;
  const double a = params.x / (double(near) + params.y), b = params.x / (double(far) + params.y);
  return float(params.x / ((a + b) * 0.5) - params.y);
}

void splitTile(TileDepth& t, const float* depth, int stride, int w, int h, glm::dvec2 params, bool orthographic) {
  const float middle = middleDepth(t.near, t.far, params, orthographic);
  float nearEnd[TILE_SIZE], farBegin[TILE_SIZE];
  std::fill(std::begin(nearEnd), std::end(nearEnd), t.near);
  std::fill(std::begin(farBegin), std::end(farBegin), t.far);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const float z = depth[std::size_t(y) * std::size_t(stride) + std::size_t(x)];
      const float inNear = z >= middle ? z : t.near, inFar = z < middle ? z : t.far;
      nearEnd[x] = inNear < nearEnd[x] ? inNear : nearEnd[x];
      farBegin[x] = inFar > farBegin[x] ? inFar : farBegin[x];
    }
  t.nearEnd = *std::min_element(std::begin(nearEnd), std::end(nearEnd));
  t.farBegin = *std::max_element(std::begin(farBegin), std::end(farBegin));
}

}  // namespace

void reduceDepth(const float* depth, int stride, int width, int height, glm::dvec2 depthParams, bool orthographic, std::vector<TileDepth>& out) {
  const int columns = (width + TILE_SIZE - 1) / TILE_SIZE, rows = (height + TILE_SIZE - 1) / TILE_SIZE;
  out.assign(std::size_t(columns * rows), {});
  for (int ty = 0; ty < rows; ++ty) {
    const int h = std::min(TILE_SIZE, height - ty * TILE_SIZE);
    for (int tx = 0; tx < columns; ++tx) {
      const int w = std::min(TILE_SIZE, width - tx * TILE_SIZE);
      const float* corner = depth + std::size_t(ty * TILE_SIZE) * std::size_t(stride) + std::size_t(tx * TILE_SIZE);
      // A maximum and a minimum for each column of the tile, so that the inner loop is one vector wide.
      float high[TILE_SIZE] = {}, low[TILE_SIZE], any[TILE_SIZE];
      std::fill(std::begin(any), std::end(any), 2.0f);
      std::fill(std::begin(low), std::end(low), 2.0f);
      for (int y = 0; y < h; ++y) {
        const float* row = corner + std::size_t(y) * std::size_t(stride);
        for (int x = 0; x < w; ++x) {
          const float z = row[x];
          high[x] = z > high[x] ? z : high[x];
          any[x] = z < any[x] ? z : any[x];
          const float drawn = z > 0 ? z : 2.0f;
          low[x] = drawn < low[x] ? drawn : low[x];
        }
      }
      TileDepth& t = out[std::size_t(ty * columns + tx)];
      t.near = *std::max_element(std::begin(high), std::end(high));
      if (!(t.near > 0)) continue;
      t.far = *std::min_element(std::begin(low), std::end(low));
      splitTile(t, corner, stride, w, h, depthParams, orthographic);
      if (!(*std::min_element(std::begin(any), std::end(any)) > 0)) t.nearEnd = -t.nearEnd;
    }
  }
}

void TileCuller::boundTiles(const scene::ViewFrame& view, std::span<const TileDepth> depths) {
  boxes_.resize(depths.size());
  slices_.assign(depths.size(), 0);
  const double w = view.viewport.z, h = view.viewport.w;
  const auto distance = [&view](float z) { return view.orthographic ? view.depthParams.x - double(z) * view.depthParams.y : view.depthParams.x / (double(z) + view.depthParams.y); };
  for (int ty = 0; ty < rows_; ++ty) {
    const double y0 = (2.0 * (ty * TILE_SIZE + view.jitter.y) / h - 1) * view.tanY, y1 = (2.0 * ((ty + 1) * TILE_SIZE + view.jitter.y) / h - 1) * view.tanY;
    for (int tx = 0; tx < columns_; ++tx) {
      const std::size_t i = std::size_t(ty * columns_ + tx);
      const TileDepth& t = depths[i];
      if (t.far < 0) continue;
      const double x0 = (2.0 * (tx * TILE_SIZE + view.jitter.x) / w - 1) * view.tanX, x1 = (2.0 * ((tx + 1) * TILE_SIZE + view.jitter.x) / w - 1) * view.tanX;
      const auto box = [&](double z0, double z1) {
        const double s0 = view.orthographic ? 1 : z0, s1 = view.orthographic ? 1 : z1;
        const double slack = 1e-5 * (std::abs(z1) + 1e-3);  // floats of the shader's own position
        return Box{float(std::min(x0 * s0, x0 * s1) - slack), float(std::max(x1 * s0, x1 * s1) + slack), float(std::min(y0 * s0, y0 * s1) - slack),
                   float(std::max(y1 * s0, y1 * s1) + slack), float(z0 - slack),                         float(z1 + slack)};
      };
      const double near = distance(t.near), nearEnd = distance(std::abs(t.nearEnd)), farBegin = distance(t.farBegin), far = distance(t.far);
      // One slice where the halves touch: nothing is gained by two.
      slices_[i] = farBegin - nearEnd > 0.05 * (far - near) ? 2 : 1;
      boxes_[i][0] = slices_[i] == 2 ? box(near, nearEnd) : box(near, far);
      boxes_[i][1] = box(farBegin, far);
    }
  }
}

void TileCuller::cullLight(const scene::ViewFrame& view, const scene::LocalLight& light, std::uint16_t index) {
  const glm::dvec3 p(light.position);
  const double x = glm::dot(view.axes[0], p), y = glm::dot(view.axes[1], p), z = -glm::dot(view.axes[2], p), r = light.radius;
  if (!view.orthographic && z + r < near_) return;
  // The sphere's box on the image plane: extremes of (c ± r)/d over its depths, which begin at the near plane.
  const double dNear = view.orthographic ? 1 : std::max(z - r, near_), dFar = view.orthographic ? 1 : z + r;
  const auto low = [&](double c) { return std::min((c - r) / dNear, (c - r) / dFar); };
  const auto high = [&](double c) { return std::max((c + r) / dNear, (c + r) / dFar); };
  const double w = view.viewport.z, h = view.viewport.w;
  const auto tileAt = [](double image, double tan, double pixels, double jitter, int tiles) { return int(std::clamp(std::floor(((image / tan + 1) * 0.5 * pixels - jitter) / TILE_SIZE), -1.0, double(tiles))); };
  const int tx0 = std::max(tileAt(low(x), view.tanX, w, view.jitter.x, columns_), 0), tx1 = std::min(tileAt(high(x), view.tanX, w, view.jitter.x, columns_), columns_ - 1);
  const int ty0 = std::max(tileAt(low(y), view.tanY, h, view.jitter.y, rows_), 0), ty1 = std::min(tileAt(high(y), view.tanY, h, view.jitter.y, rows_), rows_ - 1);
  const bool spot = light.cosOuter > -1;
  const glm::vec3 axis(float(glm::dot(view.axes[0], glm::dvec3(light.axis))), float(glm::dot(view.axes[1], glm::dvec3(light.axis))), float(-glm::dot(view.axes[2], glm::dvec3(light.axis))));
  const float cosOuter = light.cosOuter, sinOuter = std::sqrt(std::max(1 - cosOuter * cosOuter, 0.0f));
  const glm::vec3 c{float(x), float(y), float(z)};
  const float r2 = float(r * r * 1.0001);
  const auto meets = [&](const Box& b) {
    const float dx = std::max({b.minX - c.x, c.x - b.maxX, 0.0f}), dy = std::max({b.minY - c.y, c.y - b.maxY, 0.0f}), dz = std::max({b.minZ - c.z, c.z - b.maxZ, 0.0f});
    if (dx * dx + dy * dy + dz * dz > r2) return false;
    if (!spot) return true;
    // Cone against the slice's bounding sphere (Wronski 2017, "Cull that cone").
    const glm::vec3 low3(b.minX, b.minY, b.minZ), high3(b.maxX, b.maxY, b.maxZ);
    const float radius = glm::length(high3 - low3) * 0.5f;
    const glm::vec3 v = (low3 + high3) * 0.5f - c;
    const float along = glm::dot(v, axis), across = std::sqrt(std::max(glm::dot(v, v) - along * along, 0.0f));
    return cosOuter * across - along * sinOuter <= radius && along >= -radius;
  };
  for (int ty = ty0; ty <= ty1; ++ty)
    for (int tx = tx0; tx <= tx1; ++tx) {
      const std::size_t i = std::size_t(ty * columns_ + tx);
      if (slices_[i] == 0) continue;
      if (meets(boxes_[i][0]) || (slices_[i] == 2 && meets(boxes_[i][1]))) pairs_.push_back({std::uint32_t(i), index});
    }
}

// Extremes on the image plane; what reaches the near plane may be anywhere.
TileCuller::Spanned TileCuller::spanOf(const scene::ViewFrame& view, const std::array<glm::dvec3, 8>& corners) const {
  Spanned s;
  glm::dvec2 imageLow(1e300), imageHigh(-1e300);
  for (const glm::dvec3& q : corners) {
    s.low = glm::min(s.low, q);
    s.high = glm::max(s.high, q);
    const glm::dvec2 image = glm::dvec2(q) / (view.orthographic ? 1.0 : std::max(q.z, 1e-9));
    imageLow = glm::min(imageLow, image);
    imageHigh = glm::max(imageHigh, image);
  }
  if (!view.orthographic && s.high.z < near_) return s;
  const bool whole = !view.orthographic && s.low.z < near_ * 1.01;
  // A pixel more to either side: views that are sampled over time are shifted within one.
  const auto tileAt = [](double image, double tan, double pixels, int tiles, double more) { return int(std::clamp(std::floor(((image / tan + 1) * 0.5 * pixels + more) / TILE_SIZE), -1.0, double(tiles))); };
  const double w = view.viewport.z, h = view.viewport.w;
  s.tx0 = whole ? 0 : std::max(tileAt(imageLow.x, view.tanX, w, columns_, -1), 0);
  s.tx1 = whole ? columns_ - 1 : std::min(tileAt(imageHigh.x, view.tanX, w, columns_, 1), columns_ - 1);
  s.ty0 = whole ? 0 : std::max(tileAt(imageLow.y, view.tanY, h, rows_, -1), 0);
  s.ty1 = whole ? rows_ - 1 : std::min(tileAt(imageHigh.y, view.tanY, h, rows_, 1), rows_ - 1);
  return s;
}

void TileCuller::markDetail(const scene::ViewFrame& view, const DetailBox& box) {
  std::array<glm::dvec3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec3 p = glm::dvec3(box.center) + glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1) * glm::dvec3(box.extent) * 1.0001;
    corners[i] = {glm::dot(view.axes[0], p), glm::dot(view.axes[1], p), -glm::dot(view.axes[2], p)};
  }
  const Spanned s = spanOf(view, corners);
  const auto meets = [&](const Box& b) { return double(b.maxZ) >= s.low.z && double(b.minZ) <= s.high.z; };
  for (int ty = s.ty0; ty <= s.ty1; ++ty)
    for (int tx = s.tx0; tx <= s.tx1; ++tx) {
      const std::size_t i = std::size_t(ty * columns_ + tx);
      if (slices_[i] > 0 && (meets(boxes_[i][0]) || (slices_[i] == 2 && meets(boxes_[i][1])))) detail_[i] |= bitsOf(box.details);
    }
}

// A counting sort: the lights of each tile in a row.
void TileCuller::sortPairs() {
  counts_.assign(slices_.size(), 0);
  for (const Pair& p : pairs_) ++counts_[p.tile];
  offsets_.resize(slices_.size());
  std::uint32_t total = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    offsets_[i] = total;
    total += counts_[i];
  }
  sorted_.resize(total);
  std::vector<std::uint32_t> next = offsets_;
  for (const Pair& p : pairs_) sorted_[next[p.tile]++] = p.light;
}

void TileCuller::keepReached(std::span<const scene::LocalLight> lights, TileSurfaces& surfaces) {
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    if (counts_[i] == 0) continue;
    surfaces.load(int(i) % columns_, int(i) / columns_);
    std::uint16_t* const first = sorted_.data() + offsets_[i];
    counts_[i] = std::uint32_t(std::remove_if(first, first + counts_[i], [&](std::uint16_t light) { return !surfaces.reached(lights[light - 1u]); }) - first);
  }
}

// The program that suits each tile best; then one for several where a program would draw few tiles: a software renderer compiles each for a third of a second, and every driver binds it in each frame.
void TileCuller::choosePrograms(std::span<const scene::LocalLight> lights, std::size_t shadowed) {
  programs_.assign(slices_.size(), {});
  shadowed_.assign(slices_.size(), 0);
  std::map<TileProgram, std::size_t> users;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < slices_.size(); ++i) {
    if (slices_[i] == 0) continue;
    bool spots = false;
    for (std::uint32_t k = 0; k < counts_[i]; ++k) {
      const std::uint16_t light = sorted_[offsets_[i] + k];
      spots = spots || lights[light - 1u].cosOuter > -1;
      shadowed_[i] = std::uint16_t(shadowed_[i] + (light <= shadowed));
    }
    TileProgram& p = programs_[i];
    p.places = probes_.empty() ? plan::Places::None : plan::placesOf(probeCounts_[i]);
    p.detail = detail_[i];
    p.list = rankOf(shadowed_[i] ? plan::kLoopShadows : spots ? plan::kLoopSpots : p.detail > 0 && counts_[i] > 0 ? plan::kLoop : bucketOf(counts_[i]));
    ++users[p];
    ++lit;
  }
  // What lists more lights, pads fewer; a loop does for all. Several places do for one and for none. Only what has tiles of its own takes others: it is in the plan.
  std::map<TileProgram, TileProgram> instead;
  const auto move = [&](const TileProgram& from, plan::Places places) {
    for (auto to = users.upper_bound({places, from.detail, places == from.places ? from.list : -1}); to != users.end() && to->first.places == places && to->first.detail == from.detail; ++to) {
      if (to->first.list < from.list) continue;
      to->second += users.at(from);
      instead[from] = to->first;
      users.erase(from);
      return true;
    }
    return false;
  };
  for (const auto& [p, count] : std::map(users))
    if (users.at(p) * kFewTiles < lit && !move(p, p.places) && p.places != plan::Places::Many) (void)move(p, plan::Places::Many);
  for (TileProgram& p : programs_)
    for (auto to = instead.find(p); to != instead.end(); to = instead.find(p)) p = to->second;
}

// A counting sort: the tiles of each program in a row.
void TileCuller::buildLists(std::size_t lights) {
  lists_.tiles.clear();
  lists_.groups.clear();
  lists_.entries.clear();
  lists_.probes.clear();
  std::vector<std::uint8_t> seen(lights + 1);
  std::map<TileProgram, std::vector<std::uint32_t>> groups;
  for (std::size_t i = 0; i < slices_.size(); ++i)
    if (slices_[i] > 0) groups[programs_[i]].push_back(std::uint32_t(i));
  for (const auto& [program, tiles] : groups) {
    const int bucket = kLists[std::size_t(program.list)];
    lists_.groups.push_back({bucket, int(lists_.tiles.size()), int(tiles.size()), program.places, detailsOf(program.detail)});
    for (const std::uint32_t i : tiles) {
      const std::size_t first = lists_.entries.size();
      for (std::uint32_t k = 0; k < counts_[i]; ++k) {
        const std::uint16_t light = sorted_[offsets_[i] + k];
        lists_.entries.push_back(light);
        seen[light] = 1;
      }
      if (bucket > 0) lists_.entries.resize(first + std::size_t(bucket), 0);
      lists_.tiles.emplace_back(int(i) % columns_, int(i) / columns_, int(first), int(lists_.entries.size() - first) + (int(shadowed_[i]) << 16));
      if (!probes_.empty()) lists_.probes.push_back(probes_[i]);
    }
  }
  lists_.lightsInView = int(std::count(seen.begin(), seen.end(), 1));
  if (lists_.entries.empty()) lists_.entries.push_back(0);
}

void TileCuller::listBackground(std::span<const TileDepth> depths) {
  lists_.background = {0, int(lists_.tiles.size()), 0};
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (depths[i].showsBackground()) lists_.tiles.emplace_back(int(i) % columns_, int(i) / columns_, 0, 0);
  lists_.background.count = int(lists_.tiles.size()) - lists_.background.first;
}

const TileLists& TileCuller::cull(const scene::ViewFrame& view, std::span<const TileDepth> depths, std::span<const scene::LocalLight> lights, std::size_t shadowed, std::span<const DetailBox> details,
                                  const std::function<TileSurfaces*()>& surfaces, const std::vector<ProbeBox>* probes) {
  columns_ = (view.viewport.z + TILE_SIZE - 1) / TILE_SIZE;
  rows_ = (view.viewport.w + TILE_SIZE - 1) / TILE_SIZE;
  near_ = view.near;
  boundTiles(view, depths);
  pairs_.clear();
  for (std::size_t i = 0; i < lights.size(); ++i) cullLight(view, lights[i], std::uint16_t(i + 1));
  sortPairs();
  // Reading normals costs what shading half a light a tile does.
  if (surfaces && pairs_.size() > depths.size() / 2) keepReached(lights, *surfaces());
  detail_.assign(depths.size(), 0);
  for (const DetailBox& box : details) markDetail(view, box);
  probes_.clear();
  probeCounts_.clear();
  lists_.crowded = lists_.mostProbes = 0;
  if (probes) findProbes(view, *probes);
  choosePrograms(lights, shadowed);
  buildLists(lights.size());
  listBackground(depths);
  return lists_;
}

}  // namespace burnish::lighting
