// Rooms whose light is known in closed form: probes of one constant, and probes painted by casting rays at a box's walls in double.
#pragma once
#include <burnish/image.h>
#include <burnish/scene.h>

#include <array>
#include <functional>

namespace burnish::stability {

/// Outward faces of an axis-aligned box; `inside`: seen from within.
Mesh box(glm::vec3 low, glm::vec3 high, bool inside = false);
/// A room seen from inside: six walls (-X +X -Y +Y -Z +Z) of the materials.
void addRoom(Scene& scene, glm::vec3 low, glm::vec3 high, const std::array<Material, 6>& walls);

/// Direction of a cube's texel, or of any point of a face: u, v in (0, 1), v downward in the face's rows (OpenGL 4.5, table 8.19).
glm::dvec3 faceDirection(int face, double u, double v);

/// What a wall gives off at a point of it, in the box's axes.
using Paint = std::function<glm::dvec3(const glm::dvec3& at, int axis, bool positive)>;

/// The wall that a ray from p (inside, in the box's axes) meets, one axis at a time.
struct WallHit {
  glm::dvec3 at{0};
  int axis = 0;
  bool positive = false;
};
WallHit wallHit(const glm::dvec3& p, const glm::dvec3& d, const glm::dvec3& half);

/// A cube's level 0 as a capture at `capture` (in the box's axes) sees the walls: the mean of 2 x 2 rays a texel.
CubeLevel paintedCube(int size, const glm::dmat3& axes, const glm::dvec3& capture, const glm::dvec3& half, const Paint& paint);
/// A probe whose light is `level`, filtered as a bake filters.
Result<ReflectionProbe> bakedFrom(const CubeLevel& level, int size);
ReflectionProbe boxed(ReflectionProbe p, const glm::dvec3& center, const glm::dvec3& half, const glm::dmat3& axes = glm::dmat3(1));
/// The same radiance from everywhere.
ReflectionProbe constantProbe(const glm::dvec3& radiance, int size = 16);
/// A probe whose box is a room; without light.
ReflectionProbe probeIn(glm::vec3 low, glm::vec3 high, glm::dvec3 capture);
/// Rotation by Euler angles (radians), columns.
glm::dmat3 turned(double yaw, double pitch, double roll);
void setProbes(Scene& scene, std::vector<ReflectionProbe> probes);

}  // namespace burnish::stability
