// The recorder itself: known sequences of OpenGL calls, and what it must say of them.
#include "recorder/gl_recorder.h"

#include <burnish/renderer.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "gl/program.h"
#include "gl/timers.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;
using Catch::Matchers::Contains;

namespace {

struct Recorded {
  std::unique_ptr<Context> context = openContext();
  /// A framebuffer that the recorder does not know: an EGL context without a surface has no framebuffer 0.
  std::unique_ptr<OffscreenTarget> host = std::move(*OffscreenTarget::create(context->procAddress(), {1, 1}, Output::Display));
  const GLuint hosts = host->target().framebuffer;
  Recorder recorder{context->procAddress()};
  std::unique_ptr<gl::Device> device = make();
  const GladGLContext& gl = device->gl;
  Ledger& ledger = recorder.ledger();

  std::unique_ptr<gl::Device> make() {
    auto made = gl::Device::create(recorder.procAddress(), false);
    if (!made) FAIL(made.error().message());
    (void)recorder.take();
    return std::move(*made);
  }
  ~Recorded() { CHECK(gl.GetError() == GL_NO_ERROR); }
  gl::Texture texture(const gl::TextureDesc& desc, std::string_view label) {
    auto made = gl::Texture::create(*device, desc, label);
    if (!made) FAIL(made.error().message());
    return std::move(*made);
  }
  gl::Framebuffer framebuffer(std::vector<gl::Attachment> colors, std::optional<gl::Attachment> depth, std::string_view label) {
    auto made = gl::Framebuffer::create(*device, colors, depth, label);
    if (!made) FAIL(made.error().message());
    return std::move(*made);
  }
};

constexpr gl::EmbeddedShader kFiles[] = {
    {"full.vert", "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }\n"},
    {"two.frag",
     "layout(binding = 1) uniform sampler2D one; layout(binding = 3) uniform sampler2D three; layout(binding = 4) uniform sampler2D unread;\n"
     "layout(location = 0) out vec4 color;\nvoid main() { color = texelFetch(one, ivec2(0), 0) + texelFetch(three, ivec2(0), 0); }\n"},
};

std::vector<std::string> names(const Ledger& ledger, const std::vector<Touched>& touched) {
  std::vector<std::string> list;
  for (const Touched& t : touched) {
    const GlObject* o = ledger.find(t.kind, t.id);
    list.push_back(o ? o->label : "host");
  }
  std::sort(list.begin(), list.end());
  return list;
}
using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("recorder: every function that glad loads goes through a shim of its own") {
  const auto context = openContext();
  const ProcAddress real = context->procAddress();
  Recorder recorder(real);
  const ProcAddress recorded = recorder.procAddress();
  std::size_t there = 0;
  std::vector<void*> shims;
  for (const char* name : kFunctionNames) {
    const std::string full = std::string("gl") + name;
    void *const a = real(full.c_str()), *const b = recorded(full.c_str());
    if ((a != nullptr) != (b != nullptr) || (a && a == b)) FAIL_CHECK(full);
    there += b != nullptr;
    if (b) shims.push_back(b);
  }
  std::sort(shims.begin(), shims.end());
  CHECK(std::unique(shims.begin(), shims.end()) == shims.end());
  CHECK(there > 600);
  CHECK(recorded("glNoSuchFunction") == nullptr);
  CHECK(recorded("eglGetError") == nullptr);
}

TEST_CASE("recorder: calls in order, with arguments by value and the debug group") {
  Recorded r;
  r.gl.Viewport(1, 2, 30, 40);
  r.gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, 5, "outer");
  r.gl.LineWidth(1.5f);
  r.gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, "inner");
  r.gl.DepthRange(0.25, 0.75);
  r.gl.PopDebugGroup();
  const GLfloat color[4] = {0, 0.5f, 0, 1};
  r.gl.ClearNamedFramebufferfv(r.hosts, GL_COLOR, 0, color);
  r.gl.PopDebugGroup();
  r.gl.Finish();
  const Recording recording = r.recorder.take();
  Names lines;
  for (std::size_t i = 0; i < recording.calls.size(); ++i) lines.push_back(recording.text(i));
  CHECK(lines == Names{"Viewport(1, 2, 30, 40)  []", "PushDebugGroup(0x824a, 0, 5, pointer)  []", "LineWidth(1.5)  [outer]", "PushDebugGroup(0x824a, 0, -1, pointer)  [outer]",
                       "DepthRange(0.25, 0.75)  [outer/inner]", "PopDebugGroup()  [outer/inner]", "ClearNamedFramebufferfv(1, 0x1800, 0, pointer, *0, *3f000000, *0, *3f800000)  [outer]",
                       "PopDebugGroup()  [outer]", "Finish()  []"});
  CHECK(recording.countIn("outer") == 4);
  CHECK(recording.count(Function::PopDebugGroup) == 2);
  CHECK(r.ledger.groupDepth() == 0);
  CHECK(r.recorder.take().calls.empty());
  r.gl.PopDebugGroup();
  CHECK(r.ledger.unbalancedPops() == 1);
  CHECK(r.gl.GetError() == GL_STACK_UNDERFLOW);
}

TEST_CASE("recorder: sequences are compared by function, argument, note and group") {
  Recorded r;
  const auto sequence = [&](int units, float first, bool grouped) {
    (void)r.recorder.take();
    const GLuint none[4] = {};
    if (grouped) r.device->pushGroup("pass");
    r.gl.Enable(GL_DEPTH_TEST);
    r.gl.BindSamplers(0, units, none);
    if (grouped) r.device->popGroup();
    const GLfloat color[4] = {first, 0, 0, 0};
    r.gl.ClearNamedFramebufferfv(r.hosts, GL_COLOR, 0, color);
    return r.recorder.take();
  };
  const Recording a = sequence(4, 0, true);
  CHECK(!difference(a, sequence(4, 0, true)));
  CHECK(difference(a, sequence(3, 0, true)).has_value());
  CHECK_THAT(difference(a, sequence(4, 1, true)).value_or(""), Contains("ClearNamedFramebufferfv") && Contains("5 against 5 calls; they part at call 4"));
  CHECK(difference(a, sequence(4, 0, false)).has_value());
}

TEST_CASE("recorder: storage of every format, by the driver's word, is what the engine books") {
  Recorded r;
  std::int64_t sum = 0;
  std::vector<gl::Texture> kept;
  for (const gl::FormatInfo& f : gl::formats()) {
    INFO(f.name);
    for (const auto& [target, layers] : {std::pair<GLenum, int>{GL_TEXTURE_2D, 1}, {GL_TEXTURE_2D_ARRAY, 5}, {GL_TEXTURE_CUBE_MAP, 1}}) {
      if (f.format == GL_RGB32F && target != GL_TEXTURE_2D) continue;
      kept.push_back(r.texture({.target = target, .format = f.format, .width = 20, .height = 20, .layers = layers, .levels = 3}, "t"));
      const std::int64_t texels = 20 * 20 + 10 * 10 + 5 * 5, copies = target == GL_TEXTURE_2D ? 1 : target == GL_TEXTURE_2D_ARRAY ? 5 : 6;
      // A driver may keep what RGB32F asks for in four channels.
      const std::int64_t booked = r.ledger.find(ObjectKind::Texture, kept.back().id())->bytes;
      if (f.format == GL_RGB32F)
        CHECK((booked == texels * 12 || booked == texels * 16));
      else
        CHECK(booked == texels * copies * f.bytes);
      sum += booked;
    }
  }
  CHECK(r.ledger.bytes() == sum);
  CHECK(r.ledger.count(ObjectKind::Texture) == kept.size());
  auto buffer = gl::Buffer::create(*r.device, gl::BufferUse::Stream, 100, nullptr, "stream");
  REQUIRE(buffer);
  const std::vector<std::byte> data(1000);
  REQUIRE(buffer->write(data));
  CHECK(r.ledger.bytes(ObjectKind::Buffer) == 1000);
  CHECK(r.device->bufferBytes() == 1000);
  *buffer = {};
  kept.clear();
  CHECK(r.ledger.bytes() == 0);
  CHECK(r.ledger.alive().empty());
  CHECK(r.ledger.created() == r.ledger.deleted());
}

TEST_CASE("recorder: objects of every kind, with labels, and what is deleted that was not there") {
  Recorded r;
  {
    const gl::Texture t = r.texture({.format = GL_RGBA8, .width = 4, .height = 2}, "color");
    const gl::Framebuffer f = r.framebuffer({gl::Attachment(t)}, std::nullopt, "canvas");
    const gl::VertexArray v = gl::VertexArray::create(*r.device, {}, {}, 0, "nothing");
    const gl::Sampler s = gl::Sampler::create(*r.device, {}, "sharp");
    const gl::Query q = gl::Query::create(*r.device, GL_TIMESTAMP, "when");
    auto b = gl::TextureBuffer::create(*r.device, GL_R32UI, gl::BufferUse::Static, 0, nullptr, "list");
    REQUIRE(b);
    gl::ProgramCache programs(*r.device, gl::ShaderLibrary({}, kFiles));
    REQUIRE(programs.get({"both", "full.vert", "two.frag", "", {}}));
    GLsync sync = r.gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    CHECK(r.ledger.inventory() == Names{"buffer 'list' 4 bytes", "framebuffer 'canvas' 0 bytes", "program 'both' 0 bytes", "query 'when' 0 bytes", "sampler 'sharp' 0 bytes", "sync '' 0 bytes",
                                        "texture 'color' 32 bytes", "texture 'list' 0 bytes", "vertex array 'nothing' 0 bytes"});
    r.gl.DeleteSync(sync);
  }
  CHECK(r.ledger.inventory() == Names{});
  CHECK(r.ledger.strangeDeletions() == 0);
  const GLuint nobody[2] = {0, 4711};
  r.gl.DeleteTextures(2, nobody);
  CHECK(r.ledger.strangeDeletions() == 1);
  GLuint old = 0;
  r.gl.GenTextures(1, &old);
  CHECK(r.ledger.count(ObjectKind::Texture) == 1);
  r.gl.DeleteTextures(1, &old);
  CHECK(r.ledger.alive().empty());
  CHECK(r.ledger.unmodelled == std::set<std::string>{});
}

TEST_CASE("recorder: what matters and is not modelled is named") {
  Recorded r;
  GLuint pipeline = 0, texture = 0;
  r.gl.GenProgramPipelines(1, &pipeline);
  r.gl.DeleteProgramPipelines(1, &pipeline);
  r.gl.GenTextures(1, &texture);
  r.gl.BindTexture(GL_TEXTURE_2D, texture);
  r.gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  r.gl.DeleteTextures(1, &texture);
  CHECK(r.ledger.unmodelled == std::set<std::string>{"GenProgramPipelines", "DeleteProgramPipelines", "TexImage2D"});
}

TEST_CASE("recorder: what a draw writes and samples, and bindings that nothing uses") {
  Recorded r;
  const gl::Texture a = r.texture({}, "a"), b = r.texture({}, "b"), c = r.texture({}, "c"), d = r.texture({}, "d"), depth = r.texture({.format = GL_DEPTH_COMPONENT32F}, "depth");
  const gl::Texture cube = r.texture({.target = GL_TEXTURE_CUBE_MAP}, "cube");
  const gl::Framebuffer canvas = r.framebuffer({gl::Attachment(d), gl::Attachment(c)}, gl::Attachment(depth), "canvas");
  gl::ProgramCache programs(*r.device, gl::ShaderLibrary({}, kFiles));
  const auto program = programs.get({"both", "full.vert", "two.frag", "", {}});
  REQUIRE(program);
  const gl::VertexArray none = gl::VertexArray::create(*r.device, {}, {}, 0, "none");
  r.ledger.forgetWork();
  r.device->pushGroup("pass");
  canvas.bind();
  (*program)->use();
  none.bind();
  a.bind(1);     // replaced before it is used
  b.bind(1);     // used
  cube.bind(1);  // of another target: takes nothing's place, and nothing samples it
  a.bind(2);     // nothing samples this unit
  const GLuint batch[2] = {a.id(), c.id()};
  r.gl.BindTextures(3, 2, batch);  // 3 is used; 4 belongs to a sampler that the linker took out
  r.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  r.device->popGroup();
  const float black[4] = {}, far = 0;
  r.gl.ClearNamedFramebufferfv(canvas.id(), GL_COLOR, 1, black);
  r.gl.ClearNamedFramebufferfv(canvas.id(), GL_DEPTH, 0, &far);
  r.gl.Clear(GL_COLOR_BUFFER_BIT);
  r.gl.BlitNamedFramebuffer(canvas.id(), r.hosts, 0, 0, 1, 1, 0, 0, 1, 1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  const std::vector<Work>& work = r.ledger.work();
  REQUIRE(work.size() == 5);
  CHECK(work[0].kind == Work::Kind::Draw);
  CHECK(work[0].group == "pass");
  CHECK(names(r.ledger, work[0].writes) == Names{"c", "d", "depth"});
  CHECK(names(r.ledger, work[0].reads) == Names{"a", "b"});
  CHECK(work[1].kind == Work::Kind::Clear);
  CHECK(work[1].group.empty());
  CHECK(names(r.ledger, work[1].writes) == Names{"c"});
  CHECK(names(r.ledger, work[2].writes) == Names{"depth"});
  CHECK(names(r.ledger, work[3].writes) == Names{"c", "d"});
  CHECK(work[4].kind == Work::Kind::Blit);
  CHECK(names(r.ledger, work[4].reads) == Names{"c", "d"});
  CHECK(names(r.ledger, work[4].writes) == Names{"host"});
  Names used, idle;
  for (const TextureBinding& t : r.ledger.bindings()) (t.used ? used : idle).push_back(fmt::format("{} {}", t.unit, r.ledger.find(ObjectKind::Texture, t.texture)->label));
  CHECK(used == Names{"1 b", "3 a"});
  CHECK(idle == Names{"1 a", "1 cube", "2 a", "4 c"});
}

TEST_CASE("recorder: planted calls are recorded where they are planted") {
  Recorded r;
  const float black[4] = {};
  int planted = 0;
  r.recorder.after([&](Function f) {
    if (f == Function::Finish && planted++ == 0) r.recorder.shim<PFNGLCLEARNAMEDFRAMEBUFFERFVPROC>(Function::ClearNamedFramebufferfv)(r.hosts, GL_COLOR, 0, black);
  });
  r.gl.Finish();
  r.gl.Finish();
  const Recording recording = r.recorder.take();
  CHECK(recording.calls.size() == 3);
  CHECK(recording.text(1).starts_with("ClearNamedFramebufferfv"));
  REQUIRE(r.ledger.work().size() == 1);
}

TEST_CASE("recorder: a renderer's frame is the same with it, and its bytes are the renderer's own figure") {
  Scene scene;
  Material material;
  material.albedo = {0.8f, 0.3f, 0.2f};
  place(scene, sphere(1, 16, 32), material);
  addLight(scene, light(LightKind::Directional, {1, 1, 1}, 10), {}, {-1, -1, -1});
  const View view = lookAt({0, 0, 4}, {0, 0, 0});
  Quality quality;
  quality.exposureEv = 1;
  const auto context = openContext();
  auto target = OffscreenTarget::create(context->procAddress(), {48, 32}, Output::Display);
  REQUIRE(target);
  const auto draw = [&](const ProcAddress& functions) {
    auto renderer = Renderer::create(functions);
    REQUIRE(renderer);
    auto stats = (*renderer)->render(scene, {&view, 1}, (*target)->target(), quality);
    REQUIRE(stats);
    if (functions.target_type() != context->procAddress().target_type()) {
      const Ledger& ledger = Recorder::active().ledger();
      CHECK(ledger.bytes(ObjectKind::Texture) == std::int64_t(stats->textureBytes));
      CHECK(ledger.unmodelled == std::set<std::string>{});
      CHECK(ledger.count(ObjectKind::Program) == (*renderer)->lastPlan().programs.size());
      CHECK(ledger.groupDepth() == 0);
    }
    return (*target)->read()->data;
  };
  const auto plain = draw(context->procAddress());
  Recorder recorder(context->procAddress());
  CHECK((draw(recorder.procAddress()) == plain));
  CHECK(recorder.ledger().inventory() == Names{});
  CHECK(recorder.ledger().strangeDeletions() == 0);
}
