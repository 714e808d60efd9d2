// OffscreenTarget: a framebuffer of the engine's own for headless pictures.
#include <burnish/renderer.h>

#include <fmt/format.h>

#include <cstring>

#include "gl/objects.h"

namespace burnish {

struct OffscreenTarget::Impl {
  std::unique_ptr<gl::Device> device;
  gl::Texture color;
  gl::Framebuffer framebuffer;
  glm::ivec2 size{0};
  Output output = Output::Display;
};

OffscreenTarget::OffscreenTarget() : impl_(std::make_unique<Impl>()) {}
OffscreenTarget::~OffscreenTarget() = default;

Result<std::unique_ptr<OffscreenTarget>> OffscreenTarget::create(const ProcAddress& getProcAddress, glm::ivec2 size, Output output) {
  if (size.x <= 0 || size.y <= 0) return fail("target", fmt::format("its size is {} x {} pixels", size.x, size.y), "give it at least 1 x 1");
  std::unique_ptr<OffscreenTarget> target(new OffscreenTarget);
  Impl& m = *target->impl_;
  auto device = gl::Device::create(getProcAddress, false);
  if (!device) return fail(device.error());
  m.device = std::move(*device);
  m.size = size;
  m.output = output;
  auto color = gl::Texture::create(*m.device, {.format = GLenum(output == Output::Linear ? GL_RGBA32F : GL_RGBA8), .width = size.x, .height = size.y}, "picture");
  if (!color) return fail(color.error());
  m.color = std::move(*color);
  const gl::Attachment attachment(m.color);
  auto framebuffer = gl::Framebuffer::create(*m.device, {&attachment, 1}, std::nullopt, "picture");
  if (!framebuffer) return fail(framebuffer.error());
  m.framebuffer = std::move(*framebuffer);
  return target;
}

Target OffscreenTarget::target() const {
  Target t;
  t.framebuffer = impl_->framebuffer.id();
  t.size = impl_->size;
  return t;
}

Result<Image> OffscreenTarget::read() const {
  const Impl& m = *impl_;
  Image raw = makeImage(m.size.x, m.size.y, 4, m.output == Output::Linear ? PixelType::F32 : PixelType::U8);
  gl::PixelStoreScope scope(*m.device);
  m.color.read(0, raw.data);
  // GL's first row is the bottom.
  const std::size_t row = raw.byteSize() / std::size_t(m.size.y);
  Image image = raw;
  for (int y = 0; y < m.size.y; ++y) std::memcpy(image.data.data() + std::size_t(y) * row, raw.data.data() + std::size_t(m.size.y - 1 - y) * row, row);
  return image;
}

}  // namespace burnish
