// Directions and places that the integrator draws. Uniform numbers come in [0, 1). All in float; directions unit.
#pragma once
#include <glm/glm.hpp>

#include "reference/shading.h"

namespace burnish::pathtrace {

/// Tangent, bitangent, normal: from the local frame (z up) to the world and back.
struct Frame {
  glm::vec3 t, b, n;
  explicit Frame(const glm::vec3& normal);
  Frame(const glm::vec3& tangent, const glm::vec3& bitangent, const glm::vec3& normal) : t(tangent), b(bitangent), n(normal) {}
  [[nodiscard]] glm::vec3 toWorld(const glm::vec3& v) const { return t * v.x + b * v.y + n * v.z; }
  [[nodiscard]] glm::vec3 toLocal(const glm::vec3& v) const { return {glm::dot(v, t), glm::dot(v, b), glm::dot(v, n)}; }
};

/// Even over the unit disc (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
glm::vec2 onDisc(const glm::vec2& u);
/// Even over the cone of that half angle (radians, up to pi/2) around an axis.
glm::vec3 inCone(const glm::vec3& axis, float halfAngle, const glm::vec2& u);

/// A normal of GGX facets as an eye sees them, local frame; eye.z >= 0. Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing 1.
glm::vec3 visibleGgx(const glm::vec3& eye, float alphaX, float alphaY, const glm::vec2& u);
/// G1/(n·v) of the same facets: the density of a light direction is this times D/4. alphaEye: their width toward the eye (alphaToward of shading/anisotropy.h).
float visibleGgxShare(float nov, float alphaEye);

/// Veach 1997, section 9.2.4: the power heuristic (exponent 2) of two densities, of which `a` gave the sample.
inline float powerHeuristic(float a, float b) {
  if (!(a > 0)) return 0;
  const float r = b / a;
  return 1 / (1 + r * r);
}

inline float luminance(const glm::vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float largest(const glm::vec3& c) { return glm::max(glm::max(c.x, c.y), c.z); }

}  // namespace burnish::pathtrace
