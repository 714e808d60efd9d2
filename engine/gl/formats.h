// The sized texture formats that the engine uses: what one texel costs, and how it travels to and from memory.
#pragma once
#include <glad/gl.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace burnish::gl {

struct FormatInfo {
  GLenum format = 0;      ///< GL_RGBA16F
  std::string_view name;  ///< "RGBA16F", as FramePlan spells it
  int bytes = 0;          ///< per texel as stored
  GLenum external = 0;    ///< format of an upload or read that needs no conversion: GL_RGBA
  GLenum type = 0;        ///< its type: GL_HALF_FLOAT
  [[nodiscard]] bool depth() const { return external == GL_DEPTH_COMPONENT || external == GL_DEPTH_STENCIL; }
  [[nodiscard]] bool stencil() const { return external == GL_DEPTH_STENCIL; }
};
std::span<const FormatInfo> formats();
/// nullptr when the engine does not know the format.
const FormatInfo* formatInfo(GLenum format);
const FormatInfo* formatInfo(std::string_view name);
/// Bytes of a whole texture with `levels` mip levels; layers counts array layers (and 6 for a cube).
std::int64_t textureBytes(const FormatInfo& info, int width, int height, int layers, int levels);
/// Levels of a complete mip chain down to 1x1.
int fullMipLevels(int width, int height);

}  // namespace burnish::gl
