#include "prefilter/environment.h"

#include "prefilter/irradiance.h"
#include "prefilter/parallel.h"

namespace burnish::prefilter {

Result<EnvironmentLight> prefilterEnvironment(const Image& latLong, int baseSize, double error) {
  PrefilterOptions options;
  options.size = baseSize;
  options.error = error;
  auto cube = prefilterCubemap(latLong, options);
  if (!cube) return fail(cube.error());
  EnvironmentLight light;
  light.levels = std::move(cube->levels);
  const IrradianceSh sh = irradianceOf(latLong, threadsFor(0));
  for (std::size_t k = 0; k < 9; ++k) light.irradiance[k] = glm::vec3(sh[k]);
  light.meanLuminance = glm::dot(light.irradiance[0], glm::vec3(0.2126f, 0.7152f, 0.0722f));
  return light;
}

}  // namespace burnish::prefilter
