// The light of a lat-long picture: a cube whose levels match the Blinn-Phong lobe, and irradiance in spherical harmonics.
#pragma once
#include <burnish/image.h>

#include <array>
#include <glm/glm.hpp>
#include <vector>

namespace burnish::prefilter {

struct EnvironmentLight {
  std::vector<CubeLevel> levels;          ///< level k holds roughness environmentRoughness(k, levels - 1); level 0 the picture itself
  std::array<glm::vec3, 9> irradiance{};  ///< irradiance / pi with all constants folded in (shaders/shading/environment.h)
  float meanLuminance = 0;                ///< over the sphere, in the picture's unit
};
/// `latLong` and `error`: as for prefilterCubemap(), of which this is the default, or the error is its. baseSize: a power of two, at least 16; levels down to 8² faces.
Result<EnvironmentLight> prefilterEnvironment(const Image& latLong, int baseSize = 256, double error = 1e-4);

}  // namespace burnish::prefilter
