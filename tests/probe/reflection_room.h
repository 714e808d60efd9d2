// Rooms whose light is known in closed form: probes of one constant, and probes painted by casting rays at a box's walls in double.
#pragma once
#include <burnish/image.h>

#include <functional>

#include "render/scenes.h"

namespace burnish::test {

/// Direction of a cube's texel, or of any point of a face: u, v in (0, 1), v downward in the face's rows (OpenGL 4.5, table 8.19).
inline dvec3 cubeDirection(int face, double u, double v) {
  const double s = 2 * u - 1, t = 2 * v - 1;
  switch (face) {
    case 0: return glm::normalize(dvec3(1, -t, -s));
    case 1: return glm::normalize(dvec3(-1, -t, s));
    case 2: return glm::normalize(dvec3(s, 1, t));
    case 3: return glm::normalize(dvec3(s, -1, -t));
    case 4: return glm::normalize(dvec3(s, -t, 1));
    default: return glm::normalize(dvec3(-s, -t, -1));
  }
}

/// What a wall gives off at a point of it, in the box's axes.
using Paint = std::function<dvec3(const dvec3& at, int axis, bool positive)>;

/// The wall that a ray from p (inside, in the box's axes) meets, one axis at a time.
struct WallHit {
  dvec3 at;
  int axis = 0;
  bool positive = false;
};
inline WallHit wallHit(const dvec3& p, const dvec3& d, const dvec3& half) {
  WallHit hit;
  double nearest = 1e300;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) continue;
    const double way = ((d[k] > 0 ? half[k] : -half[k]) - p[k]) / d[k];
    if (way < nearest) nearest = way, hit.axis = k, hit.positive = d[k] > 0;
  }
  hit.at = p + d * nearest;
  return hit;
}

/// A cube's level 0 as a capture at `capture` (in the box's axes) sees the walls: the mean of 2 x 2 rays a texel.
inline CubeLevel paintedCube(int size, const glm::dmat3& axes, const dvec3& capture, const dvec3& half, const Paint& paint) {
  CubeLevel level;
  level.size = size;
  level.texels.resize(18 * std::size_t(size) * std::size_t(size));
  std::size_t at = 0;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        dvec3 sum(0);
        for (int k = 0; k < 4; ++k) {
          const dvec3 d = glm::transpose(axes) * cubeDirection(face, (x + 0.25 + 0.5 * (k & 1)) / size, (y + 0.25 + 0.5 * (k >> 1)) / size);
          const WallHit hit = wallHit(capture, d, half);
          sum += paint(hit.at, hit.axis, hit.positive) * 0.25;
        }
        for (int c = 0; c < 3; ++c) level.texels[at++] = float(sum[c]);
      }
  return level;
}

/// A probe whose light is `level`, filtered as a bake filters.
inline ReflectionProbe bakedFrom(const CubeLevel& level, int size) {
  ReflectionProbe p;
  auto cube = prefilterCubemap(level, {.size = size});
  if (!cube) FAIL(cube.error().message());
  p.radiance = std::move(*cube);
  auto sh = irradianceSh(level);
  if (!sh) FAIL(sh.error().message());
  p.irradiance = *sh;
  return p;
}

inline ReflectionProbe boxed(ReflectionProbe p, const dvec3& center, const dvec3& half, const glm::dmat3& axes = glm::dmat3(1)) {
  p.center = p.capture = center;
  p.halfSize = half;
  p.axes = axes;
  return p;
}

/// The same radiance from everywhere.
inline ReflectionProbe constantProbe(const dvec3& radiance, int size = 16) {
  ReflectionProbe p;
  for (int s = size; s >= 8; s /= 2) {
    CubeLevel level;
    level.size = s;
    for (int i = 0; i < 6 * s * s; ++i)
      for (int c = 0; c < 3; ++c) level.texels.push_back(float(radiance[c]));
    p.radiance.levels.push_back(std::move(level));
  }
  p.radiance.lobe = ReflectionLobe::BlinnPhong;
  p.irradiance[0] = {radiance.x, radiance.y, radiance.z};
  return p;
}

/// Rotation by Euler angles (radians), columns.
inline glm::dmat3 turned(double yaw, double pitch, double roll) {
  const glm::dquat q = glm::angleAxis(yaw, dvec3(0, 1, 0)) * glm::angleAxis(pitch, dvec3(1, 0, 0)) * glm::angleAxis(roll, dvec3(0, 0, 1));
  return glm::mat3_cast(q);
}

inline void setProbes(Scene& scene, std::vector<ReflectionProbe> probes) {
  scene.probes.reflections = std::move(probes);
  ++scene.probes.revision;
}

inline double luminance(const dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

}  // namespace burnish::test
