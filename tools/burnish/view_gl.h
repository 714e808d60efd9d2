// The few GL calls that the viewer makes itself: pictures onto the window, pictures from the CPU, the window's pixels back.
#pragma once
#include <burnish/context.h>
#include <burnish/image.h>
#include <glad/gl.h>

#include <glm/glm.hpp>

namespace cli::viewer {

/// Pixels of the window, from its lower left corner.
struct Rect {
  glm::ivec2 at{0}, size{0};
  [[nodiscard]] bool empty() const { return size.x <= 0 || size.y <= 0; }
};

/// The context's functions. Framebuffer 0 is the window.
class Gl {
 public:
  static burnish::Result<std::unique_ptr<Gl>> load(const burnish::ProcAddress& getProcAddress);
  /// Fills the window with one colour (as displayed, 0..1).
  void clear(glm::ivec2 windowSize, glm::vec3 color) const;
  /// A part of a framebuffer's colour onto the window; where the sizes differ it is filtered if `smooth`.
  void blit(unsigned framebuffer, Rect from, Rect to, bool smooth) const;
  /// What the window will show, before it is presented: U8 RGBA, opaque.
  [[nodiscard]] burnish::Image readWindow(Rect part) const;
  [[nodiscard]] const GladGLContext& table() const { return table_; }

 private:
  GladGLContext table_{};
};

/// A picture that the CPU made, as a framebuffer to blit from.
class Canvas {
 public:
  explicit Canvas(const Gl& gl) : gl_(gl.table()) {}
  ~Canvas() { drop(); }
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  /// U8 RGBA, rows from top to bottom.
  void upload(const burnish::Image& picture);
  [[nodiscard]] unsigned framebuffer() const { return framebuffer_; }
  [[nodiscard]] glm::ivec2 size() const { return size_; }

 private:
  void drop();
  const GladGLContext& gl_;
  unsigned texture_ = 0, framebuffer_ = 0;
  glm::ivec2 size_{0};
};

}  // namespace cli::viewer
