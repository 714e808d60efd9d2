#include "material/codec.h"

namespace burnish::material {

const std::array<CodeEntry, 256>& codeTable() {
  static const std::array<CodeEntry, 256> table = [] {
    std::array<CodeEntry, 256> t;
    for (int i = 0; i < 256; ++i) {
      const float s = float(i) / 255;
      const float m = i <= 102 ? 0.0f : (s - kMetalStart) / (1 - kMetalStart);  // 102 is 0.4 exactly
      const float root = 0.5f - 0.9f * std::min(s, kMetalStart);
      t[i] = {root * root * (1 - m), m};
    }
    return t;
  }();
  return table;
}

Reflectance decode(const CodedTexel& texel) {
  const CodeEntry e = codeTable()[texel.code];
  return {glm::vec3(e.base) + e.metalness * texel.albedo, texel.albedo - e.metalness * texel.albedo};
}

CodedTexel projectDielectric(const Reflectance& average) {
  const float f0 = (average.f0.x + average.f0.y + average.f0.z) / 3;
  const float code = encodeDielectric(f0);
  return {glm::clamp(average.diffuse, 0.0f, 1.0f), std::uint8_t(std::lround(code * 255))};
}

// Keeping the sum S = F0 + diffuse fixes the albedo for a metalness m: a(m) = S - w (1 - m), w = 0.0196. What F0
// becomes is then F(m) = w (1 - m) + m a(m) = w (1 - m)² + m S, and m is chosen to bring it nearest to the wanted F0
// over the three channels: Newton on the derivative of |F(m) - F0|² (Gauss-Newton, the residual being small). A set of
// texels with one m comes back exactly.
CodedTexel projectConductor(const Reflectance& average) {
  const glm::vec3 sum = average.f0 + average.diffuse;
  float m = std::clamp(glm::dot(average.f0 - kWaterF0, sum) / std::max(glm::dot(sum, sum), 1e-12f), 0.0f, 1.0f);
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 slope = sum - 2 * kWaterF0 * (1 - m);
    const glm::vec3 residual = kWaterF0 * (1 - m) * (1 - m) + m * sum - average.f0;
    m -= glm::dot(residual, slope) / std::max(glm::dot(slope, slope), 1e-12f);
    m = std::clamp(m, 0.0f, 1.0f);
  }
  const float code = kMetalStart + (1 - kMetalStart) * m;
  const int byte = std::clamp(int(std::lround(code * 255)), 103, 255);  // 102 is 0.4, still a dielectric
  const CodeEntry e = codeTable()[byte];
  return {glm::clamp(sum - e.base, 0.0f, 1.0f), std::uint8_t(byte)};  // the albedo makes up for the code's rounding
}

}  // namespace burnish::material
