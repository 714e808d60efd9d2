// Light lists, lighting, the background.
#include <algorithm>

#include "plan/builder.h"

namespace burnish::plan {
namespace {

const std::initializer_list<std::string_view> kLightOwners = {"tone_mapping", "linear_output", "debug_view", "directional_lights", "local_lights", "environment_lighting", "reflection_probes", "ambient_grid", "background", "emissive", "alpha_blend", "glass", "fog"};

}  // namespace

void readSurroundings(const Situation& s, PassPlan& pass) {
  const bool environment = s.on("environment_lighting"), probes = s.probes();
  if (needsCube(s.quality, environment)) pass.reads.emplace_back("environment cube");
  if (probes) pass.reads.emplace_back("probe records");
  if (s.grid()) pass.reads.emplace_back("ambient lattice");
  if (needsCube(s.quality, probes)) pass.reads.emplace_back("probe cubes");
  if (needsDfg(s.quality, environment || probes, s.grid())) pass.reads.emplace_back("dfg");
}

void addTiles(Builder& b) {
  const Situation& s = b.s;
  if (s.final() && !s.developsInPlace()) b.target("light", s.lightFormat(), kLightOwners);
  if (!s.hasTiles()) return;
  PassPlan& pass = b.pass("tiles", {"directional_lights", "local_lights", "environment_lighting", "reflection_probes", "ambient_grid", "screen_occlusion", "debug_view"}, {"depth"}, {"light lists"});
  if (s.on("local_lights")) pass.writes.emplace_back("lights");
  if (!s.reducesDepth()) {
    if (s.on("local_lights")) pass.reads.emplace_back("gbuffer_b");  // normals, to leave out lights from behind
    return;
  }
  b.target("tile_depth", "RGBA32F", {"directional_lights", "local_lights", "environment_lighting", "reflection_probes", "ambient_grid", "screen_occlusion", "debug_view"}, (s.shaded + 15) / 16);
  pass.writes.push_back("tile_depth");
  for (bool o : s.projections()) b.useScreen(pass, o ? "tile_depth+ortho" : "tile_depth", "lighting/tile_depth.frag", {define("ORTHOGRAPHIC", o)});
}

// Both passes shade the tiles that hold surfaces. The second merges what is baked, so that lighting reads one texture.
void addOcclusion(Builder& b) {
  const Situation& s = b.s;
  if (!s.on("screen_occlusion")) return;
  const bool baked = s.on("baked_occlusion");
  const OcclusionSamples samples = occlusionSamples(s.quality.occlusion);
  b.target("occlusion_raw", "RG8", {"screen_occlusion"});
  b.target("occlusion", "R8", {"screen_occlusion"});
  PassPlan& search = b.pass("occlusion", {"screen_occlusion"}, {"gbuffer_b", "depth", "light lists"}, {"occlusion_raw"});
  for (bool o : s.projections())
    b.use(search, {o ? "occlusion+ortho" : "occlusion", "lighting/screen_tile.vert", "lighting/occlusion.frag", {defineNormals(s.quality), define("ORTHOGRAPHIC", o), define("SLICES", samples.slices), define("STEPS", samples.steps)}});
  PassPlan& denoise = b.pass("occlusion_denoise", {"screen_occlusion"}, {"occlusion_raw", "depth", "light lists"}, {"occlusion"});
  if (baked) denoise.reads.push_back("gbuffer_c");
  for (bool o : s.projections())
    b.use(denoise, {o ? "occlusion_denoise+ortho" : "occlusion_denoise", "lighting/screen_tile.vert", "lighting/occlusion_denoise.frag", {define("BAKED", baked), define("ORTHOGRAPHIC", o)}});
}

// Where no pass covers the whole light buffer, it starts black. The forward reference clears it by itself.
void addLightClear(Builder& b) {
  const Situation& s = b.s;
  if (!s.final() || s.developsInPlace() || s.forward() || s.fillsBackground()) return;
  b.pass("light_clear", kLightOwners, {}, {"light"});
}

namespace {

// Programs of the tiles: one for each number of lights, the loops, and those of tiles that may show brushed or rough surfaces.
void useTilePrograms(Builder& b, PassPlan& pass, const LightingVariant& lighting) {
  const Situation& s = b.s;
  const bool local = s.on("local_lights");
  const auto has = [&](int bucket) { return bucket == 0 || (local && (bucket == kLoop || (bucket == kLoopSpots && s.facts.spots) || (bucket == kLoopShadows && s.shadows().locals))); };
  for (int bucket : kTileBuckets) {
    if (bucket > 0 && !local) break;
    b.use(pass, lightingProgram(bucket, s.quality, lighting));
    if (bucket >= s.facts.localLights) break;
  }
  for (int bucket : {kLoop, kLoopSpots, kLoopShadows})
    if (has(bucket)) b.use(pass, lightingProgram(bucket, s.quality, lighting));
  if (!s.detailTarget()) return;
  LightingVariant detailed = lighting;
  for (Details d : kDetailClasses) {
    if ((d.brushed && !s.on("anisotropy")) || (d.rough && !s.on("rough_diffuse"))) continue;
    detailed.details = d;
    for (int bucket : kDetailBuckets)
      if (has(bucket)) b.use(pass, lightingProgram(bucket, s.quality, detailed));
  }
}

}  // namespace

void addLighting(Builder& b) {
  const Situation& s = b.s;
  if (!s.hasDepth() || s.forward() || !s.lit() || !s.final()) return;
  const bool local = s.on("local_lights");
  const char* into = s.developsInPlace() ? "target" : "light";
  PassPlan& pass = b.pass("lighting", {"directional_lights", "local_lights", "environment_lighting", "reflection_probes", "ambient_grid", "fog"}, {"gbuffer_a", "gbuffer_b", "depth", "light lists"}, {into});
  if (local) pass.reads.emplace_back("lights");
  if (s.developsInPlace()) pass.effects.emplace_back("tone_mapping");
  if (s.on("screen_occlusion"))
    pass.reads.push_back("occlusion");
  else if (s.on("baked_occlusion"))
    pass.reads.push_back("gbuffer_c");
  if (s.detailTarget()) {
    pass.reads.push_back("gbuffer_d");
    for (const char* effect : {"anisotropy", "rough_diffuse"})
      if (s.on(effect)) pass.effects.emplace_back(effect);
  }
  readSurroundings(s, pass);
  if (s.shadows().rung != Shadow::None) pass.reads.push_back("shadow_maps");
  for (bool orthographic : s.projections())
    for (Places places : kPlaces) {
      if (places != Places::None && (!s.probes() || (places == Places::Many && s.facts.probes < 2))) continue;
      LightingVariant lighting = s.lighting(orthographic);
      lighting.places = places;
      useTilePrograms(b, pass, lighting);
    }
}

void addBackground(Builder& b) {
  const Situation& s = b.s;
  if (!s.fillsBackground()) return;
  const bool inPlace = s.developsInPlace();
  PassPlan& pass = b.pass("background", {"background", "fog", "sun_disc"}, {}, {inPlace ? "target" : "light"});
  if (inPlace) pass.effects.emplace_back("tone_mapping");
  if (s.hasDepth()) pass.reads.push_back("depth");
  if (s.hasTiles()) pass.reads.push_back("light lists");
  const int map = !s.on("background") || !s.scene.environment.background ? 2 : s.scene.environment.map.empty() ? 0 : 1;
  if (map == 1) pass.reads.emplace_back("environment");
  for (bool o : s.projections()) {
    const LightingVariant lighting = s.lighting(o);
    ProgramPlan p{o ? "background+ortho" : "background", s.hasTiles() ? "lighting/background_tile.vert" : "post/screen.vert", "lighting/sky.frag", {define("FOG", lighting.fog), define("IN_PLACE", inPlace), define("ORTHOGRAPHIC", o), define("SKY_MAP", map), define("SUN", s.on("sun_disc") && !o), define("TONEMAP", inPlace ? int(s.quality.toneMap) : 0)}};
    if (lighting.fog) {
      p.defines.push_back(define("DIRECTIONAL", lighting.directional));
      p.defines.push_back(define("FOG_AMBIENT", fogAmbient(s.quality, lighting)));
      std::sort(p.defines.begin(), p.defines.end());
    }
    b.use(pass, p);
  }
}

}  // namespace burnish::plan
