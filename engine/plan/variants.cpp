#include "plan/variants.h"

#include <fmt/format.h>

#include <algorithm>

namespace burnish::plan {
namespace {
std::string define(std::string_view name, int value) { return fmt::format("{} {}", name, value); }
}  // namespace

GeometryVariant variantOf(const Material& m, const Mesh& mesh) {
  const UvMapping plain;
  GeometryVariant v;
  const bool mapped = (m.mapA && m.uvA != plain) || (m.mapB && m.uvB != plain) || (m.mapC && m.uvC != plain) || (m.emissiveMap && m.uvEmissive != plain);
  v.general = mapped || bool(m.metalRoughMap) || (m.useVertexColor && !mesh.colors.empty());
  v.alphaTest = m.alphaTest;
  v.occlusionMap = m.mapC && m.occlusionStrength > 0;
  v.packed = v.occlusionMap && packsOcclusion(m);
  return v;
}

bool packsOcclusion(const Material& m) { return m.mapB && m.mapC && m.occlusionStrength > 0 && m.uvB == m.uvC && !m.alphaTest; }

bool emits(const Material& m) { return m.unlit || m.emission.r > 0 || m.emission.g > 0 || m.emission.b > 0; }

ProgramPlan geometryProgram(GeometryPass pass, GeometryVariant variant, bool occlusionTarget) {
  ProgramPlan p;
  p.name = pass == GeometryPass::GBuffer ? "gbuffer" : pass == GeometryPass::Emissive ? "emissive" : "pick";
  p.vertex = "gbuffer/gbuffer.vert";
  p.fragment = "gbuffer/" + p.name + ".frag";
  p.defines = {define("ALPHA_TEST", variant.alphaTest), define("GENERAL", variant.general)};
  if (variant.general) p.name += "+general";
  if (variant.alphaTest) p.name += "+alpha";
  if (pass == GeometryPass::GBuffer) {
    p.defines.push_back(define("OCCLUSION", !occlusionTarget ? 0 : !variant.occlusionMap ? 2 : variant.packed ? 3 : 1));
    if (occlusionTarget) p.name += !variant.occlusionMap ? "+unoccluded" : variant.packed ? "+ao" : "+ao_map";
  }
  return p;
}

ProgramPlan lightingProgram(int bucket, const Quality& quality, int directional, bool environment, bool occlusion, bool orthographic) {
  ProgramPlan p;
  p.name = bucket == kLoop ? "lighting/loop" : bucket == kLoopSpots ? "lighting/loop_spots" : fmt::format("lighting/tile{}", bucket);
  p.vertex = "lighting/tile.vert";
  p.fragment = "lighting/tile.frag";
  p.defines = {define("DIRECTIONAL", directional),
               define("ENVIRONMENT", environment),
               define("OCCLUSION", occlusion),
               define("ORTHOGRAPHIC", orthographic),
               define("RUNG_GEOMETRY", int(quality.geometry)),
               define("RUNG_LOBE", int(quality.lobe)),
               define("TILE_LIGHTS", bucket)};
  if (orthographic) p.name += "+ortho";
  return p;
}

}  // namespace burnish::plan
