// Blended surfaces and glass.
#include <algorithm>
#include <bit>

#include "plan/builder.h"

namespace burnish::plan {
namespace {

/// Down to some 8 pixels on the short side, which is what the roughest glass asks for.
int levelsOf(glm::ivec2 size) { return std::clamp(int(std::bit_width(unsigned(std::max(std::min(size.x, size.y), 1)))) - 3, 1, 8); }

}  // namespace

void addTransparent(Builder& b) {
  const Situation& s = b.s;
  if (!s.hasDepth() || !s.final() || !(s.on("alpha_blend") || s.on("glass"))) return;
  const bool glass = s.on("glass");
  PassPlan& pass = b.pass("transparent", {"alpha_blend", "glass", "reflection_probes", "ambient_grid", "fog", "anisotropy", "rough_diffuse"}, {"meshes", "materials", "depth"}, {"light"});
  if (s.on("local_lights")) pass.reads.emplace_back("lights");
  readSurroundings(s, pass);
  if (s.shadows().rung != Shadow::None) pass.reads.push_back("shadow_maps");
  if (glass && s.facts.refracts) {
    b.target("scene_color", s.lightFormat(), {"glass"}, {0, 0}, s.facts.blurs ? levelsOf(s.shaded) : 1);
    pass.writes.push_back("scene_color");
    if (s.facts.blurs) b.useScreen(pass, "scene_blur", "forward/scene_blur.frag", {});
  }
  if (s.facts.peels)
    for (const char* name : {"peel_a", "peel_b"}) {
      b.target(name, "DEPTH_COMPONENT32F", {"alpha_blend", "glass"});
      pass.writes.push_back(name);
    }
  for (const std::set<TransparentVariant>* variants : {&s.facts.blended, &s.facts.glass})
    for (const TransparentVariant& v : *variants) {
      for (bool orthographic : s.projections()) b.use(pass, transparentProgram(v, s.quality, s.drawnLighting(orthographic)));
      if (s.facts.peels) b.use(pass, peelProgram(v));
    }
}

}  // namespace burnish::plan
