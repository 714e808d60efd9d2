// Programs: errors that name file and line, one compilation for each set of definitions, binaries that survive damage.
#include <fstream>
#include <iterator>

#include "gl/program.h"
#include "gl_fixture.h"
#include "temporary_folder.h"

using namespace burnish;
using namespace burnish::gl;
using burnish::test::GlFixture;
using burnish::test::TemporaryFolder;
using Catch::Matchers::Contains;

namespace {

constexpr EmbeddedShader kFiles[] = {
    {"full.vert",
     "void main() {\n  vec2 p = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);\n  gl_Position = vec4(p, "
     "0, 1);\n}\n"},
    {"value.glsl", "float value() { return VALUE; }\n"},
    {"grey.frag",
     "#include \"value.glsl\"\nlayout(location = 0) out vec4 color;\nvoid main() { color = vec4(value()); }\n"},
    {"broken.glsl", "\n\nfloat wrong() { return undeclared; }\n"},
    {"broken.frag", "#include \"broken.glsl\"\nvoid main() {}\n"},
    {"late.frag",
     "#include \"value.glsl\"\n\nlayout(location = 0) out vec4 color;\nvoid main() { color = nothing; }\n"},
    {"wants.frag",
     "layout(location = 3) in vec4 missing;\nlayout(location = 0) out vec4 color;\nvoid main() { color = missing; }\n"},
    {"fill.comp",
     "layout(local_size_x = 4) in;\nlayout(std430, binding = 0) buffer Out { uint values[]; };\nvoid main() { "
     "values[gl_GlobalInvocationID.x] = gl_GlobalInvocationID.x * 3u; }\n"},
};

ProgramSource grey(const char* value) {
  return {"grey", "full.vert", "grey.frag", "", {std::string("VALUE ") + value}};
}

/// Draws over one texel with a program and reads it: 0..255.
int draw(Device& device, const Program& program) {
  auto texture = Texture::create(device, {GL_TEXTURE_2D, GL_RGBA8, 1, 1}, "target");
  const Attachment color(*texture);
  auto framebuffer = Framebuffer::create(device, {&color, 1}, {}, "target");
  const VertexArray none = VertexArray::create(device, {}, {}, 0, "none");
  REQUIRE(framebuffer);
  framebuffer->bind();
  none.bind();
  program.use();
  device.gl.Viewport(0, 0, 1, 1);
  device.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  device.gl.UseProgram(0);
  std::array<std::byte, 4> texel{};
  texture->read(0, texel);
  return int(texel[0]);
}

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

}  // namespace

TEST_CASE("a program is compiled once for each set of definitions") {
  GlFixture f;
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles));
  auto low = cache.get(grey("0.2"));
  auto high = cache.get(grey("0.8"));
  REQUIRE(low);
  REQUIRE(high);
  CHECK(draw(*f.device, **low) == 51);
  CHECK(draw(*f.device, **high) == 204);
  CHECK(*cache.get(grey("0.2")) == *low);
  CHECK(cache.built() == 2);
  CHECK(cache.loaded() == 0);
  ProgramSource twoDefines = {"a", "full.vert", "grey.frag", "", {"VALUE 1.0", "OTHER 1"}}, swapped = twoDefines;
  std::swap(swapped.defines[0], swapped.defines[1]);
  CHECK(*cache.get(twoDefines) == *cache.get(swapped));
  CHECK(cache.built() == 3);
}

TEST_CASE("warm-up builds what is not there, once") {
  GlFixture f;
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles));
  REQUIRE(cache.get(grey("0.2")));
  const std::vector<ProgramSource> wanted = {grey("0.2"), grey("0.4"), grey("0.6"), grey("0.4")};
  CHECK(cache.warmUp(wanted).value() == 2);
  CHECK(cache.warmUp(wanted).value() == 0);
  CHECK(cache.built() == 3);
  CHECK(draw(*f.device, **cache.get(grey("0.4"))) == 102);
  CHECK(cache.built() == 3);
}

TEST_CASE("a compute program runs") {
  GlFixture f;
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles));
  auto program = cache.get({"fill", "", "", "fill.comp", {}});
  REQUIRE(program);
  auto buffer = Buffer::create(*f.device, BufferUse::Dynamic, 16, nullptr, "out");
  buffer->bindBase(GL_SHADER_STORAGE_BUFFER, 0);
  (*program)->use();
  f.gl.DispatchCompute(1, 1, 1);
  f.gl.MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::array<std::uint32_t, 4> values{};
  f.gl.GetNamedBufferSubData(buffer->id(), 0, 16, values.data());
  CHECK(values == std::array<std::uint32_t, 4>{0, 3, 6, 9});
  f.gl.UseProgram(0);
}

TEST_CASE("errors name program, file and line") {
  GlFixture f;
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles));
  const auto message = [&](const ProgramSource& source) {
    auto made = cache.get(source);
    REQUIRE_FALSE(made);
    return made.error().message();
  };
  CHECK_THAT(message({"in include", "full.vert", "broken.frag", "", {}}),
             Contains("in include") && Contains("broken.glsl:3") && Contains("undeclared"));
  CHECK_THAT(message({"after include", "full.vert", "late.frag", "", {"VALUE 1.0", "MORE 1"}}),
             Contains("late.frag:4") && Contains("nothing"));
  CHECK_THAT(message({"link", "full.vert", "wants.frag", "", {}}), Contains("does not link") && Contains("missing"));
  CHECK_THAT(message({"gone", "full.vert", "gone.frag", "", {}}), Contains("gone.frag"));
  CHECK_THAT(message({"empty", "", "", "", {}}), Contains("empty"));
  CHECK_THAT(message({"both", "full.vert", "", "fill.comp", {}}), Contains("both"));
  CHECK(cache.built() == 0);
  CHECK_FALSE(cache.warmUp(std::vector<ProgramSource>{{"w", "full.vert", "broken.frag", "", {}}}));
  REQUIRE(cache.get(grey("1.0")));  // a failure does not spoil what comes after
}

TEST_CASE("binaries are kept, and damage costs a compilation only") {
  GlFixture f;
  if (!f.device->caps.programBinary) {
    WARN("this driver has no program binary format: " << f.device->caps.renderer);
    REQUIRE(f.device->caps.extensions.size() > 100);  // the test fails where the capability is wrong for another reason
    return;
  }
  const TemporaryFolder folder;
  const std::filesystem::path kept = folder.path / "deep" / "cache";  // made by the cache
  const auto build = [&](int expectBuilt, int expectLoaded) {
    ProgramCache cache(*f.device, ShaderLibrary({}, kFiles), kept);
    auto program = cache.get(grey("0.4"));
    REQUIRE(program);
    CHECK(draw(*f.device, **program) == 102);
    CHECK(cache.built() == expectBuilt);
    CHECK(cache.loaded() == expectLoaded);
  };
  build(1, 0);
  build(0, 1);
  const auto files = filesIn(kept);
  REQUIRE(files.size() == 1);
  std::ifstream in(files[0], std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  const auto replace = [&](const std::string& bytes) {
    std::ofstream(files[0], std::ios::binary | std::ios::trunc) << bytes;
  };
  const std::size_t step = std::max<std::size_t>(1, whole.size() / 40);
  for (std::size_t at = 0; at < whole.size(); at += step) {  // a flipped byte anywhere: head, hash, body
    CAPTURE(at);
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 0x5a);
    replace(damaged);
    // Only the four unused bytes of the head may go unnoticed.
    build(at >= 44 && at < 48 ? 0 : 1, at >= 44 && at < 48 ? 1 : 0);
    build(0, 1);  // and the good file is back
  }
  replace(whole.substr(0, whole.size() / 2));
  build(1, 0);
  replace("");
  build(1, 0);
  // Another text is another key.
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles), kept);
  REQUIRE(cache.get(grey("0.6")));
  CHECK(cache.built() == 1);
  CHECK(filesIn(kept).size() == 2);
}

TEST_CASE("a binary folder that cannot be written is no error") {
  GlFixture f;
  const TemporaryFolder folder;
  std::ofstream(folder.path / "file") << "x";
  ProgramCache cache(*f.device, ShaderLibrary({}, kFiles), folder.path / "file" / "below");
  REQUIRE(cache.get(grey("0.4")));
  CHECK(cache.built() == 1);
}

TEST_CASE("live editing: reload takes what changed and keeps what is broken") {
  GlFixture f;
  const TemporaryFolder folder;
  ProgramCache cache(*f.device, ShaderLibrary(folder.path, kFiles));
  const Program* program = *cache.get(grey("0.4"));
  CHECK(cache.reload().value() == 0);
  std::ofstream(folder.path / "value.glsl") << "float value() { return 2.0 * VALUE; }\n";
  CHECK(cache.reload().value() == 1);
  CHECK(draw(*f.device, *program) == 204);
  std::ofstream(folder.path / "value.glsl", std::ios::trunc) << "float value() { return oops; }\n";
  auto broken = cache.reload();
  REQUIRE_FALSE(broken);
  CHECK_THAT(broken.error().message(), Contains("value.glsl:1") && Contains("oops"));
  CHECK(draw(*f.device, *program) == 204);
}
