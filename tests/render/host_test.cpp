// A host that owns the context: its state, its framebuffer, its depth and its own drawing.
#include <fmt/format.h>

#include <iostream>
#include <thread>

#include "gl/host_state.h"
#include "gl/program.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::gl;
using namespace burnish::test;

namespace {

constexpr EmbeddedShader kFiles[] = {
    {"host.vert", "layout(location = 0) uniform mat4 m;\nlayout(location = 1) uniform vec4 q[4];\nvoid main() { gl_Position = m * q[gl_VertexID]; }\n"},
    {"host.frag", "layout(location = 0) out vec4 color;\nlayout(location = 8) uniform vec4 radiance;\nvoid main() { color = radiance; }\n"}};

/// What a host program owns: two objects of each kind, one framebuffer with colour and depth to be drawn to.
struct Host {
  Device& device;
  const GladGLContext& gl = device.gl;
  glm::ivec2 size;
  ProgramCache cache{device, ShaderLibrary({}, kFiles)};
  std::vector<gl::Texture> textures;
  std::array<gl::Buffer, 2> buffers;
  std::array<TextureBuffer, 2> texels;
  std::array<gl::Sampler, 2> samplers;
  std::array<VertexArray, 2> arrays;
  std::array<Framebuffer, 2> framebuffers;
  std::array<std::array<GLuint, 2>, std::size_t(StateObject::Image) + 1> ids{};
  gl::Texture color, depth;
  Framebuffer target;
  const gl::Program* program = nullptr;

  explicit Host(Device& d, glm::ivec2 s = {64, 48}) : device(d), size(s) {
    for (std::size_t i = 0; i < 2; ++i) {
      texture(StateObject::Texture2D, i, GL_TEXTURE_2D);
      texture(StateObject::TextureCube, i, GL_TEXTURE_CUBE_MAP);
      texture(StateObject::Texture2DArray, i, GL_TEXTURE_2D_ARRAY, 2);
      texture(StateObject::TextureCubeArray, i, GL_TEXTURE_CUBE_MAP_ARRAY, 6);
      id(StateObject::Image, i) = id(StateObject::Texture2D, i);
      buffers[i] = std::move(*gl::Buffer::create(device, BufferUse::Dynamic, 4096, nullptr, "b"));
      id(StateObject::Buffer, i) = buffers[i].id();
      texels[i] = std::move(*TextureBuffer::create(device, GL_R32F, BufferUse::Dynamic, 64, nullptr, "tb"));
      id(StateObject::TextureBuffer, i) = texels[i].id();
      samplers[i] = gl::Sampler::create(device, {}, "s");
      id(StateObject::Sampler, i) = samplers[i].id();
      arrays[i] = VertexArray::create(device, {}, {}, 0, "v");
      id(StateObject::VertexArray, i) = arrays[i].id();
      const Attachment attachment(textures[0]);
      textures.push_back(std::move(*gl::Texture::create(device, {GL_TEXTURE_2D, GL_DEPTH24_STENCIL8, 4, 4}, "d")));
      framebuffers[i] = std::move(*Framebuffer::create(device, {&attachment, 1}, Attachment(textures.back()), "f"));
      id(StateObject::Framebuffer, i) = framebuffers[i].id();
      gl.CreateRenderbuffers(1, &id(StateObject::Renderbuffer, i));
      gl.CreateProgramPipelines(1, &id(StateObject::Pipeline, i));
      auto made = cache.get({"host", "host.vert", "host.frag", "", {"N " + std::to_string(i)}});
      REQUIRE(made);
      program = *made;
      id(StateObject::Program, i) = program->id();
    }
    color = std::move(*gl::Texture::create(device, {GL_TEXTURE_2D, GL_RGBA8, size.x, size.y}, "host colour"));
    depth = std::move(*gl::Texture::create(device, {GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, size.x, size.y}, "host depth"));
    const Attachment attachment(color);
    target = std::move(*Framebuffer::create(device, {&attachment, 1}, Attachment(depth), "host"));
  }
  ~Host() {
    for (std::size_t i = 0; i < 2; ++i) {
      gl.DeleteRenderbuffers(1, &id(StateObject::Renderbuffer, i));
      gl.DeleteProgramPipelines(1, &id(StateObject::Pipeline, i));
    }
  }
  GLuint& id(StateObject kind, std::size_t which) { return ids[std::size_t(kind)][which]; }
  void texture(StateObject kind, std::size_t i, GLenum what, int layers = 1) {
    auto made = gl::Texture::create(device, {what, GL_RGBA8, 4, 4, layers}, "t");
    REQUIRE(made);
    id(kind, i) = made->id();
    textures.push_back(std::move(*made));
  }
  /// Every row of the table at a value that is not GL's default.
  void perturb(std::size_t which) {
    const auto& table = stateTable();
    for (std::size_t i = table.size(); i-- > 0;) {
      StateValue v = table[i].other;
      if (table[i].object != StateObject::None) v[0] = id(table[i].object, which);
      table[i].set(gl, v);
    }
  }
  void clear(float r, float g, float b, float d) {
    const float c[4] = {r, g, b, 1};
    gl.Disable(GL_SCISSOR_TEST);
    gl.ColorMask(1, 1, 1, 1);
    gl.ClearNamedFramebufferfv(target.id(), GL_COLOR, 0, c);
    gl.ClearNamedFramebufferfv(target.id(), GL_DEPTH, 0, &d);
  }
  [[nodiscard]] Target asTarget() const {
    Target t;
    t.framebuffer = target.id();
    t.size = size;
    return t;
  }
  [[nodiscard]] Picture read() const {
    Picture p;
    Image raw = makeImage(size.x, size.y, 4, PixelType::U8);
    PixelStoreScope scope(device);
    color.read(0, raw.data);
    p.image = raw;
    const std::size_t row = std::size_t(size.x) * 4;
    for (int y = 0; y < size.y; ++y) std::copy_n(raw.data.begin() + std::ptrdiff_t(std::size_t(size.y - 1 - y) * row), row, p.image.data.begin() + std::ptrdiff_t(std::size_t(y) * row));
    return p;
  }
  /// Rows from the bottom.
  [[nodiscard]] std::vector<float> readDepth() const {
    std::vector<float> d(std::size_t(size.x) * std::size_t(size.y));
    PixelStoreScope scope(device);
    gl.GetTextureImage(depth.id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, GLsizei(d.size() * sizeof(float)), d.data());
    return d;
  }
};

Scene sampleScene() {
  Scene scene;
  Material m;
  m.albedo = {0.6f, 0.5f, 0.4f};
  m.roughness = 0.4f;
  place(scene, sphere(1, 24, 48), m);
  m.emission = {5, 0, 0};
  place(scene, quad({0, -1.2f, 0}, {0, 0, 2}, {2, 0, 0}), m);
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {-0.3, -1, -1});
  addLight(scene, light(LightKind::Point, vec3(1), 30, 10), {1, 2, 2});
  scene.environment.color = vec3(3);
  return scene;
}
const View kView = lookAt({0, 0.5, 4}, {0, 0, 0});
Quality fixedQuality() {
  Quality q;
  q.exposureEv = 5.0f;
  return q;
}

std::unique_ptr<Renderer> makeRenderer(const Context& context, HostState state) {
  RendererOptions options;
  options.hostState = state;
  options.debugOutput = true;
  auto made = Renderer::create(context.procAddress(), options);
  if (!made) FAIL("no renderer: " << made.error().message());
  return std::move(*made);
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

TEST_CASE("HostState::Save: after renderer, frames, picking and an error the whole state is what it was") {
  GlFixture f;
  Host host(*f.device);
  const Scene scene = sampleScene();
  setDefaults(*f.device);
  auto plain = makeRenderer(*f.context, HostState::DontCare);
  REQUIRE(plain->render(scene, {&kView, 1}, host.asTarget(), fixedQuality()));
  const Picture wanted = host.read();
  plain.reset();
  setDefaults(*f.device);
  host.clear(0, 0, 0, 1);
  host.perturb(0);
  const StateSnapshot before = captureState(*f.device);
  auto renderer = makeRenderer(*f.context, HostState::Save);
  compare(captureState(*f.device), before);
  for (TimingMode timing : {TimingMode::Off, TimingMode::Async, TimingMode::Profile}) {
    RenderRequest request;
    request.timing = timing;
    request.countNonfinite = true;
    const auto done = renderer->render(scene, {&kView, 1}, host.asTarget(), fixedQuality(), request);
    REQUIRE(done);
    CHECK(done->glErrors == std::vector<std::string>{});
    compare(captureState(*f.device), before);
  }
  RenderRequest automatic;
  automatic.hostDraw = [&](const HostDraw&) { host.perturb(1); };
  Target both = host.asTarget();
  REQUIRE(renderer->render(scene, {&kView, 1}, both, Quality{}, automatic));
  compare(captureState(*f.device), before);
  for (DebugView v : {DebugView::Albedo, DebugView::Normal, DebugView::Lights, DebugView::Nonfinite}) {
    RenderRequest request;
    request.debugView = v;
    REQUIRE(renderer->render(scene, {&kView, 1}, both, fixedQuality(), request));
  }
  compare(captureState(*f.device), before);
  CHECK(renderer->pick(scene, kView, host.size, {32, 24}));
  compare(captureState(*f.device), before);
  Target bad;
  CHECK(!renderer->render(scene, {&kView, 1}, bad, fixedQuality()));
  compare(captureState(*f.device), before);
  REQUIRE(renderer->render(scene, {&kView, 1}, host.asTarget(), fixedQuality()));
  renderer.reset();
  compare(captureState(*f.device), before);
  setDefaults(*f.device);
  CHECK(same(host.read(), wanted));  // and the frame arrived, unharmed by the host's state
  CHECK(wanted.at(32, 20).x > 0.1);
  std::cout << fmt::format("  {} pieces of state compared\n", before.size());
}

TEST_CASE("HostState::Declared: everything at GL's defaults, no engine object bound") {
  GlFixture f;
  Host host(*f.device);
  const Scene scene = sampleScene();
  auto renderer = makeRenderer(*f.context, HostState::Declared);
  host.perturb(0);
  REQUIRE(renderer->render(scene, {&kView, 1}, host.asTarget(), fixedQuality()));
  const StateSnapshot after = captureState(*f.device);
  const auto& table = stateTable();
  for (std::size_t i = 0; i < table.size(); ++i) {
    INFO(table[i].name);
    if (table[i].initial && table[i].name != "active texture") CHECK(after[i] == *table[i].initial);
  }
  setDefaults(*f.device);
}

TEST_CASE("the host draws into the frame: depth tested, in radiance, scrambling what it likes") {
  GlFixture f;
  Host host(*f.device);
  const Scene scene = sampleScene();
  auto renderer = makeRenderer(*f.context, HostState::Save);
  const auto draw = [&](double z, bool callback) {
    RenderRequest request;
    int calls = 0;
    if (callback)
      request.hostDraw = [&](const HostDraw& d) {
        ++calls;
        CHECK(d.viewport == glm::ivec4(0, 0, host.size));
        const auto at = [&](double x, double y) { return vec4(glm::vec4(glm::dvec4(dvec3(x, y, z) - d.eye, 1))); };
        const vec4 corners[4] = {at(-2, -2), at(2, -2), at(-2, 2), at(2, 2)};
        host.gl.UseProgram(host.program->id());
        host.gl.ProgramUniformMatrix4fv(host.program->id(), 0, 1, GL_FALSE, &d.viewProjection[0][0]);
        host.gl.ProgramUniform4fv(host.program->id(), 1, 4, &corners[0][0]);
        host.gl.ProgramUniform4f(host.program->id(), 8, 0, 20 * d.exposure, 0, 1);
        host.gl.BindVertexArray(host.id(StateObject::VertexArray, 0));
        host.gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4);
        host.perturb(1);
      };
    const auto done = renderer->render(scene, {&kView, 1}, host.asTarget(), fixedQuality(), request);
    REQUIRE(done);
    CHECK(done->glErrors == std::vector<std::string>{});
    CHECK(calls == int(callback));
    return host.read();
  };
  const Picture without = draw(0, false), behind = draw(-3, true), before = draw(1.5, true);
  CHECK(behind.at(32, 24) == without.at(32, 24));  // the sphere hides it
  CHECK(behind.at(32, 8) != without.at(32, 8));    // above the sphere it shows
  // 20 cd/m² of green at EV 5: 20 / (1.2 · 32) = 0.52, under the neutral curve's knee.
  CHECK(before.at(32, 24).y == Approx(0.745).margin(0.02));
  CHECK(before.at(32, 24).x < 0.01);
}

TEST_CASE("host depth in: the host's picture stays where its geometry is nearer") {
  GlFixture f;
  Host host(*f.device);
  const Scene scene = sampleScene();
  auto renderer = makeRenderer(*f.context, HostState::Save);
  const float near = 0.5f, far = 100;
  for (bool reversed : {false, true})
    for (float distance : {2.0f, 8.0f}) {
      INFO("distance " << distance << ", reversed " << reversed);
      float d = far / (far - near) * (1 - near / distance);
      if (reversed) d = 1 - d;
      host.clear(0, 0, 1, d);  // the host has filled the left half with a wall
      const float empty = reversed ? 0.0f : 1.0f;
      host.gl.Enable(GL_SCISSOR_TEST);
      host.gl.Scissor(32, 0, 32, 48);
      host.gl.ClearNamedFramebufferfv(host.target.id(), GL_DEPTH, 0, &empty);
      host.gl.Disable(GL_SCISSOR_TEST);
      Target target = host.asTarget();
      target.depthIn = HostDepth{host.depth.id(), near, far, reversed};
      REQUIRE(renderer->render(scene, {&kView, 1}, target, fixedQuality()));
      const Picture p = host.read();
      const bool nearer = distance < 3;
      CHECK((p.at(28, 24) == dvec3(0, 0, 1)) == nearer);  // on the sphere, 3 m away
      CHECK(p.at(2, 4) == dvec3(0, 0, 1));                // the wall before the sky
      CHECK(p.at(36, 24) != dvec3(0, 0, 1));
      CHECK(p.at(62, 4) != dvec3(0, 0, 1));
    }
}

TEST_CASE("host depth out: distances in the host's terms") {
  GlFixture f;
  Host host(*f.device);
  Scene scene;
  place(scene, quad({0, 0, -6}, {30, 0, 0}, {0, 2, 0}), Material{});
  auto renderer = makeRenderer(*f.context, HostState::Save);
  const View view = lookAt({0, 0, 0}, {0, 0, -1});
  double worst = 0;
  for (bool reversed : {false, true})
    for (float far : {100.0f, 0.0f}) {
      host.clear(0, 0, 0, 0.3f);
      Target target = host.asTarget();
      target.depthOut = HostDepth{host.depth.id(), 0.5f, far, reversed};
      REQUIRE(renderer->render(scene, {&view, 1}, target, fixedQuality()));
      const std::vector<float> depth = host.readDepth();
      double d = depth[24 * 64 + 32];
      if (reversed) d = 1 - d;
      const double w = far > 0 ? 0.5 * far / (far - d * (far - 0.5)) : 0.5 / (1 - d);
      worst = std::max(worst, std::abs(w - 6));
      CHECK(depth[32] == (reversed ? 0.0f : 1.0f));  // sky
    }
  std::cout << fmt::format("  host depth of a wall at 6 m: largest error {:.4f} mm\n", worst * 1000);
  CHECK(worst < 0.1e-3);
}

TEST_CASE("several renderers in one context do not disturb each other") {
  GlFixture f;
  Host host(*f.device);
  const Scene scene = sampleScene();
  Scene other = sampleScene();
  other.environment.color = vec3(0, 9, 0);
  auto a = makeRenderer(*f.context, HostState::Save), b = makeRenderer(*f.context, HostState::Declared), c = makeRenderer(*f.context, HostState::DontCare);
  std::vector<Picture> pictures;
  for (Renderer* r : {a.get(), b.get(), c.get(), b.get(), a.get()}) {
    REQUIRE(r->render(other, {&kView, 1}, host.asTarget(), fixedQuality()));
    REQUIRE(r->render(scene, {&kView, 1}, host.asTarget(), fixedQuality()));
    pictures.push_back(host.read());
    if (r == c.get()) c.reset();
  }
  for (const Picture& p : pictures) CHECK(same(p, pictures[0]));
}

TEST_CASE("two threads with contexts of their own render the same picture at once") {
  std::array<Image, 2> images;
  std::array<std::string, 2> errors;
  const Scene scene = sampleScene();
  const auto work = [&](std::size_t i) {
    ContextOptions options;
    options.backend = testBackend();
    auto context = Context::create(options);
    if (!context) return void(errors[i] = context.error().message());
    {
      auto renderer = Renderer::create((*context)->procAddress());
      auto target = OffscreenTarget::create((*context)->procAddress(), {160, 120}, Output::Display);
      if (!renderer || !target) return void(errors[i] = "renderer or target");
      for (int frame = 0; frame < 5; ++frame)
        if (auto done = (*renderer)->render(scene, {&kView, 1}, (*target)->target(), {}); !done) return void(errors[i] = done.error().message());
      if (auto image = (*target)->read()) images[i] = std::move(*image);
    }
    (*context)->release();
  };
  std::thread first(work, 0), second(work, 1);
  first.join();
  second.join();
  CHECK(errors[0] == "");
  CHECK(errors[1] == "");
  CHECK(!images[0].empty());
  CHECK((images[0].data == images[1].data));
}
