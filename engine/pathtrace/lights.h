// Choosing among the punctual lights of a scene: all directional ones, and one of the point and spot lights, by what each would give at the point if nothing stood between.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "pathtrace/bsdf.h"
#include "pathtrace/world.h"

namespace burnish::pathtrace {

/// A light as a point receives it, shadows apart.
struct Received {
  glm::vec3 toLight{0, 0, 1};   ///< unit, to its middle
  glm::vec3 irradiance{0};      ///< lux on a plane that faces it
  double distance = 0;          ///< metres to its middle; directional: infinite
};
/// shaders/shading/light.h's attenuation, the cone and the hold under 1 cm as shaders/lighting/shade.glsl has them.
Received receive(const PunctualLight& light, const glm::dvec3& at);

/// Which lights reach where. A grid of cells over the lights that end somewhere; those without a range are in every cell. Within a cell at most kLooked lights are looked at, a random part of
/// those that reach it if there are more, and one is chosen by Bsdf::guess times irradiance: unbiased, for each light that gives something has a chance and is divided by it.
class LightPicker {
 public:
  static constexpr std::size_t kLooked = 48;
  explicit LightPicker(std::span<const PunctualLight> lights);

  [[nodiscard]] std::span<const std::uint32_t> directional() const { return directional_; }
  [[nodiscard]] bool hasLocal() const { return directional_.size() < lights_.size(); }
  struct Pick {
    const PunctualLight* light = nullptr;  ///< none: no light gives anything here
    Received received;
    float chance = 1;
  };
  /// u: uniform in [0, 1).
  [[nodiscard]] Pick pick(const glm::dvec3& at, const Bsdf& bsdf, float u) const;

 private:
  [[nodiscard]] std::span<const std::uint32_t> near(const glm::dvec3& at) const;
  void build();

  std::span<const PunctualLight> lights_;
  std::vector<std::uint32_t> directional_, endless_, listed_;  ///< listed_: cell by cell, endless ones included
  std::vector<std::uint32_t> first_;                           ///< of each cell in listed_, and one more
  glm::dvec3 low_{0}, cell_{1};
  glm::ivec3 counts_{0};
};

}  // namespace burnish::pathtrace
