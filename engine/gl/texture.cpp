#include <fmt/format.h>

#include <algorithm>

#include "gl/objects.h"

namespace burnish::gl {
namespace {

bool isCube(GLenum target) { return target == GL_TEXTURE_CUBE_MAP; }
bool isArray(GLenum target) { return target == GL_TEXTURE_2D_ARRAY || target == GL_TEXTURE_CUBE_MAP_ARRAY; }

}  // namespace

Result<Texture> Texture::create(Device& device, const TextureDesc& desc, std::string_view label) {
  const std::string place = fmt::format("texture \"{}\"", label);
  const FormatInfo* info = formatInfo(desc.format);
  if (!info)
    return fail(place, fmt::format("format {:#x} is not in the engine's list", desc.format),
                "add it to engine/gl/formats.cpp");
  const int most = device.caps.maxTextureSize;
  if (desc.width < 1 || desc.height < 1 || desc.width > most || desc.height > most)
    return fail(place, fmt::format("{}x{} texels; this device has 1 to {} a side", desc.width, desc.height, most),
                "make the picture or window smaller");
  if (isCube(desc.target) && desc.width != desc.height)
    return fail(place, fmt::format("a cube of {}x{} texels", desc.width, desc.height), "make it square");
  const GladGLContext& gl = device.gl;
  Texture made;
  made.target = desc.target;
  made.format = desc.format;
  made.width = desc.width;
  made.height = desc.height;
  made.layers = isArray(desc.target) ? desc.layers : 1;
  made.levels = desc.levels > 0 ? std::min(desc.levels, fullMipLevels(desc.width, desc.height))
                                : fullMipLevels(desc.width, desc.height);
  made.bytes = textureBytes(*info, made.width, made.height, isCube(desc.target) ? 6 : made.layers, made.levels);
  GLuint id = 0;
  gl.CreateTextures(desc.target, 1, &id);
  made.handle_ = Handle(device, Handle::Kind::Texture, id);
  if (isArray(desc.target))
    gl.TextureStorage3D(id, made.levels, desc.format, made.width, made.height, made.layers);
  else
    gl.TextureStorage2D(id, made.levels, desc.format, made.width, made.height);
  if (device.ranOutOfMemory())
    return fail(place,
                fmt::format("no memory for {} MiB ({}x{} {})", made.bytes >> 20, made.width, made.height, info->name),
                "use fewer or smaller textures, or a smaller picture");
  made.handle_.setBytes(made.bytes);
  made.setFilter(made.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST, GL_NEAREST);
  made.setWrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
  device.label(GL_TEXTURE, id, label);
  return made;
}

void Texture::upload(int level, const void* pixels, int layer, GLenum external, GLenum type) {
  uploadRect(level, 0, 0, std::max(1, width >> level), std::max(1, height >> level), pixels, layer, external, type);
}

void Texture::uploadRect(int level, int x, int y, int w, int h, const void* pixels, int layer, GLenum external,
                         GLenum type) {
  const FormatInfo& info = *formatInfo(format);
  if (!external) {
    external = info.external;
    type = info.type;
  }
  const GladGLContext& gl = handle_.device().gl;
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (isCube(target) || isArray(target))
    gl.TextureSubImage3D(id(), level, x, y, layer, w, h, 1, external, type, pixels);
  else
    gl.TextureSubImage2D(id(), level, x, y, w, h, external, type, pixels);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void Texture::read(int level, std::span<std::byte> out, GLenum external, GLenum type) const {
  const FormatInfo& info = *formatInfo(format);
  const GladGLContext& gl = handle_.device().gl;
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.GetTextureImage(id(), level, external ? external : info.external, external ? type : info.type, GLsizei(out.size()),
                     out.data());
  gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
}

void Texture::generateMips() { handle_.device().gl.GenerateTextureMipmap(id()); }

void Texture::clear(const std::array<float, 4>& value) {
  const FormatInfo& info = *formatInfo(format);
  const GladGLContext& gl = handle_.device().gl;
  for (int level = 0; level < levels; ++level) {
    switch (info.external) {
      case GL_DEPTH_STENCIL: {
        // No clear takes depth as float and stencil for both depth-stencil formats; the packed pair does.
        const struct {
          float depth;
          std::uint32_t stencil;
        } pair{value[0], std::uint32_t(value[1])};
        gl.ClearTexImage(id(), level, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, &pair);
        break;
      }
      case GL_DEPTH_COMPONENT:
        gl.ClearTexImage(id(), level, GL_DEPTH_COMPONENT, GL_FLOAT, value.data());
        break;
      case GL_RED_INTEGER:
      case GL_RG_INTEGER:
      case GL_RGBA_INTEGER: {
        const std::array<GLint, 4> integers{GLint(value[0]), GLint(value[1]), GLint(value[2]), GLint(value[3])};
        gl.ClearTexImage(id(), level, GL_RGBA_INTEGER, GL_INT, integers.data());
        break;
      }
      default:
        gl.ClearTexImage(id(), level, GL_RGBA, GL_FLOAT, value.data());
    }
  }
}

void Texture::setFilter(GLenum minFilter, GLenum magFilter) {
  setParameter(GL_TEXTURE_MIN_FILTER, GLint(minFilter));
  setParameter(GL_TEXTURE_MAG_FILTER, GLint(magFilter));
}

void Texture::setWrap(GLenum s, GLenum t) {
  setParameter(GL_TEXTURE_WRAP_S, GLint(s));
  setParameter(GL_TEXTURE_WRAP_T, GLint(t));
}

void Texture::setAnisotropy(float ratio) {
  const Device& device = handle_.device();
  if (!device.caps.anisotropic) return;
  GLfloat most = 1;
  device.gl.GetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
  device.gl.TextureParameterf(id(), GL_TEXTURE_MAX_ANISOTROPY_EXT, std::clamp(ratio, 1.0f, most));
}

void Texture::setParameter(GLenum name, GLint value) { handle_.device().gl.TextureParameteri(id(), name, value); }
void Texture::bind(GLuint unit) const { handle_.device().gl.BindTextureUnit(unit, id()); }

}  // namespace burnish::gl
