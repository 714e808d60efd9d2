#include "view_gl.h"

#include <cstring>

namespace cli::viewer {
using burnish::Image;
using burnish::ProcAddress;
using burnish::Result;

namespace {

GLADapiproc addressOf(void* userData, const char* name) { return reinterpret_cast<GLADapiproc>((*static_cast<const ProcAddress*>(userData))(name)); }

/// GL's rows run from bottom to top, Image's from top to bottom.
Image flipped(const Image& picture) {
  Image out = burnish::makeImage(picture.width, picture.height, picture.channels, picture.type);
  const std::size_t row = picture.height > 0 ? picture.byteSize() / std::size_t(picture.height) : 0;
  for (int y = 0; y < picture.height; ++y) std::memcpy(out.data.data() + std::size_t(y) * row, picture.data.data() + std::size_t(picture.height - 1 - y) * row, row);
  return out;
}

}  // namespace

Result<std::unique_ptr<Gl>> Gl::load(const ProcAddress& getProcAddress) {
  auto gl = std::make_unique<Gl>();
  ProcAddress address = getProcAddress;
  if (gladLoadGLContextUserPtr(&gl->table_, addressOf, &address) == 0) return burnish::fail("OpenGL", "its functions cannot be loaded", "install a newer driver");
  return gl;
}

void Gl::clear(glm::ivec2 windowSize, glm::vec3 color) const {
  table_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  table_.Viewport(0, 0, windowSize.x, windowSize.y);
  table_.ClearColor(color.r, color.g, color.b, 1);
  table_.Clear(GL_COLOR_BUFFER_BIT);
}

void Gl::blit(unsigned framebuffer, Rect from, Rect to, bool smooth) const {
  if (from.empty() || to.empty()) return;
  table_.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  table_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  const glm::ivec2 a = from.at, b = from.at + from.size, c = to.at, d = to.at + to.size;
  table_.BlitFramebuffer(a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y, GL_COLOR_BUFFER_BIT, smooth ? GL_LINEAR : GL_NEAREST);
  table_.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

Image Gl::readWindow(Rect part) const {
  Image picture = burnish::makeImage(part.size.x, part.size.y, 4, burnish::PixelType::U8);
  table_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  table_.ReadBuffer(GL_BACK);
  table_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  table_.ReadPixels(part.at.x, part.at.y, part.size.x, part.size.y, GL_RGBA, GL_UNSIGNED_BYTE, picture.data.data());
  table_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  for (std::size_t i = 3; i < picture.byteSize(); i += 4) picture.u8()[i] = 255;  // a window's alpha means nothing
  return flipped(picture);
}

void Canvas::upload(const Image& picture) {
  const glm::ivec2 size(picture.width, picture.height);
  if (size != size_) {
    drop();
    size_ = size;
    gl_.CreateTextures(GL_TEXTURE_2D, 1, &texture_);
    gl_.TextureStorage2D(texture_, 1, GL_RGBA8, size.x, size.y);
    gl_.CreateFramebuffers(1, &framebuffer_);
    gl_.NamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture_, 0);
  }
  gl_.TextureSubImage2D(texture_, 0, 0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, flipped(picture).data.data());
}

void Canvas::drop() {
  if (framebuffer_ != 0) gl_.DeleteFramebuffers(1, &framebuffer_);
  if (texture_ != 0) gl_.DeleteTextures(1, &texture_);
  framebuffer_ = texture_ = 0;
  size_ = glm::ivec2(0);
}

}  // namespace cli::viewer
