#include "stability/rooms.h"

#include <glm/gtc/quaternion.hpp>

#include "stability/scenes.h"

namespace burnish::stability {

using glm::dvec3;
using glm::vec3;

Mesh box(vec3 low, vec3 high, bool inside) {
  Mesh m;
  const vec3 c = (low + high) * 0.5f, h = (high - low) * 0.5f;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      vec3 n(0), u(0), v(0);
      n[axis] = side * h[axis];
      u[(axis + 1) % 3] = h[(axis + 1) % 3];
      v[(axis + 2) % 3] = h[(axis + 2) % 3];
      if ((side < 0) != inside) std::swap(u, v);
      const Mesh q = quad(c + n, u, v);
      const std::uint32_t base = std::uint32_t(m.positions.size());
      m.positions.insert(m.positions.end(), q.positions.begin(), q.positions.end());
      m.normals.insert(m.normals.end(), q.normals.begin(), q.normals.end());
      m.uv0.insert(m.uv0.end(), q.uv0.begin(), q.uv0.end());
      for (const std::uint32_t i : q.indices) m.indices.push_back(base + i);
    }
  return m;
}

void addRoom(Scene& scene, vec3 low, vec3 high, const std::array<Material, 6>& walls) {
  const Mesh whole = box(low, high, true);
  for (std::uint32_t w = 0; w < 6; ++w) {
    Mesh m;
    for (std::uint32_t i = 0; i < 4; ++i) {
      m.positions.push_back(whole.positions[4 * w + i]);
      m.normals.push_back(whole.normals[4 * w + i]);
      m.uv0.push_back(whole.uv0[4 * w + i]);
    }
    m.indices = {0, 1, 2, 0, 2, 3};
    place(scene, std::move(m), walls[w]);
  }
}

dvec3 faceDirection(int face, double u, double v) {
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

WallHit wallHit(const dvec3& p, const dvec3& d, const dvec3& half) {
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

CubeLevel paintedCube(int size, const glm::dmat3& axes, const dvec3& capture, const dvec3& half, const Paint& paint) {
  CubeLevel level;
  level.size = size;
  level.texels.resize(18 * std::size_t(size) * std::size_t(size));
  std::size_t at = 0;
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        dvec3 sum(0);
        for (int k = 0; k < 4; ++k) {
          const dvec3 d = glm::transpose(axes) * faceDirection(face, (x + 0.25 + 0.5 * (k & 1)) / size, (y + 0.25 + 0.5 * (k >> 1)) / size);
          const WallHit hit = wallHit(capture, d, half);
          sum += paint(hit.at, hit.axis, hit.positive) * 0.25;
        }
        for (int c = 0; c < 3; ++c) level.texels[at++] = float(sum[c]);
      }
  return level;
}

Result<ReflectionProbe> bakedFrom(const CubeLevel& level, int size) {
  ReflectionProbe p;
  auto cube = prefilterCubemap(level, {.size = size});
  if (!cube) return fail(cube.error());
  p.radiance = std::move(*cube);
  auto sh = irradianceSh(level);
  if (!sh) return fail(sh.error());
  p.irradiance = *sh;
  return p;
}

ReflectionProbe boxed(ReflectionProbe p, const dvec3& center, const dvec3& half, const glm::dmat3& axes) {
  p.center = p.capture = center;
  p.halfSize = half;
  p.axes = axes;
  return p;
}

ReflectionProbe constantProbe(const dvec3& radiance, int size) {
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

ReflectionProbe probeIn(vec3 low, vec3 high, dvec3 capture) {
  ReflectionProbe p;
  p.center = (dvec3(low) + dvec3(high)) * 0.5;
  p.halfSize = (dvec3(high) - dvec3(low)) * 0.5;
  p.capture = capture;
  return p;
}

glm::dmat3 turned(double yaw, double pitch, double roll) {
  const glm::dquat q = glm::angleAxis(yaw, dvec3(0, 1, 0)) * glm::angleAxis(pitch, dvec3(1, 0, 0)) * glm::angleAxis(roll, dvec3(0, 0, 1));
  return glm::mat3_cast(q);
}

void setProbes(Scene& scene, std::vector<ReflectionProbe> probes) {
  scene.probes.reflections = std::move(probes);
  ++scene.probes.revision;
}

}  // namespace burnish::stability
