// A clear day's sun and sky as a picture and a light.
#pragma once
#include <burnish/image.h>

#include <glm/glm.hpp>

namespace burnish::prefilter {

struct SkyModel {
  glm::vec3 toSun{0, 1, 0};  ///< unit
  double turbidity = 2.5;    ///< 1 to 10
  glm::vec3 ground{0.2f};    ///< albedo, 0 to 1
  double altitude = 2;       ///< m of the eye above the ground, 1 to 50000
};
struct SkyPicture {
  Image map;                      ///< lat-long F32 RGB, cd/m²; without the sun's disc
  glm::dvec3 sunIlluminance{0};   ///< lux on a plane that faces the sun, Rec.709
  glm::dvec3 sunRadiance{0};      ///< cd/m², of the part of the disc that is above the horizon
  double horizon = 0;             ///< sine of the horizon's elevation
  glm::dvec3 skyIlluminance{0};   ///< lux of the sky alone on level ground
};
/// width: of the picture, twice its height.
SkyPicture skyPicture(const SkyModel& model, int width = 1024);

}  // namespace burnish::prefilter
