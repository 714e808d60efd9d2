// Materials of the tests of transparent surfaces.
#pragma once
#include "render/workshop.h"

namespace burnish::test {

inline Quality onPath(Path path, Fresnel fresnel = Fresnel::Schlick) {
  Quality q;
  q.path = path;
  q.fresnel = fresnel;
  return q;
}

inline Material glassOf(float ior, float thickness, float roughness = 0) {
  Material m;
  m.transmission = 1;
  m.ior = ior;
  m.thickness = thickness;
  m.roughness = roughness;
  return m;
}

/// Gives off this radiance and reflects nothing.
inline Material shining(vec3 radiance) {
  Material m;
  m.unlit = true;
  m.albedo = vec3(0);
  m.emission = radiance;
  m.useVertexColor = false;
  return m;
}

}  // namespace burnish::test
