#include "lighting/tile_surfaces.h"

#include <algorithm>
#include <cmath>

#include "interface/limits.h"

// Compiled for wider vectors as well; the machine chooses. (Sanitizers do not work in what chooses.)
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("avx2", "default")))
#else
#define WIDE
#endif

namespace burnish::lighting {
namespace {

constexpr int kRows = 4;
constexpr float kNowhere = 1e18f;  // metres: where pixels without a surface are

/// Where the two codes of a stored normal are in its 32 bits (shading/normals.h): low bits at 0 and at `shift`, high ones in the third byte; codes run 0 to 2 middle.
struct NormalCodes {
  std::uint32_t low, high;
  int shift;
  float scale;  // 1/middle
};
NormalCodes codesOf(NormalStorage storage) {
  switch (storage) {
    case NormalStorage::Oct8: return {0xff, 0, 8, 1 / 127.0f};
    case NormalStorage::Oct12: break;
    case NormalStorage::Oct16: return {0xffff, 0, 16, 1 / 32767.0f};
  }
  return {0xff, 0xf00, 8, 1 / 2047.0f};
}

}  // namespace

void TileSurfaces::begin(const scene::ViewFrame& view, std::span<const float> depth, std::span<const std::uint32_t> normals, NormalStorage storage) {
  static_assert(TILE_SIZE * TILE_SIZE == kPixels);
  view_ = view;
  depth_ = depth;
  normals_ = normals;
  storage_ = storage;
}

WIDE void TileSurfaces::load(int tx, int ty) {
  const scene::ViewFrame& v = view_;
  const int width = v.viewport.z, height = v.viewport.w, left = tx * TILE_SIZE, w = std::min(TILE_SIZE, width - left);
  rows_ = std::min(TILE_SIZE, height - ty * TILE_SIZE);
  const glm::vec3 right(v.axes[0] * (2 * v.tanX / width)), forward(-v.axes[2]);
  const NormalCodes codes = codesOf(storage_);
  const float a = float(v.depthParams.x), b = float(v.depthParams.y);
  for (int row = 0; row < rows_; ++row) {
    const int y = ty * TILE_SIZE + row;
    const glm::dvec3 start = v.axes[0] * ((2 * (left + 0.5 + v.jitter.x) / width - 1) * v.tanX) + v.axes[1] * ((2 * (y + 0.5 + v.jitter.y) / height - 1) * v.tanY);
    const glm::vec3 ray(v.orthographic ? start : start - v.axes[2]);
    const std::size_t first = std::size_t(y) * std::size_t(width) + std::size_t(left);
    const float* depth = depth_.data() + first;
    const std::uint32_t* normals = normals_.data() + first;
    float *const x = x_ + row * TILE_SIZE, *const yy = y_ + row * TILE_SIZE, *const z = z_ + row * TILE_SIZE;
    float *const nx = nx_ + row * TILE_SIZE, *const ny = ny_ + row * TILE_SIZE, *const nz = nz_ + row * TILE_SIZE;
    // Along the ray, and along the view's direction (parallel projection).
    float along[TILE_SIZE], offset[TILE_SIZE];
    for (int i = 0; i < w; ++i) {
      along[i] = v.orthographic ? 1.0f : a / (depth[i] + b);
      offset[i] = v.orthographic ? a - depth[i] * b : 0.0f;
    }
    for (int i = w; i < TILE_SIZE; ++i) along[i] = offset[i] = 0;
    for (int i = 0; i < TILE_SIZE; ++i) {
      const float k = float(i), there = i < w && depth[i < w ? i : 0] > 0 ? 0.0f : kNowhere;
      x[i] = (ray.x + right.x * k) * along[i] + forward.x * offset[i] + there;
      yy[i] = (ray.y + right.y * k) * along[i] + forward.y * offset[i];
      z[i] = (ray.z + right.z * k) * along[i] + forward.z * offset[i];
    }
    for (int i = 0; i < w; ++i) {
      // shading/normals.h: as it is unpacked, before it is normalized.
      const std::uint32_t n = normals[i];
      const float u = float(std::int32_t((n & codes.low) | (n >> 12 & codes.high))) * codes.scale - 1, t = float(std::int32_t((n >> codes.shift & codes.low) | (n >> 8 & codes.high))) * codes.scale - 1;
      const float up = 1 - std::abs(u) - std::abs(t), fold = up < 0 ? -up : 0.0f;
      nx[i] = u - std::copysign(fold, u);
      ny[i] = t - std::copysign(fold, t);
      nz[i] = up;
    }
    for (int i = w; i < TILE_SIZE; ++i) nx[i] = ny[i] = nz[i] = 0;
  }
  const int end = (rows_ + kRows - 1) / kRows * kRows * TILE_SIZE;
  for (int i = rows_ * TILE_SIZE; i < end; ++i) {
    x_[i] = kNowhere;
    y_[i] = z_[i] = nx_[i] = ny_[i] = nz_[i] = 0;
  }
}

WIDE bool TileSurfaces::reached(const scene::LocalLight& light) const {
  const float px = light.position.x, py = light.position.y, pz = light.position.z;
  // What the shader's own floats may differ by: positions by 1e-5 of their distance, signs where the light grazes.
  const float slack = 1e-4f * (glm::length(light.position) + light.radius), radius = light.radius + slack, radius2 = radius * radius;
  // Four rows at a time, one vector after another, without a branch.
  for (int row = 0; row < rows_; row += kRows) {
    int any[TILE_SIZE] = {}, hit = 0;
    for (int i = row * TILE_SIZE; i < (row + kRows) * TILE_SIZE; i += TILE_SIZE)
      for (int k = 0; k < TILE_SIZE; ++k) {
        const float dx = px - x_[i + k], dy = py - y_[i + k], dz = pz - z_[i + k];
        const float facing = nx_[i + k] * dx + ny_[i + k] * dy + nz_[i + k] * dz, d2 = dx * dx + dy * dy + dz * dz;
        any[k] |= int(facing > -slack) & int(d2 < radius2);
      }
    for (int k = 0; k < TILE_SIZE; ++k) hit |= any[k];
    if (hit) return true;
  }
  return false;
}

}  // namespace burnish::lighting
