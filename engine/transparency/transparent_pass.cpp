#include "transparency/transparent_pass.h"

#include <fmt/format.h>

#include <algorithm>

namespace burnish::transparency {
namespace {

using gpu_scene::FrameContext;
using scene::Faces;
using scene::TransparentGroup;
using scene::TransparentPart;

glm::ivec4 unite(const glm::ivec4& a, const glm::ivec4& b) {
  if (a.z <= 0 || a.w <= 0) return b;
  const glm::ivec2 from = glm::min(glm::ivec2(a), glm::ivec2(b)), to = glm::max(glm::ivec2(a.x + a.z, a.y + a.w), glm::ivec2(b.x + b.z, b.y + b.w));
  return {from, to - from};
}

Result<void> unplanned(std::string_view name) { return fail("frame plan", fmt::format("'{}' is not in it", name), "report this as a fault of the engine"); }

void setFaces(const GladGLContext& gl, Faces faces, bool twoSided, bool flipped) {
  if (faces == Faces::Material && twoSided) {
    gl.Disable(GL_CULL_FACE);
  } else {
    gl.Enable(GL_CULL_FACE);
    gl.CullFace(faces == Faces::Back ? GL_FRONT : GL_BACK);
  }
  gl.FrontFace(flipped ? GL_CW : GL_CCW);
}

}  // namespace

Result<void> TransparentPass::draw(FrameContext& c) {
  if (c.transparent.empty()) return {};
  if (auto begun = begin(c); !begun) return begun;
  Result<void> done;
  for (const TransparentGroup& group : c.transparent)
    if (done = group.peel ? drawLayers(c, group) : drawGroup(c, group); !done) break;
  const GladGLContext& gl = device_.gl;
  gl.Disable(GL_BLEND);
  gl.BlendFunc(GL_ONE, GL_ZERO);
  gl.Disable(GL_CULL_FACE);
  gl.CullFace(GL_BACK);
  gl.FrontFace(GL_CCW);
  gl.DepthMask(GL_TRUE);
  gl.BindSampler(UNIT_SCENE_COLOR, 0);
  return done;
}

Result<void> TransparentPass::begin(FrameContext& c) {
  programs_.clear();
  blend_ = c.plan.on("alpha_blend");
  glass_ = c.plan.on("glass");
  copyStale_ = blurStale_ = c.view.viewport;
  const GladGLContext& gl = device_.gl;
  gl.Enable(GL_DEPTH_TEST);
  // What a surface adds, over the picture times what it lets through.
  gl.BlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ZERO, GL_ONE);
  const gl::Texture* picture = c.targets.texture("scene_color");
  if (!picture) return {};
  if (!smooth_) smooth_ = gl::Sampler::create(device_, {.minFilter = GL_LINEAR_MIPMAP_LINEAR, .magFilter = GL_LINEAR}, "picture behind glass");
  picture->bind(UNIT_SCENE_COLOR);
  smooth_.bind(UNIT_SCENE_COLOR);
  return {};
}

Result<void> TransparentPass::bindShading(FrameContext& c, std::string_view depth, GLenum depthFunction, bool refracts) {
  auto framebuffer = c.targets.framebuffer({"light"}, depth);
  if (!framebuffer) return fail(framebuffer.error());
  const GladGLContext& gl = device_.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Enable(GL_DEPTH_TEST);
  gl.Enable(GL_BLEND);
  gl.DepthMask(GL_FALSE);
  gl.DepthFunc(depthFunction);
  if (refracts) c.targets.texture("depth")->bind(UNIT_SCENE_DEPTH);
  return {};
}

// One part after the other.
Result<void> TransparentPass::drawGroup(FrameContext& c, const TransparentGroup& group) {
  for (const TransparentPart& part : group.parts) {
    const bool refracts = part.refracts && glass_;
    if (refracts)
      if (auto copied = copyPicture(c, part.blurs); !copied) return copied;
    if (auto bound = bindShading(c, "depth", GL_GREATER, refracts); !bound) return bound;
    if (auto drawn = drawParts(c, {&part, 1}, Stage::Shade); !drawn) return drawn;
    copyStale_ = unite(copyStale_, group.rect);
    blurStale_ = unite(blurStale_, group.rect);
  }
  return {};
}

// Depth peeling from back to front (Everitt 2001, "Interactive Order-Independent Transparency", which peels from the front): each layer is the farthest of what lies nearer than the
// layer before. It is found by depth alone, then shaded once a pixel over what is behind it.
Result<void> TransparentPass::drawLayers(FrameContext& c, const TransparentGroup& group) {
  constexpr std::string_view kDepths[] = {"peel_a", "peel_b"};
  const bool refracts = glass_ && std::any_of(group.parts.begin(), group.parts.end(), [](const TransparentPart& p) { return p.refracts; });
  const bool blurs = std::any_of(group.parts.begin(), group.parts.end(), [](const TransparentPart& p) { return p.blurs; });
  const int most = std::clamp(c.quality.transparentLayers, 1, 64), layers = group.layers > 0 ? std::min(group.layers, most) : most;
  std::string_view before = "depth";
  for (int layer = 0; layer < layers; ++layer) {
    const std::string_view into = kDepths[layer % 2];
    auto found = peel(c, group, before, into);
    if (!found) return fail(found.error());
    if (!*found) return {};
    if (refracts)
      if (auto copied = copyPicture(c, blurs); !copied) return copied;
    if (auto bound = bindShading(c, into, GL_EQUAL, refracts); !bound) return bound;
    device_.gl.Scissor(group.rect.x, group.rect.y, group.rect.z, group.rect.w);
    if (auto drawn = drawParts(c, group.parts, Stage::Shade); !drawn) return drawn;
    copyStale_ = unite(copyStale_, group.rect);
    blurStale_ = unite(blurStale_, group.rect);
    before = into;
  }
  return group.layers > 0 && group.layers <= most ? Result<void>{} : drawRest(c, group, before, refracts);
}

Result<bool> TransparentPass::peel(FrameContext& c, const TransparentGroup& group, std::string_view before, std::string_view into) {
  auto framebuffer = c.targets.framebuffer({}, into);
  if (!framebuffer) return fail(framebuffer.error());
  const GladGLContext& gl = device_.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Scissor(group.rect.x, group.rect.y, group.rect.z, group.rect.w);
  gl.Disable(GL_BLEND);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthMask(GL_TRUE);
  gl.DepthFunc(GL_LESS);
  const float nearest = 1;
  gl.ClearNamedFramebufferfv(*framebuffer, GL_DEPTH, 0, &nearest);
  c.targets.texture(before)->bind(UNIT_SCENE_DEPTH);
  if (!samples_) samples_ = gl::Query::create(device_, GL_ANY_SAMPLES_PASSED, "transparent layer");
  gl.BeginQuery(GL_ANY_SAMPLES_PASSED, samples_.id());
  auto drawn = drawParts(c, group.parts, Stage::Peel);
  gl.EndQuery(GL_ANY_SAMPLES_PASSED);
  if (!drawn) return fail(drawn.error());
  return samples_.result() != 0;
}

// What lies in front of the last layer that is peeled: none of it is lost, but it is blended by distance of the instances alone.
Result<void> TransparentPass::drawRest(FrameContext& c, const TransparentGroup& group, std::string_view last, bool refracts) {
  if (auto bound = bindShading(c, last, GL_GREATER, refracts); !bound) return bound;
  const GladGLContext& gl = device_.gl;
  gl.Scissor(group.rect.x, group.rect.y, group.rect.z, group.rect.w);
  gl.BeginQuery(GL_ANY_SAMPLES_PASSED, samples_.id());
  auto drawn = drawParts(c, group.parts, Stage::Shade);
  gl.EndQuery(GL_ANY_SAMPLES_PASSED);
  if (drawn && samples_.result() != 0)
    c.report.warn("transparency", fmt::format("more than {} layers of transparent surfaces over a pixel: those nearest to the eye are not sorted (Quality::transparentLayers)", c.quality.transparentLayers));
  return drawn;
}

Result<const TransparentPass::Programs*> TransparentPass::programsOf(FrameContext& c, const Material& material, const Mesh& mesh) {
  const plan::TransparentVariant variant = plan::transparentVariantOf(material, mesh, c.quality.occlusion != Occlusion::None, plan::detailsOf(c.plan));
  const auto [at, isNew] = programs_.try_emplace(variant);
  if (!isNew) return &at->second;
  const plan::LightingVariant lighting{int(c.lights.directional.size()), c.plan.on("environment_lighting"), c.plan.on("baked_occlusion"), c.view.orthographic, -1, c.plan.on("fog")};
  const std::string shade = plan::transparentProgram(variant, c.quality, lighting).name, peel = plan::peelProgram(variant).name;
  at->second = {c.programs.find(shade), c.programs.find(peel)};
  if (!at->second.shade) return fail(unplanned(shade).error());
  return &at->second;
}

Result<void> TransparentPass::drawParts(FrameContext& c, std::span<const TransparentPart> parts, Stage stage) {
  const GladGLContext& gl = device_.gl;
  gpu_scene::BoundInstance bound;
  for (const TransparentPart& part : parts) {
    const scene::VisibleInstance& v = c.visible[part.instance];
    const Material* material = c.scene.materials.get(v.instance->material);
    if (!material || !plan::drawnTransparent(*material, blend_, glass_)) continue;
    auto programs = programsOf(c, *material, *v.mesh);
    if (!programs) return fail(programs.error());
    const gl::Program* program = stage == Stage::Peel ? (*programs)->peel : (*programs)->shade;
    if (!program) return unplanned("peel");
    const bool general = plan::variantOf(*material, *v.mesh, {}).general;
    if (!gpu_scene::bindInstance(c, part.instance, general, bound)) continue;
    program->use();
    setFaces(gl, part.faces, material->twoSided, v.flipped);
    gl.DrawElements(GL_TRIANGLES, bound.mesh->indexCount, bound.mesh->indexType, nullptr);
    if (stage == Stage::Peel) continue;
    ++c.stats.draws;
    c.stats.triangles += std::uint64_t(bound.mesh->indexCount) / 3;
  }
  return {};
}

}  // namespace burnish::transparency
