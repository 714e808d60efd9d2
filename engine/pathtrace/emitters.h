// Emissive triangles as sources of light, drawn by power.
#pragma once
#include "pathtrace/distribution.h"
#include "pathtrace/geometry.h"
#include "pathtrace/world.h"

namespace burnish::pathtrace {

class Emitters {
 public:
  explicit Emitters(const Geometry& geometry);
  [[nodiscard]] bool empty() const { return power_.empty(); }
  /// Of a part's triangle; -1: it is none, or so dark on the mean that it is never drawn.
  [[nodiscard]] std::int32_t of(std::uint32_t part, std::uint32_t triangle) const { return first_[part] < 0 ? -1 : index_[std::size_t(first_[part]) + triangle]; }
  [[nodiscard]] float density(std::int32_t emitter) const { return emitter < 0 ? 0 : power_.probability(std::size_t(emitter)) / emitters_[std::size_t(emitter)].area; }
  [[nodiscard]] bool sample(const Geometry& geometry, const glm::dvec3& at, float pick, const glm::vec2& place, EmitterSample& sample) const;

 private:
  struct Emitter {
    std::uint32_t part = 0, triangle = 0;
    float area = 0;
  };
  std::vector<Emitter> emitters_;
  Distribution power_;
  std::vector<std::int64_t> first_;   ///< by part: where its triangles begin in index_; -1: it emits nothing
  std::vector<std::int32_t> index_;
};

}  // namespace burnish::pathtrace
