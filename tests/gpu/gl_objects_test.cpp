// Objects: contents arrive, sizes are booked, faults are errors, nothing is left behind.
#include <numeric>

#include "gl/objects.h"
#include "gl_fixture.h"

using namespace burnish;
using namespace burnish::gl;
using burnish::test::GlFixture;
using Catch::Matchers::Contains;

namespace {

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& v) {
  return std::as_bytes(std::span(v));
}

}  // namespace

TEST_CASE("formats: sizes agree with what the driver stores") {
  GlFixture f;
  for (const FormatInfo& info : formats()) {
    CAPTURE(info.name);
    CHECK(formatInfo(info.format) == &info);
    CHECK(formatInfo(info.name) == &info);
    if (info.format == GL_RGB32F) continue;  // buffer textures only
    auto made = Texture::create(*f.device, {GL_TEXTURE_2D, info.format, 4, 4}, info.name);
    REQUIRE(made);
    int bits = 0;
    for (const GLenum part : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE,
                              GL_TEXTURE_DEPTH_SIZE, GL_TEXTURE_STENCIL_SIZE, GL_TEXTURE_SHARED_SIZE}) {
      GLint size = 0;
      f.gl.GetTextureLevelParameteriv(made->id(), 0, part, &size);
      bits += size;
    }
    CHECK(bits <= info.bytes * 8);
    CHECK(bits > info.bytes * 4);
    std::vector<std::byte> pixels(16 * std::size_t(info.bytes), std::byte{1});
    made->upload(0, pixels.data());
    std::vector<std::byte> back(pixels.size());
    made->read(0, back);
    if (!info.depth() && info.format != GL_RGB9_E5) CHECK(back == pixels);
  }
  CHECK(formatInfo(GLenum(0)) == nullptr);
  CHECK(formatInfo("RGBA17") == nullptr);
  CHECK(fullMipLevels(1, 1) == 1);
  CHECK(fullMipLevels(1024, 3) == 11);
  CHECK(textureBytes(*formatInfo("RGBA8"), 4, 2, 6, 3) == (8 + 2 + 1) * 6 * 4);
}

TEST_CASE("textures: odd widths, rectangles, levels, mips, layers, faces") {
  GlFixture f;
  auto t = Texture::create(*f.device, {GL_TEXTURE_2D, GL_R8, 5, 3, 1, 0}, "odd");
  REQUIRE(t);
  CHECK(t->levels == 3);
  CHECK(t->bytes == 15 + 2 + 1);
  CHECK(f.device->textureBytes() == t->bytes);
  std::vector<std::uint8_t> pixels(15);
  std::iota(pixels.begin(), pixels.end(), std::uint8_t(10));
  t->upload(0, pixels.data());
  const std::uint8_t patch[2] = {200, 201};
  t->uploadRect(0, 3, 2, 2, 1, patch);
  std::vector<std::byte> back(15);
  t->read(0, back);
  CHECK(int(back[0]) == 10);
  CHECK(int(back[7]) == 17);
  CHECK(int(back[13]) == 200);
  CHECK(int(back[14]) == 201);
  t->clear({1, 0, 0, 0});
  t->generateMips();
  std::vector<std::byte> top(1);
  t->read(2, top);
  CHECK(int(top[0]) == 255);

  auto cube = Texture::create(*f.device, {GL_TEXTURE_CUBE_MAP, GL_R8, 2, 2, 1, 1}, "cube");
  auto array = Texture::create(*f.device, {GL_TEXTURE_2D_ARRAY, GL_R8, 2, 2, 3, 1}, "array");
  REQUIRE(cube);
  REQUIRE(array);
  CHECK(cube->bytes == 24);
  CHECK(array->bytes == 12);
  const std::uint8_t face[4] = {1, 2, 3, 4};
  cube->clear();
  cube->upload(0, face, 5);
  array->clear();
  array->upload(0, face, 2);
  std::vector<std::byte> faces(24), layers(12);
  cube->read(0, faces);
  array->read(0, layers);
  CHECK(int(faces[19]) == 0);
  CHECK(int(faces[23]) == 4);
  CHECK(int(layers[8]) == 1);

  auto depth = Texture::create(*f.device, {GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, 1, 1}, "depth");
  depth->clear({0.25f, 0, 0, 0});
  float d = 0;
  depth->read(0, std::as_writable_bytes(std::span(&d, 1)));
  CHECK(d == 0.25f);
}

TEST_CASE("textures that cannot be are errors") {
  GlFixture f;
  const int most = f.device->caps.maxTextureSize;
  CHECK_THAT(Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA8, most + 1, 1}, "wide").error().message(),
             Contains("wide") && Contains(std::to_string(most)));
  CHECK_FALSE(Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA8, 0, 1}, "none"));
  CHECK_FALSE(Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA4, 1, 1}, "format"));
  CHECK_FALSE(Texture::create(*f.device, {GL_TEXTURE_CUBE_MAP, GL_RGBA8, 2, 1}, "oblong"));
  CHECK(f.device->bytesAllocated() == 0);
}

TEST_CASE("buffers: static, dynamic, stream, texture buffer") {
  GlFixture f;
  const std::vector<std::uint32_t> data = {1, 2, 3, 4};
  std::vector<std::uint32_t> back(4);
  const auto read = [&](const Buffer& b) {
    f.gl.GetNamedBufferSubData(b.id(), 0, 16, back.data());
    return back;
  };
  auto fixed = Buffer::create(*f.device, BufferUse::Static, std::span<const std::uint32_t>(data), "fixed");
  REQUIRE(fixed);
  CHECK(read(*fixed) == data);
  CHECK(f.device->bufferBytes() == 16);
  auto dynamic = Buffer::create(*f.device, BufferUse::Dynamic, 16, nullptr, "dynamic");
  dynamic->subData(0, bytesOf(data));
  dynamic->subData(4, bytesOf(std::vector<std::uint32_t>{9}));
  CHECK(read(*dynamic) == std::vector<std::uint32_t>{1, 9, 3, 4});
  auto stream = Buffer::create(*f.device, BufferUse::Stream, 8, nullptr, "stream");
  REQUIRE(stream->write(bytesOf(data)));
  CHECK(stream->size() >= 16);
  CHECK(read(*stream) == data);
  CHECK(f.device->bufferBytes() == std::int64_t(32 + stream->size()));
  auto empty = Buffer::create(*f.device, BufferUse::Static, 0, nullptr, "empty");
  REQUIRE(empty);
  empty->bindBase(GL_UNIFORM_BUFFER, 0);
  const std::uint16_t small = 0xabcd;
  auto tiny = Buffer::create(*f.device, BufferUse::Static, 2, &small, "tiny");
  std::uint16_t got = 0;
  f.gl.GetNamedBufferSubData(tiny->id(), 0, 2, &got);
  CHECK(got == small);

  auto texels = TextureBuffer::create(*f.device, GL_R32UI, BufferUse::Stream, 0, nullptr, "texels");
  REQUIRE(texels);
  REQUIRE(texels->write(bytesOf(data)));
  CHECK(read(texels->buffer()) == data);
  GLint width = 0;
  f.gl.GetTextureLevelParameteriv(texels->id(), 0, GL_TEXTURE_WIDTH, &width);
  CHECK(width >= 4);
  const std::size_t tooMuch = std::size_t(f.device->caps.maxTextureBufferTexels) * 4 + 4;
  CHECK_FALSE(TextureBuffer::create(*f.device, GL_R32UI, BufferUse::Static, tooMuch, data.data(), "huge"));
}

TEST_CASE("framebuffers say why they are incomplete") {
  GlFixture f;
  CHECK_THAT(Framebuffer::create(*f.device, {}, {}, "nothing").error().message(),
             Contains("nothing") && Contains("no attachment"));
  auto color = Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA8, 4, 4}, "c");
  auto depth = Texture::create(*f.device, {GL_TEXTURE_2D, GL_DEPTH32F_STENCIL8, 4, 4}, "d");
  const Attachment colors[] = {*color, *color};
  CHECK(Framebuffer::create(*f.device, {colors, 1}, Attachment(*depth), "good"));
  CHECK(Framebuffer::create(*f.device, {}, Attachment(*depth), "depth only"));
  const Attachment wrong[] = {*depth};
  CHECK_FALSE(Framebuffer::create(*f.device, wrong, {}, "depth as colour"));
}

TEST_CASE("nothing is left when the objects are gone") {
  GlFixture f;
  std::array<GLuint, 7> ids{};
  const auto alive = [&] {
    return f.gl.IsTexture(ids[0]) + f.gl.IsBuffer(ids[1]) + f.gl.IsTexture(ids[2]) + f.gl.IsFramebuffer(ids[3]) +
           f.gl.IsVertexArray(ids[4]) + f.gl.IsSampler(ids[5]) + f.gl.IsQuery(ids[6]);
  };
  {
    auto texture = Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA8, 4, 4}, "t");
    auto buffer = Buffer::create(*f.device, BufferUse::Dynamic, 64, nullptr, "b");
    auto texels = TextureBuffer::create(*f.device, GL_RGBA32F, BufferUse::Dynamic, 64, nullptr, "tb");
    const Attachment color(*texture);
    auto framebuffer = Framebuffer::create(*f.device, {&color, 1}, {}, "f");
    const VertexAttribute attributes[] = {{0, 3, GL_FLOAT, false, false, 0, 0},
                                          {1, 2, GL_UNSIGNED_SHORT, true, false, 12, 0},
                                          {2, 1, GL_UNSIGNED_INT, false, true, 0, 1}};
    const VertexBinding vertexBindings[] = {{buffer->id(), 0, 16, 0}, {buffer->id(), 0, 4, 1}};
    VertexArray array = VertexArray::create(*f.device, attributes, vertexBindings, buffer->id(), "v");
    Sampler sampler =
        Sampler::create(*f.device, {GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_REPEAT, GL_REPEAT, GL_REPEAT, 8}, "s");
    Query query = Query::create(*f.device, GL_TIMESTAMP, "q");
    ids = {texture->id(), buffer->id(), texels->id(), framebuffer->id(), array.id(), sampler.id(), query.id()};
    CHECK(alive() == 7);
    Texture moved = std::move(*texture);
    CHECK(texture->id() == 0);
    CHECK(moved.id() == ids[0]);
    moved = std::move(moved);  // to itself: nothing happens
    CHECK(alive() == 7);
    CHECK(f.device->bytesAllocated() == 64 + 64 + 64);
    std::array<char, 16> label{};
    f.gl.GetObjectLabel(GL_SAMPLER, sampler.id(), 16, nullptr, label.data());
    CHECK(std::string(label.data()) == "s");
  }
  CHECK(alive() == 0);
  CHECK(f.device->bytesAllocated() == 0);
}

TEST_CASE("GL errors are collected, with and without debug output") {
  auto context = burnish::test::openContext();
  for (const bool debug : {true, false}) {
    CAPTURE(debug);
    auto device = Device::create(context->procAddress(), debug);
    REQUIRE(device);
    CHECK((*device)->takeErrors().empty());
    (*device)->gl.BindTextureUnit(0, 123456);
    CHECK_FALSE((*device)->takeErrors().empty());
    CHECK((*device)->takeErrors().empty());
  }
}

TEST_CASE("a host's debug callback goes on hearing, and comes back") {
  auto context = burnish::test::openContext();
  auto host = Device::create(context->procAddress(), false);
  int heard = 0;
  const auto listen = [](GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar*, const void* user) {
    ++*static_cast<int*>(const_cast<void*>(user));
  };
  const GladGLContext& gl = (*host)->gl;
  gl.Enable(GL_DEBUG_OUTPUT);
  gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  gl.DebugMessageCallback(listen, &heard);
  {
    auto engine = Device::create(context->procAddress(), true);
    gl.BindTextureUnit(0, 123456);
    CHECK(heard == 1);
    CHECK_FALSE((*engine)->takeErrors().empty());
  }
  gl.BindTextureUnit(0, 123456);
  CHECK(heard == 2);
  CHECK(gl.IsEnabled(GL_DEBUG_OUTPUT));
}

TEST_CASE("pixel store of the host survives an upload in between") {
  GlFixture f;
  f.gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 17);
  f.gl.PixelStorei(GL_PACK_SKIP_ROWS, 3);
  f.gl.PixelStorei(GL_UNPACK_ALIGNMENT, 8);
  {
    const PixelStoreScope scope(*f.device);
    auto t = Texture::create(*f.device, {GL_TEXTURE_2D, GL_R8, 3, 2}, "t");
    const std::uint8_t pixels[6] = {1, 2, 3, 4, 5, 6};
    t->upload(0, pixels);
    std::array<std::byte, 6> back{};
    t->read(0, back);
    CHECK(int(back[5]) == 6);
  }
  GLint row = 0, skip = 0, alignment = 0;
  f.gl.GetIntegerv(GL_UNPACK_ROW_LENGTH, &row);
  f.gl.GetIntegerv(GL_PACK_SKIP_ROWS, &skip);
  f.gl.GetIntegerv(GL_UNPACK_ALIGNMENT, &alignment);
  CHECK(row == 17);
  CHECK(skip == 3);
  CHECK(alignment == 8);
}
