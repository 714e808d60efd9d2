#include "material/codec.h"

namespace burnish {

DecodedSubstance decodeSubstance(float code, glm::vec3 albedo) {
  const float s = std::isfinite(code) ? std::clamp(code, 0.0f, 1.0f) : 1.0f / 3;
  const float m = std::max(s - material::kMetalStart, 0.0f) / (1 - material::kMetalStart);
  const float root = 0.5f - 0.9f * std::min(s, material::kMetalStart);
  return {glm::vec3(root * root * (1 - m)) + m * albedo, albedo * (1 - m)};
}

float encodeDielectric(float f0) {
  if (!(f0 > material::kWaterF0)) return material::kMetalStart;  // NaN too
  return (0.5f - std::sqrt(std::min(f0, material::kGemF0))) / 0.9f;
}

float encodeMetalness(float m) {
  if (!(m >= material::kMetalnessStart)) return 1.0f / 3;
  return material::kMetalStart + (1 - material::kMetalStart) * std::min(m, 1.0f);
}

}  // namespace burnish
