// The light of a lat-long picture: a cube whose levels match the Blinn-Phong lobe, and irradiance in spherical harmonics.
// A plain direct sum; correct, not fast.
#pragma once
#include <burnish/image.h>

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::prefilter {

/// Six square faces in GL's order (+X -X +Y -Y +Z -Z), rows as GL stores them, linear RGB.
struct Cube {
  int size = 0;
  std::vector<glm::vec3> texels;  ///< 6 size²
  [[nodiscard]] glm::vec3& at(int face, int x, int y) { return texels[(std::size_t(face) * std::size_t(size) + std::size_t(y)) * std::size_t(size) + std::size_t(x)]; }
  [[nodiscard]] const glm::vec3& at(int face, int x, int y) const { return const_cast<Cube*>(this)->at(face, x, y); }
};
/// Direction (not normalized) of a point on a face; u, v in [-1, 1] (OpenGL 4.5 specification, table 8.19).
glm::vec3 cubeDirection(int face, float u, float v);
/// Solid angle of texel (x, y) of an N² face, exact (Driscoll 2012).
double texelSolidAngle(int size, int x, int y);

struct EnvironmentLight {
  std::vector<Cube> levels;               ///< level k holds roughness environmentRoughness(k, levels - 1); level 0 the picture itself
  std::array<glm::vec3, 9> irradiance{};  ///< irradiance / pi with all constants folded in (shaders/shading/environment.h)
  float meanLuminance = 0;                ///< over the sphere, in the picture's unit
};
/// `latLong`: F32, 3 or 4 channels, finite. baseSize: a power of two, at least 16; levels down to 8² faces.
EnvironmentLight prefilterEnvironment(const Image& latLong, int baseSize = 256);

}  // namespace burnish::prefilter
