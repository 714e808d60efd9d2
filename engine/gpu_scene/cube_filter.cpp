#include "gpu_scene/cube_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "gpu_scene/layout.h"
#include "reference/shading.h"

namespace burnish::gpu_scene {
namespace {

constexpr int kTaps = 6;     // points that a point gives its value to, an axis
constexpr int kBeyond = 3;   // as many lie past a face's edge as its first points reach
constexpr int kSmallest = 16;  // texels along an edge of the coarsest grid
constexpr const char* kPlace = "cube filter";

/// The grids of a source and the atlas' size: the finest in the first rows, all others side by side below.
glm::ivec2 layOut(int sourceSize, std::vector<CubeGrid>& grids) {
  grids = {{sourceSize, 0, sourceSize, 0, 0}};
  int x = 0;
  for (int size = sourceSize / 2; size >= kSmallest; size /= 2) {
    const int side = size + 2 * kBeyond;
    grids.push_back({size, kBeyond, side, x, sourceSize});
    x += 6 * side;
  }
  return {std::max(6 * sourceSize, x), sourceSize + (grids.size() > 1 ? grids[1].side : 0)};
}

glm::ivec3 shaderGrid(const CubeGrid& g) { return {g.size, g.beyond, g.side}; }

gl::ProgramSource sourceOf(std::string_view name, std::vector<std::string> defines = {}) {
  return {fmt::format("cube filter: {}", name), "post/screen.vert", fmt::format("prefilter/{}.frag", name), {}, std::move(defines)};
}

Result<gl::Texture> scratchTexture(gl::Device& device, glm::ivec2 size, std::string_view label) {
  return gl::Texture::create(device, {.format = GL_RGBA32F, .width = size.x, .height = size.y}, label);
}

Result<gl::Framebuffer> framebufferOf(gl::Device& device, const gl::Attachment& attachment, std::string_view label) { return gl::Framebuffer::create(device, {&attachment, 1}, {}, label); }

bool powerOfTwo(int n) { return n > 0 && std::has_single_bit(unsigned(n)); }

}  // namespace

/// What a slice binds, for as long as it draws.
struct CubeFilter::Drawing {
  Drawing(gl::Device& d, gl::ProgramCache& p, const gl::VertexArray& none) : device(d), programs(p), group(d, kPlace) {
    device.gl.GetIntegerv(GL_VIEWPORT, viewport.data());
    scissor = device.gl.IsEnabled(GL_SCISSOR_TEST);
    if (scissor) device.gl.Disable(GL_SCISSOR_TEST);
    none.bind();
  }
  ~Drawing() {
    const GladGLContext& gl = device.gl;
    gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.BindVertexArray(0);
    gl.UseProgram(0);
    gl.BindTextureUnit(UNIT_CUBE_FILTER, 0);
    if (scissor) gl.Enable(GL_SCISSOR_TEST);
    gl.Viewport(viewport[0], viewport[1], viewport[2], viewport[3]);
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;

  Result<GLuint> use(const gl::ProgramSource& source) {
    auto program = programs.get(source);
    if (!program) return fail(program.error());
    (*program)->use();
    return (*program)->id();
  }
  void into(const gl::Framebuffer& framebuffer, glm::ivec4 rectangle) {
    framebuffer.bind();
    device.gl.Viewport(rectangle.x, rectangle.y, rectangle.z, rectangle.w);
  }
  void triangle() { device.gl.DrawArrays(GL_TRIANGLES, 0, 3); }

  gl::Device& device;
  gl::ProgramCache& programs;
  gl::DebugGroup group;
  std::array<GLint, 4> viewport{};
  GLboolean scissor = GL_FALSE;
};

CubeFilter::CubeFilter(gl::Device& device, gl::ProgramCache& programs, const CubeFilterOptions& options) : device_(device), programs_(programs), options_(options) {}

Result<void> CubeFilter::prepare(int sourceSize) {
  if (!none_) none_ = gl::VertexArray::create(device_, {}, {}, 0, kPlace);
  if (!nearest_) nearest_ = gl::Sampler::create(device_, {GL_NEAREST, GL_NEAREST}, "cube filter: source");
  if (!irradiance_) {
    auto made = scratchTexture(device_, {9, 1}, "cube filter: irradiance");
    if (!made) return fail(made.error());
    irradiance_ = std::move(*made);
    auto framebuffer = framebufferOf(device_, irradiance_, "cube filter: irradiance");
    if (!framebuffer) return fail(framebuffer.error());
    irradianceTarget_ = std::move(*framebuffer);
  }
  if (!grids_.empty() && grids_[0].size == sourceSize) return {};
  std::vector<CubeGrid> grids;
  auto atlas = scratchTexture(device_, layOut(sourceSize, grids), "cube filter: grids");
  if (!atlas) return fail(atlas.error());
  // A grid that is coarser along x only.
  auto scratch = scratchTexture(device_, {grids.size() > 1 ? 6 * grids[1].side : 1, sourceSize}, "cube filter: half-way grid");
  if (!scratch) return fail(scratch.error());
  auto atlasTarget = framebufferOf(device_, *atlas, "cube filter: grids"), scratchTarget = framebufferOf(device_, *scratch, "cube filter: half-way grid");
  if (!atlasTarget) return fail(atlasTarget.error());
  if (!scratchTarget) return fail(scratchTarget.error());
  atlasTarget_ = std::move(*atlasTarget);
  scratchTarget_ = std::move(*scratchTarget);
  atlas_ = std::move(*atlas);
  scratch_ = std::move(*scratch);
  grids_ = std::move(grids);
  return {};
}

Result<void> CubeFilter::begin(const gl::Texture& source, const gl::Texture& target) {
  slices_.clear();
  next_ = 0;
  if (source.target != GL_TEXTURE_CUBE_MAP || !powerOfTwo(source.width) || source.width < kSmallest)
    return fail(kPlace, fmt::format("the source is {} texels wide", source.width), fmt::format("give a cube of a power of two from {} texels on", kSmallest));
  if (target.target != GL_TEXTURE_CUBE_MAP || target.format != GL_RGBA16F || !powerOfTwo(target.width) || target.width > source.width)
    return fail(kPlace, fmt::format("the target is {} texels wide", target.width), fmt::format("give a GL_RGBA16F cube of a power of two up to the source's {}", source.width));
  if (auto done = prepare(source.width); !done) return done;
  source_ = source.id();
  target_ = target;
  targetSize_ = target.width;
  levels_.assign(1, {});
  for (int k = 1; k < target.levels; ++k)
    levels_.push_back(cubeLobeParts(prefilter::Lobe::of(options_.lobe, shading::f64::environmentRoughness(double(k), double(target.levels - 1))), grids_, options_.effort));
  const auto align = std::size_t(std::max(device_.caps.uniformAlignment, 1));
  partsStride_ = (kMostCubeParts * sizeof(CubeLobePart) + align - 1) / align * align;
  std::vector<std::byte> bytes(partsStride_ * levels_.size());
  for (std::size_t k = 0; k < levels_.size(); ++k) std::copy_n(reinterpret_cast<const std::byte*>(levels_[k].data()), levels_[k].size() * sizeof(CubeLobePart), bytes.data() + k * partsStride_);
  if (!parts_) {
    auto made = gl::Buffer::create(device_, gl::BufferUse::Stream, bytes.size(), nullptr, "cube filter: lobes");
    if (!made) return fail(made.error());
    parts_ = std::move(*made);
  }
  if (auto written = parts_.write(bytes); !written) return written;
  listSlices();
  return {};
}

void CubeFilter::listSlices() {
  slices_.push_back({Step::Gather});
  slices_.push_back({Step::Coarsen});
  for (int level = 0; level < int(levels_.size()); ++level) {
    const int size = std::max(1, targetSize_ >> level), over = grids_[0].size / targetSize_;
    const double row = (level ? pointsOf(level) : double(over) * over) * size;
    const int rows = int(std::clamp(options_.sliceWork / row, 1.0, double(size)));
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < size; y += rows) slices_.push_back({level ? Step::Level : Step::LevelZero, level, face, y, std::min(rows, size - y)});
  }
}

Result<bool> CubeFilter::filterSlice() {
  if (next_ >= slices()) return fail(kPlace, "there is nothing left to draw", "call begin() first");
  Drawing drawing(device_, programs_, none_);
  if (auto done = draw(slices_[std::size_t(next_)], drawing); !done) return fail(done.error());
  return ++next_ == slices();
}

Result<void> CubeFilter::filter(const gl::Texture& source, const gl::Texture& target) {
  if (auto begun = begin(source, target); !begun) return begun;
  for (bool last = false; !last;) {
    auto done = filterSlice();
    if (!done) return fail(done.error());
    last = *done;
  }
  return {};
}

Result<void> CubeFilter::draw(const Slice& slice, Drawing& drawing) {
  if (slice.step == Step::Gather) return gather(drawing);
  if (slice.step == Step::Coarsen) return coarsen(drawing);
  return drawFace(slice, drawing);
}

Result<void> CubeFilter::gather(Drawing& drawing) {
  const GladGLContext& gl = device_.gl;
  auto program = drawing.use(sourceOf("gather"));
  if (!program) return fail(program.error());
  const int size = grids_[0].size;
  gl.ProgramUniform1i(*program, 0, size);
  gl.BindTextureUnit(UNIT_CUBE_FILTER, source_);
  nearest_.bind(UNIT_CUBE_FILTER);
  drawing.into(atlasTarget_, {0, 0, 6 * size, size});
  drawing.triangle();
  gl.BindSampler(UNIT_CUBE_FILTER, 0);
  return {};
}

Result<void> CubeFilter::coarsen(Drawing& drawing) {
  const GladGLContext& gl = device_.gl;
  const std::string taps = fmt::format("TAPS {}", kTaps);
  for (std::size_t m = 1; m < grids_.size(); ++m) {
    const CubeGrid &fine = grids_[m - 1], &coarse = grids_[m];
    for (const bool alongX : {true, false}) {
      auto program = drawing.use(sourceOf("coarsen", {taps, fmt::format("ALONG_X {}", int(alongX))}));
      if (!program) return fail(program.error());
      const glm::ivec3 f = shaderGrid(fine), c = shaderGrid(coarse);
      gl.ProgramUniform3i(*program, 0, f.x, f.y, f.z);
      gl.ProgramUniform3i(*program, 1, c.x, c.y, c.z);
      gl.ProgramUniform4i(*program, 2, alongX ? fine.x : 0, alongX ? fine.y : 0, alongX ? 0 : coarse.x, alongX ? 0 : coarse.y);
      (alongX ? atlas_ : scratch_).bind(UNIT_CUBE_FILTER);
      if (alongX)
        drawing.into(scratchTarget_, {0, 0, 6 * coarse.side, fine.side});
      else
        drawing.into(atlasTarget_, {coarse.x, coarse.y, 6 * coarse.side, coarse.side});
      drawing.triangle();
    }
  }
  auto program = drawing.use(sourceOf("irradiance"));
  if (!program) return fail(program.error());
  const CubeGrid& last = grids_.back();
  gl.ProgramUniform3i(*program, 0, last.size, last.beyond, last.side);
  gl.ProgramUniform2i(*program, 1, last.x, last.y);
  atlas_.bind(UNIT_CUBE_FILTER);
  drawing.into(irradianceTarget_, {0, 0, 9, 1});
  drawing.triangle();
  return {};
}

Result<void> CubeFilter::drawFace(const Slice& slice, Drawing& drawing) {
  const GladGLContext& gl = device_.gl;
  const int size = std::max(1, targetSize_ >> slice.level);
  const bool zero = slice.step == Step::LevelZero;
  auto program = drawing.use(zero ? sourceOf("level_zero") : sourceOf("lobe", {fmt::format("GGX {}", int(options_.lobe == ReflectionLobe::Ggx)), fmt::format("MOST_PARTS {}", kMostCubeParts)}));
  if (!program) return fail(program.error());
  // Made for the slice: the host may delete the target at any time after the last.
  gl::Attachment into = target_;
  into.level = slice.level;
  into.layer = slice.face;
  auto framebuffer = framebufferOf(device_, into, fmt::format("cube filter: level {} face {}", slice.level, slice.face));
  if (!framebuffer) return fail(framebuffer.error());
  const auto& parts = levels_[std::size_t(slice.level)];
  gl.ProgramUniform3i(*program, 0, slice.face, size, zero ? grids_[0].size / targetSize_ : int(parts.size()));
  if (!zero) parts_.bindRange(GL_UNIFORM_BUFFER, BINDING_CUBE_FILTER, std::size_t(slice.level) * partsStride_, kMostCubeParts * sizeof(CubeLobePart));
  atlas_.bind(UNIT_CUBE_FILTER);
  drawing.into(*framebuffer, {0, slice.row, size, slice.rows});
  drawing.triangle();
  if (!zero) gl.BindBufferBase(GL_UNIFORM_BUFFER, BINDING_CUBE_FILTER, 0);
  return {};
}

std::array<glm::vec3, 9> CubeFilter::readIrradiance() const {
  std::array<glm::vec4, 9> texels{};
  if (irradiance_) irradiance_.read(0, std::as_writable_bytes(std::span(texels)));
  std::array<glm::vec3, 9> out{};
  for (std::size_t k = 0; k < 9; ++k) out[k] = glm::vec3(texels[k]);
  return out;
}

}  // namespace burnish::gpu_scene
