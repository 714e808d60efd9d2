// Passes that draw instances.
#include <algorithm>

#include "plan/builder.h"

namespace burnish::plan {

void addDeformation(Builder& b) {
  if (!b.s.on("deformation") || b.s.facts.deformVariants.empty()) return;
  PassPlan& pass = b.pass("deform", {"deformation"}, {"meshes", "skins"}, {"deformed vertices"});
  for (const DeformVariant& v : b.s.facts.deformVariants) b.use(pass, deformProgram(v));
}

// What casts is drawn where it is not in view, and deformed before.
void addShadowMaps(Builder& b) {
  const Situation& s = b.s;
  const int layers = s.shadowLayers();
  if (!s.on("shadows") || layers == 0) return;
  const bool deforms = s.on("deformation") && !s.facts.shadowDeformVariants.empty();
  PassPlan& pass = deforms ? b.pass("shadow_maps", {"shadows", "deformation"}, {"meshes", "materials"}, {"shadow_maps"}) : b.pass("shadow_maps", {"shadows"}, {"meshes", "materials"}, {"shadow_maps"});
  if (deforms)
    for (const DeformVariant& v : s.facts.shadowDeformVariants) b.use(pass, deformProgram(v));
  for (const ShadowVariant& v : s.facts.shadowVariants) b.use(pass, shadowProgram(v));
  b.target("shadow_maps", "DEPTH_COMPONENT32F", {"shadows"}, glm::ivec2(std::clamp(s.quality.shadowResolution, 16, 8192)), 1, layers);
}

void addHostDepth(Builder& b) {
  if (!b.s.on("host_depth_in") || b.s.forward()) return;
  PassPlan& pass = b.pass("depth_in", {"host_depth_in"}, {"host depth"}, {"depth"});
  b.useScreen(pass, "depth_in", "post/depth_in.frag", {});
}

void addGBuffer(Builder& b) {
  const Situation& s = b.s;
  if (s.hasDepth()) b.target("depth", "DEPTH_COMPONENT32F", {"geometry", "host_depth_in"});
  if (!s.hasDepth() || s.forward()) return;
  const bool occlusion = s.on("baked_occlusion");
  PassPlan& pass = b.pass("gbuffer", {"geometry", "host_depth_in", "two_sided", "alpha_test", "baked_occlusion", "anisotropy", "rough_diffuse"},
                          s.on("geometry") ? std::vector<std::string>{"meshes", "materials"} : std::vector<std::string>{}, {"gbuffer_a", "gbuffer_b"});
  b.target("gbuffer_a", "RGBA8", {"geometry", "host_depth_in"});
  b.target("gbuffer_b", s.quality.normalStorage == NormalStorage::Oct16 ? "RGBA16" : "RGBA8", {"geometry", "host_depth_in"});
  if (occlusion) {
    b.target("gbuffer_c", "R8", {"baked_occlusion"});
    pass.writes.push_back("gbuffer_c");
  }
  if (s.detailTarget()) {
    b.target("gbuffer_d", "RGBA8", {"anisotropy", "rough_diffuse"});
    pass.writes.push_back("gbuffer_d");
  }
  pass.writes.push_back("depth");
  if (!s.on("geometry")) return;
  for (const GeometryVariant& v : s.facts.variants) {
    ProgramPlan program = geometryProgram(GeometryPass::GBuffer, v, occlusion, s.quality.specularAntialiasing);
    program.defines.push_back(defineNormals(s.quality));
    std::sort(program.defines.begin(), program.defines.end());
    b.use(pass, program);
  }
}

// One pass in place of G-buffer, tiles and lighting.
void addForward(Builder& b) {
  const Situation& s = b.s;
  if (!s.forward()) return;
  PassPlan& pass = b.pass("forward", {"forward_reference", "reflection_probes", "ambient_grid", "fog", "anisotropy", "rough_diffuse"}, {"meshes", "materials"}, {"light", "depth"});
  if (s.on("local_lights")) pass.reads.emplace_back("lights");
  readSurroundings(s, pass);
  if (s.shadows().rung != Shadow::None) pass.reads.push_back("shadow_maps");
  for (bool orthographic : s.projections())
    for (const GeometryVariant& v : s.facts.variants) b.use(pass, forwardProgram(v, s.quality, s.drawnLighting(orthographic)));
}

// Only what moved: where the camera alone moves, depth says where a point was.
void addMotionVectors(Builder& b) {
  const Situation& s = b.s;
  if (!s.on("motion_vectors") || !s.hasDepth()) return;
  PassPlan& pass = b.pass("motion_vectors", {"motion_vectors"}, {"meshes", "depth"}, {"velocity"});
  b.target("velocity", "RGBA16F", {"motion_vectors"});
  for (bool o : s.projections()) b.use(pass, {o ? "motion_vectors+ortho" : "motion_vectors", "gbuffer/motion.vert", "gbuffer/motion.frag", {define("ORTHOGRAPHIC", o)}});
}

void addEmissive(Builder& b) {
  if (!b.s.on("emissive")) return;
  PassPlan& pass = b.pass("emissive", {"emissive", "fog"}, {"meshes", "materials", "depth"}, {"light"});
  for (bool orthographic : b.s.projections())
    for (const GeometryVariant& v : b.s.facts.emissiveVariants) b.use(pass, emissiveProgram(v, b.s.quality, b.s.lighting(orthographic)));
}

}  // namespace burnish::plan
