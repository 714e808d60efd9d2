#include "plan/variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/builder.h"
#include "plan/rungs.h"
#include "prefilter/dfg.h"
#include "scene/transparency.h"

namespace burnish::plan {
GeometryVariant variantOf(const Material& m, const Mesh& mesh, Details details) {
  const UvMapping plain;
  GeometryVariant v;
  const bool mapped = (m.mapA && m.uvA != plain) || (m.mapB && m.uvB != plain) || (m.mapC && m.uvC != plain) || (m.emissiveMap && m.uvEmissive != plain);
  v.general = mapped || bool(m.metalRoughMap) || (m.useVertexColor && !mesh.colors.empty());
  v.alphaTest = m.alphaTest;
  v.occlusionMap = m.mapC && m.occlusionStrength > 0;
  v.packed = packsOcclusion(m);
  v.brushed = details.brushed && m.anisotropy > 0 && !m.unlit;
  v.rough = details.rough && m.diffuseRoughness > 0 && !m.unlit;
  return v;
}

Details detailsOf(const FramePlan& plan) { return {plan.on("anisotropy"), plan.on("rough_diffuse")}; }

bool packsOcclusion(const Material& m) { return m.mapB && m.mapC && m.occlusionStrength > 0 && m.uvB == m.uvC && !m.alphaTest && !m.blend; }

bool emits(const Material& m) { return m.unlit || m.emission.r > 0 || m.emission.g > 0 || m.emission.b > 0; }

bool wantsTangents(const Material& m) { return m.mapB || m.anisotropy > 0; }

ProgramPlan deformProgram(DeformVariant variant) {
  ProgramPlan p;
  p.name = "deform";
  if (variant.morph) p.name += "+morph";
  if (variant.skin) p.name += "+skin";
  p.compute = "deform/deform.comp";
  p.defines = {define("MORPH", variant.morph), define("SKIN", variant.skin)};
  return p;
}

bool drawnTransparent(const Material& m, bool blend, bool glass) { return scene::isGlass(m) ? glass : m.blend && blend; }

TransparentVariant transparentVariantOf(const Material& m, const Mesh& mesh, bool occlusion, Details details) {
  TransparentVariant v;
  v.geometry = variantOf(m, mesh, details);
  if (!occlusion) v.geometry.occlusionMap = false;
  v.through = !scene::isGlass(m) ? Through::Blend : scene::refracts(m) ? Through::Refract : Through::Clear;
  v.coverage = m.blend && (m.mapC || (m.useVertexColor && !mesh.colors.empty()));
  v.emits = emits(m);
  v.faint = v.through != Through::Blend && m.ior >= 1 && m.ior < 1.34f && m.transmission < 1;
  return v;
}

namespace {
std::string namesOf(Details d) { return fmt::format("{}{}", d.brushed ? "+brushed" : "", d.rough ? "+rough" : ""); }
}  // namespace

ProgramPlan geometryProgram(GeometryPass pass, GeometryVariant variant, bool occlusionTarget, SpecularAntialiasing specularAntialiasing) {
  ProgramPlan p;
  p.name = pass == GeometryPass::GBuffer ? "gbuffer" : pass == GeometryPass::Emissive ? "emissive" : "pick";
  p.vertex = "gbuffer/gbuffer.vert";
  p.fragment = "gbuffer/" + p.name + ".frag";
  p.defines = {define("ALPHA_TEST", variant.alphaTest), define("GENERAL", variant.general), define("INSTANCED", variant.instanced)};
  if (variant.general) p.name += "+general";
  if (variant.alphaTest) p.name += "+alpha";
  if (variant.instanced) p.name += "+instanced";
  if (pass == GeometryPass::GBuffer) {
    p.defines.push_back(define("OCCLUSION", !occlusionTarget ? 0 : !variant.occlusionMap ? 2 : variant.packed ? 3 : 1));
    p.defines.push_back(define("PACKED", variant.packed));
    if (!occlusionTarget && variant.packed) p.name += "+packed";
    p.defines.push_back(define("SPECULAR_ANTIALIASING", int(specularAntialiasing)));
    if (occlusionTarget) p.name += !variant.occlusionMap ? "+unoccluded" : variant.packed ? "+ao" : "+ao_map";
    p.defines.push_back(define("ANISOTROPIC", variant.brushed));
    p.defines.push_back(define("ROUGH_DIFFUSE", variant.rough));
    std::sort(p.defines.begin(), p.defines.end());
    p.name += namesOf({variant.brushed, variant.rough});
  }
  return p;
}

ShadowVariant shadowVariantOf(const Material& m, const Mesh& mesh) { return {m.alphaTest, m.alphaTest && variantOf(m, mesh, {}).general}; }

ProgramPlan shadowProgram(ShadowVariant v) {
  ProgramPlan p;
  p.name = "shadow";
  if (v.general) p.name += "+general";
  if (v.alphaTest) p.name += "+alpha";
  p.vertex = "shadow/caster.vert";
  p.fragment = "shadow/caster.frag";
  p.defines = {define("ALPHA_TEST", v.alphaTest), define("GENERAL", v.general)};
  return p;
}

OcclusionSamples occlusionSamples(Occlusion rung) {
  switch (rung) {
    case Occlusion::Screen4: return {1, 2};
    case Occlusion::Screen8: return {1, 4};
    case Occlusion::Screen16: return {1, 8};
    case Occlusion::None:
    case Occlusion::Baked: break;
  }
  return {};
}

bool fogAmbient(const Quality& q, const LightingVariant& lighting) { return lighting.fog && lighting.environment && q.ambient != Ambient::None; }

ProgramPlan emissiveProgram(GeometryVariant variant, const Quality& quality, const LightingVariant& lighting) {
  ProgramPlan p = geometryProgram(GeometryPass::Emissive, variant, false);
  p.defines.push_back(define("FOG", lighting.fog));
  if (!lighting.fog) return p;
  p.defines.push_back(define("DIRECTIONAL", lighting.directional));
  p.defines.push_back(define("FOG_AMBIENT", fogAmbient(quality, lighting)));
  p.defines.push_back(define("ORTHOGRAPHIC", lighting.orthographic));
  std::sort(p.defines.begin(), p.defines.end());
  if (lighting.orthographic) p.name += "+ortho";
  return p;
}

bool needsDfg(const Quality& q, bool reflections, bool ambient) {
  if (shading::needsAlbedoTable(rungsOf(q))) return true;
  const bool takes = q.diffuse == Diffuse::LambertFresnel || q.diffuse == Diffuse::OrenNayarQualitative || q.diffuse == Diffuse::OrenNayar;  // ambientShare() asks what reflections take
  return (reflections || (ambient && takes)) && (q.environmentSpecular == EnvironmentSpecular::Dfg || q.environmentSpecular == EnvironmentSpecular::Sampled);
}
bool needsCube(const Quality& q, bool lights) { return lights && q.environmentSpecular != EnvironmentSpecular::None; }

namespace {

// Everything that lighting/shade.glsl asks for. Rungs of what is off stand at 0, so that changing them links nothing anew.
// `locals`: the program looks up shadows of point and spot lights too.
std::vector<std::string> shadeDefines(const Quality& q, const LightingVariant& lighting, bool locals) {
  const bool shadows = lighting.shadows.suns > 0 || locals;
  const shading::Rungs k = rungsOf(q);
  const bool dfg = needsDfg(q, lighting.environment || lighting.places != Places::None, lighting.grid);
  const prefilter::DfgTable table = dfg ? prefilter::dfgTable(prefilter::dfgIndex(k)) : prefilter::DfgTable{};
  return {define("DFG", dfg),
          define("DFG_HEIGHT", table.height),
          define("DFG_WIDTH", table.width),
          define("DIRECTIONAL", lighting.directional),
          define("ENVIRONMENT", lighting.environment),
          define("FOG", lighting.fog),
          define("FOG_AMBIENT", fogAmbient(q, lighting)),
          define("GRID", lighting.grid),
          define("ORTHOGRAPHIC", lighting.orthographic),
          define("PROBES", int(lighting.places)),
          define("RUNG_AMBIENT", lighting.surroundings() ? int(q.ambient == Ambient::Box && lighting.places == Places::None ? Ambient::ShL2 : q.ambient) : 0),
          define("RUNG_COMPENSATION", k.compensation),
          define("RUNG_DIFFUSE", k.diffuse),
          define("RUNG_DIRECT_OCCLUSION", lighting.occlusion ? int(q.directOcclusion) : 0),
          define("RUNG_DISTRIBUTION", k.distribution),
          define("RUNG_ENVIRONMENT_SPECULAR", lighting.surroundings() ? int(q.environmentSpecular) : 0),
          define("RUNG_FRESNEL", k.fresnel),
          define("RUNG_GEOMETRY", k.geometry),
          define("RUNG_LOBE", k.lobe),
          define("RUNG_NORMALIZATION", k.normalization),
          define("RUNG_REFLECTION", lighting.places != Places::None && q.environmentSpecular != EnvironmentSpecular::None ? int(q.reflection) : 0),
          define("RUNG_SPECULAR", k.specular),
          define("RUNG_SPECULAR_OCCLUSION", lighting.occlusion && lighting.surroundings() ? int(q.specularOcclusion) : 0),
          define("SHADOW", shadows ? int(lighting.shadows.rung) : 0),
          define("SHADOW_LOCALS", locals),
          define("SHADOW_SUNS", lighting.shadows.suns)};
}

}  // namespace

ProgramPlan lightingProgram(int bucket, const Quality& quality, const LightingVariant& lighting) {
  ProgramPlan p;
  p.name = bucket == kLoop ? "lighting/loop" : bucket == kLoopSpots ? "lighting/loop_spots" : bucket == kLoopShadows ? "lighting/loop_shadows" : fmt::format("lighting/tile{}", bucket);
  p.vertex = "lighting/tile.vert";
  p.fragment = "lighting/tile.frag";
  p.defines = shadeDefines(quality, lighting, bucket == kLoopShadows);
  p.defines.push_back(define("ANISOTROPIC", lighting.details.brushed));
  p.defines.push_back(define("DETAIL", lighting.detail()));
  p.defines.push_back(define("ROUGH_DIFFUSE", lighting.details.rough));
  p.defines.push_back(defineNormals(quality));
  p.defines.push_back(define("IN_PLACE", lighting.inPlace >= 0));
  p.defines.push_back(define("OCCLUSION", lighting.occlusion));
  p.defines.push_back(define("TILE_LIGHTS", bucket));
  p.defines.push_back(define("TONEMAP", std::max(lighting.inPlace, 0)));
  std::sort(p.defines.begin(), p.defines.end());
  p.name += namesOf(lighting.details);
  if (lighting.places != Places::None) p.name += lighting.places == Places::One ? "+place" : "+places";
  if (lighting.orthographic) p.name += "+ortho";
  return p;
}

ProgramPlan transparentProgram(const TransparentVariant& v, const Quality& quality, const LightingVariant& lighting) {
  ProgramPlan p = forwardProgram(v.geometry, quality, lighting);
  p.name = "transparent" + p.name.substr(std::string_view("forward").size());
  p.fragment = "forward/transparent.frag";
  p.defines.push_back(define("COVERAGE", v.coverage));
  p.defines.push_back(define("EMISSION", v.emits));
  p.defines.push_back(define("FAINT", v.faint));
  p.defines.push_back(define("THROUGH", int(v.through)));
  if (v.through == Through::Refract) p.defines.push_back(define("UNLIT_AROUND", !lighting.surroundings() && needsCube(quality, true)));
  std::sort(p.defines.begin(), p.defines.end());
  if (v.coverage) p.name += "+coverage";
  if (v.emits) p.name += "+emissive";
  if (v.faint) p.name += "+faint";
  if (v.through != Through::Blend) p.name += v.through == Through::Clear ? "+clear" : "+refract";
  return p;
}

ProgramPlan peelProgram(const TransparentVariant& v) {
  ProgramPlan p = geometryProgram(GeometryPass::Pick, v.geometry.shapeOnly(), false);
  p.name = "peel" + p.name.substr(std::string_view("pick").size());
  p.fragment = "gbuffer/peel.frag";
  return p;
}

ProgramPlan forwardProgram(GeometryVariant variant, const Quality& quality, const LightingVariant& lighting) {
  ProgramPlan p = geometryProgram(GeometryPass::GBuffer, variant, lighting.occlusion, quality.specularAntialiasing);
  p.name = "forward" + p.name.substr(std::string_view("gbuffer").size());
  p.fragment = "forward/forward.frag";
  for (std::string& d : shadeDefines(quality, lighting, lighting.shadows.locals)) p.defines.push_back(std::move(d));
  p.defines.push_back(define("LOCAL", lighting.local));
  std::sort(p.defines.begin(), p.defines.end());
  if (lighting.orthographic) p.name += "+ortho";
  return p;
}

}  // namespace burnish::plan
