// HostStateGuard: every row of the table is changed, guarded, scrambled, and must come back.
#include <set>

#include "gl/host_state.h"
#include "gl/program.h"
#include "gl_fixture.h"

using namespace burnish;
using namespace burnish::gl;
using burnish::test::GlFixture;

namespace {

constexpr EmbeddedShader kFiles[] = {
    {"v.vert", "out gl_PerVertex { vec4 gl_Position; };\nvoid main() { gl_Position = vec4(0); }\n"}};

/// Two real objects of every kind, so that bindings can be changed twice.
class Objects {
 public:
  explicit Objects(Device& device) : device_(device), cache_(device, ShaderLibrary({}, kFiles)) {
    const GladGLContext& gl = device.gl;
    for (std::size_t i = 0; i < 2; ++i) {
      texture(StateObject::Texture2D, i, GL_TEXTURE_2D);
      texture(StateObject::TextureCube, i, GL_TEXTURE_CUBE_MAP);
      texture(StateObject::Texture2DArray, i, GL_TEXTURE_2D_ARRAY, 2);
      texture(StateObject::TextureCubeArray, i, GL_TEXTURE_CUBE_MAP_ARRAY, 6);
      id(StateObject::Image, i) = id(StateObject::Texture2D, i);
      buffers_[i] = std::move(*Buffer::create(device, BufferUse::Dynamic, 4096, nullptr, "b"));
      id(StateObject::Buffer, i) = buffers_[i].id();
      texels_[i] = std::move(*TextureBuffer::create(device, GL_R32F, BufferUse::Dynamic, 64, nullptr, "tb"));
      id(StateObject::TextureBuffer, i) = texels_[i].id();
      samplers_[i] = Sampler::create(device, {}, "s");
      id(StateObject::Sampler, i) = samplers_[i].id();
      arrays_[i] = VertexArray::create(device, {}, {}, 0, "v");
      id(StateObject::VertexArray, i) = arrays_[i].id();
      const Attachment color(textures_[0]);
      stencils_[i] = std::move(*Texture::create(device, {GL_TEXTURE_2D, GL_DEPTH24_STENCIL8, 4, 4}, "d"));
      framebuffers_[i] = std::move(*Framebuffer::create(device, {&color, 1}, Attachment(stencils_[i]), "f"));
      id(StateObject::Framebuffer, i) = framebuffers_[i].id();
      gl.CreateRenderbuffers(1, &id(StateObject::Renderbuffer, i));
      gl.CreateProgramPipelines(1, &id(StateObject::Pipeline, i));
      auto program = cache_.get({"p", "v.vert", "", "", {"N " + std::to_string(i)}});
      REQUIRE(program);
      id(StateObject::Program, i) = (*program)->id();
    }
  }
  ~Objects() {
    for (std::size_t i = 0; i < 2; ++i) {
      device_.gl.DeleteRenderbuffers(1, &id(StateObject::Renderbuffer, i));
      device_.gl.DeleteProgramPipelines(1, &id(StateObject::Pipeline, i));
    }
  }
  GLuint& id(StateObject kind, std::size_t which) { return ids_[std::size_t(kind)][which]; }

 private:
  void texture(StateObject kind, std::size_t i, GLenum target, int layers = 1) {
    auto made = Texture::create(device_, {target, GL_RGBA8, 4, 4, layers}, "t");
    REQUIRE(made);
    id(kind, i) = made->id();
    textures_.push_back(std::move(*made));
  }
  Device& device_;
  ProgramCache cache_;
  std::vector<Texture> textures_;
  std::array<Buffer, 2> buffers_;
  std::array<TextureBuffer, 2> texels_;
  std::array<Sampler, 2> samplers_;
  std::array<VertexArray, 2> arrays_;
  std::array<Texture, 2> stencils_;
  std::array<Framebuffer, 2> framebuffers_;
  std::array<std::array<GLuint, 2>, std::size_t(StateObject::Image) + 1> ids_{};
};

/// A value other than GL's default, for a row.
StateValue changed(const StateEntry& e, Objects& objects, std::size_t which) {
  StateValue v = e.other;
  if (e.object != StateObject::None) v[0] = objects.id(e.object, which);
  return v;
}

void perturbAll(const Device& device, Objects& objects, std::size_t which) {
  const auto& table = stateTable();
  for (std::size_t i = table.size(); i-- > 0;) table[i].set(device.gl, changed(table[i], objects, which));
}

void compare(const StateSnapshot& is, const StateSnapshot& was) {
  const auto& table = stateTable();
  REQUIRE(is.size() == table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    INFO(table[i].name);
    CHECK(is[i] == was[i]);
  }
}

}  // namespace

TEST_CASE("the table: names are unique, and a fresh context is at the defaults that it states") {
  GlFixture f;
  std::set<std::string> names;
  for (const StateEntry& e : stateTable()) {
    INFO(e.name);
    CHECK(names.insert(e.name).second);
    StateValue v = e.get(f.gl);
    // Mesa starts stencil masks with 8 ones, the specification with as many as there are.
    const bool mask = e.name.starts_with("stencil mask"), function = e.name.starts_with("stencil function");
    if (mask) v[0] = double(unsigned(v[0]) & 0xff);
    if (function) v[2] = double(unsigned(v[2]) & 0xff);
    if (e.initial && e.name != "active texture") CHECK(v == *e.initial);
    if (e.object == StateObject::None && e.initial) CHECK(e.other != *e.initial);
  }
  CHECK(names.size() > 400);
  f.gl.ActiveTexture(GL_TEXTURE0);
  CHECK(f.device->takeErrors().empty());
}

TEST_CASE("every row can be changed and read back alone") {
  GlFixture f;
  Objects objects(*f.device);
  f.gl.BindFramebuffer(
      GL_FRAMEBUFFER,
      objects.id(StateObject::Framebuffer, 1));  // one with a stencil: its bits limit what the reference reads as
  for (const StateEntry& e : stateTable()) {
    INFO(e.name);
    const StateValue before = e.get(f.gl), wanted = changed(e, objects, 0);
    CHECK(before != wanted);
    e.set(f.gl, wanted);
    CHECK(e.get(f.gl) == wanted);
    e.set(f.gl, before);
    CHECK(e.get(f.gl) == before);
    const auto errors = f.device->takeErrors();
    CHECK(errors == std::vector<std::string>{});
  }
}

TEST_CASE("one row changed by the host at a time: guard, scramble, restore") {
  GlFixture f;
  Objects objects(*f.device);
  const auto& table = stateTable();
  setDefaults(*f.device);
  // Changing all rows one after the other, with a guard each, leaves more and more of them changed.
  for (std::size_t i = table.size(); i-- > 0;) {
    table[i].set(f.gl, changed(table[i], objects, 0));
    if (i % 37 != 0) continue;
    const StateSnapshot before = captureState(*f.device);
    {
      const HostStateGuard guard(*f.device);
      perturbAll(*f.device, objects, 1);
    }
    compare(captureState(*f.device), before);
  }
  CHECK(f.device->takeErrors() == std::vector<std::string>{});
  setDefaults(*f.device);
}

TEST_CASE("everything changed by the host; the engine starts from defaults, and all comes back") {
  GlFixture f;
  Objects objects(*f.device);
  perturbAll(*f.device, objects, 0);
  const StateSnapshot before = captureState(*f.device);
  {
    const HostStateGuard guard(*f.device);
    const StateSnapshot inside = captureState(*f.device);
    const auto& table = stateTable();
    for (std::size_t i = 0; i < table.size(); ++i) {
      INFO(table[i].name);
      if (table[i].initial && !table[i].lossy) CHECK(inside[i] == *table[i].initial);
    }
    perturbAll(*f.device, objects, 1);
    f.device->pushGroup("left open");
  }
  compare(captureState(*f.device), before);
  CHECK(f.device->takeErrors() == std::vector<std::string>{});
  setDefaults(*f.device);
  CHECK(f.device->takeErrors() == std::vector<std::string>{});
}

TEST_CASE("plain calls that set every index come back index by index") {
  GlFixture f;
  f.gl.ViewportIndexedf(3, 1, 2, 30, 40);
  f.gl.Enablei(GL_SCISSOR_TEST, 5);
  f.gl.Enablei(GL_BLEND, 2);
  f.gl.ColorMaski(1, GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
  const StateSnapshot before = captureState(*f.device);
  {
    const HostStateGuard guard(*f.device);
    f.gl.Viewport(0, 0, 7, 7);
    f.gl.Enable(GL_SCISSOR_TEST);
    f.gl.Disable(GL_BLEND);
    f.gl.ColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_FALSE);
    f.gl.DepthRange(0.2, 0.3);
    f.gl.BlendFunc(GL_ONE, GL_ONE);
  }
  compare(captureState(*f.device), before);
}

TEST_CASE("a stencil reference survives although the framebuffer in use has no stencil") {
  GlFixture f;
  Objects objects(*f.device);
  auto plain = Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA8, 4, 4}, "plain");
  const Attachment color(*plain);
  auto framebuffer = Framebuffer::create(*f.device, {&color, 1}, {}, "no stencil");
  f.gl.StencilFunc(GL_EQUAL, 3, 0x0f);
  framebuffer->bind();
  { const HostStateGuard guard(*f.device); }
  f.gl.BindFramebuffer(GL_FRAMEBUFFER, objects.id(StateObject::Framebuffer, 0));
  GLint reference = 0;
  f.gl.GetIntegerv(GL_STENCIL_REF, &reference);
  CHECK(reference == 3);
  f.gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
}
