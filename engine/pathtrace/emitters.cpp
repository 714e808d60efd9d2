#include "pathtrace/emitters.h"

#include <algorithm>
#include <cmath>

namespace burnish::pathtrace {
namespace {

float luminance(const glm::vec3& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

glm::dvec3 normalOf(const Geometry& g, const Part& part, std::size_t triangle) {
  const glm::dvec3 a = g.corner(part, triangle, 0);
  return glm::cross(g.corner(part, triangle, 1) - a, g.corner(part, triangle, 2) - a);
}

// The mean over the triangle, estimated from nine places, each filtered over a ninth of it.
float meanEmission(const MaterialInputs& material, const Part& part, std::size_t triangle) {
  Corners at[3];
  for (int c = 0; c < 3; ++c) at[c] = cornersAt(part, triangle, {c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f});
  float sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const float u = (float(i) + 0.5f) / 3, v = (float(k) + 0.5f) / 3, r = std::sqrt(u);
      Corners c = cornersAt(part, triangle, {r * (1 - v), r * v});
      for (std::size_t set = 0; set < 2; ++set) c.footprint[set] = {(at[1].uv[set] - at[0].uv[set]) / 3.0f, (at[2].uv[set] - at[0].uv[set]) / 3.0f};
      sum += luminance(emissionAt(material, c));
    }
  return sum / 9;
}

}  // namespace

Emitters::Emitters(const Geometry& g) {
  first_.assign(g.parts.size(), -1);
  std::vector<float> weights;
  for (std::size_t p = 0; p < g.parts.size(); ++p) {
    const Part& part = g.parts[p];
    const MaterialInputs& material = g.materials[part.material];
    if (!material.emits) continue;
    first_[p] = std::int64_t(index_.size());
    for (std::size_t t = 0; t < part.triangles(); ++t) {
      const double area = 0.5 * glm::length(normalOf(g, part, t));
      const float weight = area > 0 && std::isfinite(area) ? float(area) * meanEmission(material, part, t) * (material.twoSided ? 2.0f : 1.0f) : 0;
      const bool counts = std::isfinite(weight) && weight > 0 && float(area) > 0;
      index_.push_back(counts ? std::int32_t(emitters_.size()) : -1);
      if (!counts) continue;
      emitters_.push_back({std::uint32_t(p), std::uint32_t(t), float(area)});
      weights.push_back(weight);
    }
  }
  power_ = Distribution(weights);
}

bool Emitters::sample(const Geometry& g, const glm::dvec3& at, float pick, const glm::vec2& place, EmitterSample& sample) const {
  if (power_.empty()) return false;
  const std::size_t i = power_.at(pick).index;
  const Emitter& e = emitters_[i];
  const Part& part = g.parts[e.part];
  const MaterialInputs& material = g.materials[part.material];
  const float r = std::sqrt(place.x);
  const glm::vec2 b{r * (1 - place.y), r * place.y};
  const glm::dvec3 a = g.corner(part, e.triangle, 0), ab = g.corner(part, e.triangle, 1) - a, ac = g.corner(part, e.triangle, 2) - a;
  sample.position = a + ab * double(b.x) + ac * double(b.y);
  const glm::dvec3 n = glm::normalize(glm::cross(ab, ac));
  const bool front = glm::dot(n, at - sample.position) > 0;
  if (!front && !material.twoSided) return false;
  const Corners corners = cornersAt(part, e.triangle, b);
  if (!solidAt(material, corners)) return false;
  sample.normal = glm::vec3(front ? n : -n);
  sample.radiance = emissionAt(material, corners) * coverageAt(material, corners);
  sample.density = density(std::int32_t(i));
  return sample.density > 0 && sample.radiance != glm::vec3(0);
}

}  // namespace burnish::pathtrace
