#include "scene/material_factors.h"

#include <algorithm>
#include <cmath>

namespace burnish::scene {
namespace {

float finiteOr(float value, float low, float high, float otherwise) { return std::isfinite(value) ? std::clamp(value, low, high) : otherwise; }
float unit(float f, float otherwise) { return finiteOr(f, 0, 1, otherwise); }

UvMapping finite(const UvMapping& uv) {
  UvMapping out = uv;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 2; ++r)
      if (!std::isfinite(out.transform[c][r])) out.transform[c][r] = 0;
  return out;
}

}  // namespace

MaterialFactors factorsOf(const Material& m) {
  MaterialFactors f;
  for (int i = 0; i < 3; ++i) {
    f.albedo[i] = unit(m.albedo[i], 0.5f);
    f.emission[i] = finiteOr(m.emission[i], 0, 1e9f, 0);
    f.eta[i] = finiteOr(m.conductorEta[i], 0, 1e4f, 0);
    f.k[i] = finiteOr(m.conductorK[i], 0, 1e4f, 0);
  }
  f.opacity = unit(m.opacity, 1);
  // A material without a map A takes the code from its factor: the default map's alpha counts for nothing.
  f.codeScale = m.mapA ? 1.0f : 0.0f;
  f.codeBias = m.mapA ? 0.0f : unit(m.substance, 1.0f / 3);
  f.roughness = unit(m.roughness, 1);
  f.occlusionStrength = unit(m.occlusionStrength, 1);
  f.alphaCutoff = unit(m.alphaCutoff, 0.5f);
  f.metalness = unit(m.metalness, 0);
  f.unlit = m.unlit;
  f.vertexColor = m.useVertexColor;
  f.blend = m.blend;
  f.metalRoughMap = bool(m.metalRoughMap);
  f.mapB = bool(m.mapB);
  const UvMapping* maps[] = {&m.uvA, &m.uvB, &m.uvC, &m.uvMetalRough, &m.uvEmissive};
  for (int i = 0; i < 5; ++i) f.uv[i] = finite(*maps[i]);
  const float strength = unit(m.anisotropy, 0), rotation = std::isfinite(m.anisotropyRotation) ? m.anisotropyRotation : 0;
  f.brushed = {strength * strength * std::cos(rotation), strength * strength * std::sin(rotation)};
  f.transmission = unit(m.transmission, 0);
  f.thickness = finiteOr(m.thickness, 0, 1e9f, 0);
  f.ior = m.ior >= 1 ? finiteOr(m.ior, 1, 100, 1.5f) : 0.0f;
  f.sigma = unit(m.diffuseRoughness, 0);
  // Beer-Lambert: color = exp(-absorption · distance). A channel of no light at all stands for a millionth.
  if (m.attenuationDistance > 0 && std::isfinite(m.attenuationDistance))
    for (int i = 0; i < 3; ++i) f.absorption[i] = std::min(-std::log(finiteOr(m.attenuationColor[i], 1e-6f, 1, 1)) / m.attenuationDistance, 1e9f);
  return f;
}

}  // namespace burnish::scene
