// A material's numbers, finite and in range: what every way of drawing it takes.
#pragma once
#include <burnish/scene.h>

namespace burnish::scene {

struct MaterialFactors {
  glm::vec3 albedo{1};
  float opacity = 1;
  float codeScale = 0, codeBias = 1.0f / 3;  ///< substance code = map A's alpha · codeScale + codeBias
  float roughness = 1, occlusionStrength = 1;
  glm::vec3 emission{0};                     ///< cd/m²
  float alphaCutoff = 0.5f, metalness = 0;
  bool unlit = false, vertexColor = true, blend = false;
  bool metalRoughMap = false, mapB = false;  ///< it has them
  UvMapping uv[5];                           ///< of maps A, B, C, metal-rough, emissive
  glm::vec3 eta{0}, k{0};
  glm::vec2 brushed{0};                      ///< anisotropy's strength² times cosine and sine of its rotation
  float transmission = 0, thickness = 0;     ///< thickness: metres of the mesh
  float ior = 0;                             ///< 0: of the substance's F0
  glm::vec3 absorption{0};                   ///< inside, 1/m
  float sigma = 0;                           ///< of rough diffuse, radians
};
MaterialFactors factorsOf(const Material& material);

}  // namespace burnish::scene
