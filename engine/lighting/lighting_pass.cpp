#include "lighting/lighting_pass.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/plan.h"
#include "plan/rungs.h"
#include "plan/variants.h"

namespace burnish::lighting {

using gpu_scene::FrameContext;

namespace {

// Fills a buffer texture that is made when it is first filled.
Result<void> fill(gl::Device& device, gl::TextureBuffer& buffer, GLenum format, std::span<const std::byte> bytes, std::string_view label) {
  if (!buffer) {
    auto made = gl::TextureBuffer::create(device, format, gl::BufferUse::Stream, bytes.size(), nullptr, label);
    if (!made) return fail(made.error());
    buffer = std::move(*made);
  }
  return buffer.write(bytes);
}

}  // namespace

Result<void> LightingPass::readTileDepths(FrameContext& c) {
  const glm::ivec4 v = c.view.viewport;
  if (!c.targets.texture("tile_depth")) {
    depth_.resize(std::size_t(v.z) * std::size_t(v.w));
    c.device.gl.GetTextureSubImage(c.targets.texture("depth")->id(), 0, v.x, v.y, 0, v.z, v.w, 1, GL_DEPTH_COMPONENT, GL_FLOAT, GLsizei(depth_.size() * sizeof(float)), depth_.data());
    reduceDepth(depth_.data(), v.z, v.z, v.w, c.view.depthParams, c.view.orthographic, tileDepths_);
    return {};
  }
  auto framebuffer = c.targets.framebuffer({"tile_depth"});
  if (!framebuffer) return fail(framebuffer.error());
  const int columns = (v.z + TILE_SIZE - 1) / TILE_SIZE, rows = (v.w + TILE_SIZE - 1) / TILE_SIZE;
  const GladGLContext& gl = c.device.gl;
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  gl.Viewport(0, 0, columns, rows);
  gl.Scissor(0, 0, columns, rows);
  gl.Disable(GL_DEPTH_TEST);
  c.targets.texture("depth")->bind(UNIT_DEPTH);
  if (auto drawn = c.drawScreen(c.view.orthographic ? "tile_depth+ortho" : "tile_depth"); !drawn) return drawn;
  tileDepths_.resize(std::size_t(columns * rows));
  static_assert(sizeof(TileDepth) == 16);
  gl.GetTextureSubImage(c.targets.texture("tile_depth")->id(), 0, 0, 0, 0, columns, rows, 1, GL_RGBA, GL_FLOAT, GLsizei(tileDepths_.size() * sizeof(TileDepth)), tileDepths_.data());
  return {};
}

void LightingPass::readTileSurfaces(FrameContext& c) {
  const glm::ivec4 v = c.view.viewport;
  normals_.resize(depth_.size());
  // Four bytes a pixel: the whole of RGBA8, or the first two channels of RGBA16.
  const bool wide = c.quality.normalStorage == NormalStorage::Oct16;
  c.device.gl.GetTextureSubImage(c.targets.texture("gbuffer_b")->id(), 0, v.x, v.y, 0, v.z, v.w, 1, wide ? GL_RG : GL_RGBA, wide ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE, GLsizei(normals_.size() * sizeof(std::uint32_t)), normals_.data());
  surfaces_.begin(c.view, depth_, normals_, c.quality.normalStorage);
}

Result<void> LightingPass::uploadLights(FrameContext& c) {
  const std::size_t shadowed = c.shadows ? c.shadows->locals.size() : 0;
  std::vector<glm::vec4> texels(LIGHT_TEXELS * (c.lights.local.size() + 1), glm::vec4(0));
  texels[0] = {0, 0, 1, 0};  // the black light that pads lists
  for (std::size_t i = 0; i < c.lights.local.size(); ++i) {
    const scene::LocalLight& l = c.lights.local[i];
    glm::vec4* t = &texels[LIGHT_TEXELS * (i + 1)];
    t[0] = glm::vec4(l.position, l.invRange4);
    t[1] = glm::vec4(glm::min(l.intensity * c.preExposure, glm::vec3(1e18f)), l.bias);
    t[2] = glm::vec4(l.axis, l.spotScale);
    t[3] = glm::vec4(l.spotOffset, i < shadowed ? float(i + 1) : 0.0f, l.sourceRadius, 0);
  }
  for (std::size_t i = 0; i < shadowed; ++i) {
    const std::vector<glm::vec4> record = gpu_scene::shadowRecord(*c.shadows, c.shadows->locals[i], c.view.eye);
    texels.insert(texels.end(), record.begin(), record.end());
  }
  return fill(device_, lights_, GL_RGBA32F, std::as_bytes(std::span(texels)), "lights");
}

// entries: the tiles' lists of local lights, too.
Result<void> LightingPass::uploadLists(bool entries) {
  if (entries)
    if (auto w = fill(device_, entries_, GL_R16UI, std::as_bytes(std::span(lists_->entries)), "light lists"); !w) return w;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(lists_->tiles));
  if (!tiles_) {
    auto made = gl::Buffer::create(device_, gl::BufferUse::Stream, bytes.size(), nullptr, "tiles");
    if (!made) return fail(made.error());
    tiles_ = std::move(*made);
    const gl::VertexAttribute attribute{0, 4, GL_INT, false, true, 0, 0};
    tileArray_ = gl::VertexArray::create(device_, {&attribute, 1}, {}, 0, "tiles");
  }
  return tiles_.write(bytes);
}

namespace {

// Around each surface that writes the target of details.
std::vector<DetailBox> detailBoxes(const FrameContext& c) {
  std::vector<DetailBox> boxes;
  if (!c.targets.texture("gbuffer_d")) return boxes;
  const plan::Details details = plan::detailsOf(c.plan);
  const bool blend = c.plan.on("alpha_blend"), glass = c.plan.on("glass");
  for (const scene::VisibleInstance& v : c.visible) {
    const Material* m = c.scene.materials.get(v.instance->material);
    if (!m || plan::drawnTransparent(*m, blend, glass)) continue;
    const plan::GeometryVariant variant = plan::variantOf(*m, *v.mesh, details);
    if (variant.detail()) boxes.push_back({v.center, v.extent, {variant.brushed, variant.rough}});
  }
  return boxes;
}

}  // namespace

Result<void> LightingPass::buildTiles(FrameContext& c) {
  if (auto read = readTileDepths(c); !read) return read;
  const bool local = c.plan.on("local_lights"), surfaces = local && !c.targets.texture("tile_depth");
  std::function<TileSurfaces*()> read;
  if (surfaces)
    read = [&] {
      readTileSurfaces(c);
      return &surfaces_;
    };
  const std::optional<std::vector<ProbeBox>> probes = probeBoxes(c);
  lists_ = &culler_.cull(c.view, tileDepths_, c.lights.local, c.shadows ? c.shadows->locals.size() : 0, detailBoxes(c), read, probes ? &*probes : nullptr);
  c.stats.lightsInView += lists_->lightsInView;
  if (auto w = uploadTileProbes(c); !w) return w;
  if (local)
    if (auto w = uploadLights(c); !w) return w;
  return uploadLists(local);
}

// Whole tiles, so that no point's centre falls outside and is clipped; the scissor keeps the view's rectangle.
void LightingPass::widenViewport(const FrameContext& c) {
  const glm::ivec4 v = c.view.viewport;
  c.setViewport();
  c.device.gl.Viewport(v.x, v.y, (v.z + TILE_SIZE - 1) / TILE_SIZE * TILE_SIZE, (v.w + TILE_SIZE - 1) / TILE_SIZE * TILE_SIZE);
  c.device.gl.Enable(GL_PROGRAM_POINT_SIZE);
}

void LightingPass::bindTiles() {
  tileArray_.bind();
  device_.gl.VertexArrayVertexBuffer(tileArray_.id(), 0, tiles_.id(), 0, sizeof(TileVertex));
}

Result<GLuint> LightingPass::dfgTable(const Quality& quality) {
  const int index = prefilter::dfgIndex(plan::rungsOf(quality));
  gl::Texture& t = dfg_[std::size_t(index)];
  if (!t) {
    const prefilter::DfgTable table = prefilter::dfgTable(index);
    // Albedos above 1 (models that gain energy) do not fit normalized integers.
    auto made = gl::Texture::create(device_, {.format = GLenum(table.scale > 1 ? GL_RG32F : GL_RG16), .width = table.width, .height = table.height}, "dfg");
    if (!made) return fail(made.error());
    if (table.scale > 1) {
      std::vector<float> values(table.texels.size());
      std::transform(table.texels.begin(), table.texels.end(), values.begin(), [&](std::uint16_t v) { return float(v) / 65535 * table.scale; });
      made->upload(0, values.data());
    } else {
      made->upload(0, table.texels.data());
    }
    made->setFilter(GL_LINEAR, GL_LINEAR);
    t = std::move(*made);
  }
  return t.id();
}

Result<void> LightingPass::bindSurroundings(FrameContext& c, int environmentUnit, bool places) {
  const bool environment = c.plan.on("environment_lighting");
  if (plan::needsDfg(c.quality, environment || places, plan::reads(c.plan, "ambient lattice"))) {
    auto table = dfgTable(c.quality);
    if (!table) return fail(table.error());
    c.device.gl.BindTextureUnit(UNIT_DFG, *table);
  }
  if (plan::needsCube(c.quality, environment)) {
    c.environment->cube.bind(GLuint(environmentUnit));
    c.device.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  }
  if (places) gpu_scene::bindProbes(c);
  gpu_scene::bindGrid(c);
  return {};
}

Result<void> LightingPass::bindForward(FrameContext& c) {
  if (c.plan.on("local_lights"))
    if (auto done = uploadLights(c); !done) return done;
  c.stats.lightsInView += int(c.lights.local.size());
  return bindLights(c);
}

Result<void> LightingPass::bindLights(FrameContext& c) {
  c.device.gl.BindSamplers(0, 10, nullptr);
  if (c.plan.on("local_lights")) lights_.bind(UNIT_LIGHTS);
  gpu_scene::bindShadows(c);
  return bindSurroundings(c, UNIT_FORWARD_ENVIRONMENT, plan::reads(c.plan, "probe records"));
}

Result<void> LightingPass::shadeTiles(FrameContext& c) {
  if (lists_->groups.empty()) return {};
  const auto any = [this](bool (*of)(const TileGroup&)) { return std::any_of(lists_->groups.begin(), lists_->groups.end(), of); };
  const GladGLContext& gl = c.device.gl;
  auto framebuffer = c.lightFramebuffer(false);
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  widenViewport(c);
  gl.Disable(GL_DEPTH_TEST);
  c.targets.texture("gbuffer_a")->bind(UNIT_GBUFFER_A);
  c.targets.texture("gbuffer_b")->bind(UNIT_GBUFFER_B);
  c.targets.texture("depth")->bind(UNIT_DEPTH);
  gl.BindSamplers(0, 10, nullptr);
  const bool screen = c.plan.on("screen_occlusion"), occlusion = screen || c.plan.on("baked_occlusion"), environment = c.plan.on("environment_lighting");
  if (occlusion) c.targets.texture(screen ? "occlusion" : "gbuffer_c")->bind(UNIT_GBUFFER_C);
  if (const gl::Texture* detail = c.targets.texture("gbuffer_d")) detail->bind(UNIT_GBUFFER_D);
  if (auto bound = bindSurroundings(c, UNIT_ENVIRONMENT, any([](const TileGroup& g) { return g.places != plan::Places::None; })); !bound) return bound;
  if (any([](const TileGroup& g) { return g.bucket != 0; })) {
    lights_.bind(UNIT_LIGHTS);
    entries_.bind(UNIT_LIGHT_LISTS);
  }
  gpu_scene::bindShadows(c);
  lists_->probes.empty() ? bindTiles() : bindProbeTiles();
  for (const TileGroup& g : lists_->groups) {
    plan::LightingVariant lighting{int(c.lights.directional.size()), environment, occlusion, c.view.orthographic};
    lighting.details = g.details;
    lighting.places = g.places;
    const std::string name = plan::lightingProgram(g.bucket, c.quality, lighting).name;
    const gl::Program* program = c.programs.find(name);
    if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
    program->use();
    gl.DrawArrays(GL_POINTS, g.first, g.count);
  }
  return {};
}

Result<void> LightingPass::drawAllTiles(FrameContext& c) {
  widenViewport(c);
  bindTiles();
  c.device.gl.DrawArrays(GL_POINTS, 0, lists_->background.first);
  return {};
}

namespace {

// A program of lighting/screen_tile.vert over the tiles that hold surfaces.
Result<void> drawTilesInto(FrameContext& c, LightingPass& pass, std::string_view target, std::string name) {
  auto framebuffer = c.targets.framebuffer({target});
  if (!framebuffer) return fail(framebuffer.error());
  c.device.gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.device.gl.Disable(GL_DEPTH_TEST);
  c.device.gl.BindSamplers(0, 10, nullptr);
  if (c.view.orthographic) name += "+ortho";
  const gl::Program* program = c.programs.find(name);
  if (!program) return fail("frame plan", fmt::format("program '{}' is not in it", name), "report this as a fault of the engine");
  program->use();
  return pass.drawAllTiles(c);
}

}  // namespace

Result<void> LightingPass::findOcclusion(FrameContext& c) {
  c.targets.texture("gbuffer_b")->bind(UNIT_GBUFFER_B);
  c.targets.texture("depth")->bind(UNIT_DEPTH);
  return drawTilesInto(c, *this, "occlusion_raw", "occlusion");
}

Result<void> LightingPass::denoiseOcclusion(FrameContext& c) {
  c.targets.texture("occlusion_raw")->bind(UNIT_OCCLUSION);
  c.targets.texture("depth")->bind(UNIT_DEPTH);
  if (const gl::Texture* baked = c.targets.texture("gbuffer_c")) baked->bind(UNIT_GBUFFER_C);
  return drawTilesInto(c, *this, "occlusion", "occlusion_denoise");
}

Result<void> LightingPass::drawBackground(FrameContext& c) {
  // Only where the tiles' depths say that something shows.
  const bool tiles = c.plan.pass("tiles");
  if (tiles && lists_->background.count == 0) return {};
  const GladGLContext& gl = c.device.gl;
  const gl::Texture* depth = c.targets.texture("depth");
  auto framebuffer = c.lightFramebuffer(true);
  if (!framebuffer) return fail(framebuffer.error());
  gl.BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
  c.setViewport();
  gl.Disable(GL_DEPTH_TEST);
  if (depth && !c.targets.texture("light")) {
    depth->bind(UNIT_DEPTH);  // the target's framebuffer has not the scene's depth: the program looks it up
  } else if (depth) {
    gl.Enable(GL_DEPTH_TEST);
    gl.DepthFunc(GL_EQUAL);
    gl.DepthMask(GL_FALSE);
  }
  gl.BindSamplers(0, 10, nullptr);
  const std::vector<std::string>& reads = c.plan.pass("background")->reads;
  if (std::find(reads.begin(), reads.end(), "environment") != reads.end()) c.environment->sky.bind(UNIT_ENVIRONMENT);
  const char* name = c.view.orthographic ? "background+ortho" : "background";
  Result<void> drawn;
  if (!tiles) {
    drawn = c.drawScreen(name);
  } else if (const gl::Program* program = c.programs.find(name)) {
    widenViewport(c);
    program->use();
    bindTiles();
    gl.DrawArrays(GL_POINTS, lists_->background.first, lists_->background.count);
  }
  gl.DepthMask(GL_TRUE);
  return drawn;
}

}  // namespace burnish::lighting
