// Material maps read on the CPU as a GPU reads them: levels, filters and wrapping of OpenGL 4.5 core, sections 8.14 and 8.15.
#pragma once
#include <burnish/scene.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

namespace burnish::pathtrace {

/// How far texture coordinates move from a pixel to the next, right and up. Zero: level 0 is read.
struct Footprint {
  glm::vec2 x{0}, y{0};
};

/// One map, RGBA in [0, 1]: colours of sRGB maps are linear when they are read.
class MapSampler {
 public:
  /// `levels`: as scene::levelsOf makes them. srgb: of the first three channels.
  MapSampler(std::vector<Image> levels, const burnish::Sampler& sampler, bool srgb);
  [[nodiscard]] glm::vec4 at(const glm::vec2& uv, const Footprint& footprint) const;
  /// The same with the level given (GL's lambda): any number.
  [[nodiscard]] glm::vec4 atLevel(const glm::vec2& uv, float level) const;
  [[nodiscard]] glm::ivec2 size() const { return {levels_[0].width, levels_[0].height}; }

 private:
  [[nodiscard]] glm::vec4 texel(const Image& level, int x, int y) const;
  [[nodiscard]] glm::vec4 inLevel(const Image& level, const glm::vec2& uv, bool linear) const;
  std::vector<Image> levels_;
  burnish::Sampler sampler_;  ///< not the one that draws random numbers
  bool srgb_;
  bool single_ = false;  ///< one texel: `only_` everywhere
  glm::vec4 only_{0};
};

/// All maps of a scene's materials, each made once. Materials without a map, and maps that cannot be used, have the default's one texel.
class Maps {
 public:
  Maps();
  /// Slots as in scene/texture_levels.h: A, B, C, metal-rough, emissive. `packed`: map B with C's occlusion in its third channel.
  const MapSampler* of(const Scene& scene, const Material& material, int slot, bool packed, Report& report);

 private:
  std::array<std::unique_ptr<MapSampler>, 5> defaults_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::unique_ptr<MapSampler>> made_;  ///< by texture and the map C packed into it; nullptr: cannot be used
};

}  // namespace burnish::pathtrace
