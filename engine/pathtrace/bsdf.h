// What a surface reflects: the shading text's own equation, with the rungs in force, and directions drawn from its lobes. Sampling shapes the noise alone: every rung is evaluated in full.
#pragma once
#include <glm/glm.hpp>

#include "pathtrace/sampling.h"
#include "pathtrace/world.h"
#include "prefilter/dfg.h"
#include "reference/shading.h"

namespace burnish::pathtrace {

/// A specular lobe's directional albedo as the renderer reads it (prefilter::lookUpDfg), in float. Refers to tables that live as long as the program.
class LobeTable {
 public:
  explicit LobeTable(const shading::Rungs& rungs);
  /// Where in the table a surface of that alpha lies.
  struct Row {
    std::size_t top = 0, next = 0;
    float share = 0, scale = 1;
  };
  [[nodiscard]] Row row(float alpha) const;
  [[nodiscard]] glm::vec2 at(const Row& row, float cosine) const;
  [[nodiscard]] glm::vec2 mean(const Row& row) const;

 private:
  [[nodiscard]] glm::vec2 texel(std::size_t i) const { return {float(table_.texels[2 * i]), float(table_.texels[2 * i + 1])}; }
  [[nodiscard]] glm::vec2 column(const Row& row, std::size_t x) const;
  shading::Rungs rungs_;
  prefilter::DfgTable table_;
};

/// Reflected radiance for unit irradiance on a plane that faces the light (the BRDF times n·l), and the density per solid angle with which sample() gives the direction.
struct Reflected {
  glm::vec3 value{0};
  float density = 0;
};

/// One surface seen from one direction. Light arrives from above the triangle alone. Where the shading normal is not the triangle's, what the lobes would send below it is mirrored on it
/// (value(l) + value(mirrored l)): the surface keeps its directional albedo and nothing comes through its back. The lobe is evaluated in its stable form whatever the rung `lobe`: the others
/// differ by float's rounding alone.
class Bsdf {
 public:
  /// toEye: unit. Of glass this is the outer face alone, with the exact Fresnel equation (glass.h has the rest); of blended surfaces the pigment's share of diffuse light.
  Bsdf(const SurfacePoint& point, const glm::vec3& toEye, const shading::Rungs& rungs, const LobeTable& table);

  /// toLight: unit. Zero from below the triangle.
  [[nodiscard]] Reflected reflected(const glm::vec3& toLight) const;
  /// The same without the mirrored part and whatever side of the triangle: of lights that no path can meet by chance.
  [[nodiscard]] glm::vec3 alone(const glm::vec3& toLight) const;
  /// Draws a direction above the triangle; false: it went below, and the path ends there (density() counts such directions too).
  [[nodiscard]] bool sample(float pick, const glm::vec2& place, glm::vec3& toLight) const;
  /// Of the lobes alone over the whole sphere, before anything is mirrored: what sample() draws. Its integral is 1 less the share of facets drawn that look away from the eye.
  [[nodiscard]] float density(const glm::vec3& toLight) const;
  /// A cheap guess at luminance(alone(toLight)), above 0 wherever that is: for choosing among lights.
  [[nodiscard]] float guess(const glm::vec3& toLight) const;
  /// A guess at the directional albedo, luminance.
  [[nodiscard]] float albedoGuess() const { return lobeAlbedo_ + diffuseAlbedo_; }
  /// Diffuse albedo + F0: what the picture's albedo layer shows.
  [[nodiscard]] glm::vec3 layerAlbedo() const { return glm::clamp(m_.diffuse + m_.f0, 0.0f, 1.0f); }
  /// A facet's normal as the eye sees it, world space: the lobe's own distribution, by rejection (tails past 3 alpha of what is seen count a little less). For what crosses rough glass.
  [[nodiscard]] glm::vec3 facet(Sampler& sampler) const;

  [[nodiscard]] const shading::f32::Surface& surface() const { return m_; }
  [[nodiscard]] const glm::vec3& through() const { return through_; }  ///< glass: share of what enters that crosses, by channel

 private:
  void makeGlass(const SurfacePoint& point);
  void weigh();
  [[nodiscard]] glm::vec3 value(const glm::vec3& l, const shading::f32::Angles& a) const;
  [[nodiscard]] float densityAt(const shading::f32::Angles& a) const;
  [[nodiscard]] glm::vec3 halfVector(const glm::vec2& place) const;

  shading::f32::Surface m_;
  shading::Rungs rungs_;
  const LobeTable* table_;
  LobeTable::Row row_;
  Frame frame_;           ///< of the lobe: n, or for Phong's the mirrored direction
  glm::vec3 geometric_, through_{0}, back_{0};
  int family_;
  bool tilted_, twoWidths_, visible_, coupled_, pane_ = false;
  float lobeShare_ = 0, lobeAlbedo_ = 0, diffuseAlbedo_ = 0, alphaEye_ = 1;
};

}  // namespace burnish::pathtrace
