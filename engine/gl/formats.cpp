#include "gl/formats.h"

#include <algorithm>

namespace burnish::gl {
namespace {

constexpr FormatInfo kFormats[] = {
    {GL_R8, "R8", 1, GL_RED, GL_UNSIGNED_BYTE},
    {GL_RG8, "RG8", 2, GL_RG, GL_UNSIGNED_BYTE},
    {GL_RGBA8, "RGBA8", 4, GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_SRGB8_ALPHA8, "SRGB8_ALPHA8", 4, GL_RGBA, GL_UNSIGNED_BYTE},
    {GL_R8_SNORM, "R8_SNORM", 1, GL_RED, GL_BYTE},
    {GL_RG8_SNORM, "RG8_SNORM", 2, GL_RG, GL_BYTE},
    {GL_RGBA8_SNORM, "RGBA8_SNORM", 4, GL_RGBA, GL_BYTE},
    {GL_R16, "R16", 2, GL_RED, GL_UNSIGNED_SHORT},
    {GL_RG16, "RG16", 4, GL_RG, GL_UNSIGNED_SHORT},
    {GL_RGBA16, "RGBA16", 8, GL_RGBA, GL_UNSIGNED_SHORT},
    {GL_RGB10_A2, "RGB10_A2", 4, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV},
    {GL_R11F_G11F_B10F, "R11F_G11F_B10F", 4, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV},
    {GL_RGB9_E5, "RGB9_E5", 4, GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV},
    {GL_R16F, "R16F", 2, GL_RED, GL_HALF_FLOAT},
    {GL_RG16F, "RG16F", 4, GL_RG, GL_HALF_FLOAT},
    {GL_RGBA16F, "RGBA16F", 8, GL_RGBA, GL_HALF_FLOAT},
    {GL_R32F, "R32F", 4, GL_RED, GL_FLOAT},
    {GL_RG32F, "RG32F", 8, GL_RG, GL_FLOAT},
    {GL_RGB32F, "RGB32F", 12, GL_RGB, GL_FLOAT},
    {GL_RGBA32F, "RGBA32F", 16, GL_RGBA, GL_FLOAT},
    {GL_R8UI, "R8UI", 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE},
    {GL_R16UI, "R16UI", 2, GL_RED_INTEGER, GL_UNSIGNED_SHORT},
    {GL_R32UI, "R32UI", 4, GL_RED_INTEGER, GL_UNSIGNED_INT},
    {GL_RG32UI, "RG32UI", 8, GL_RG_INTEGER, GL_UNSIGNED_INT},
    {GL_RGBA32UI, "RGBA32UI", 16, GL_RGBA_INTEGER, GL_UNSIGNED_INT},
    {GL_RGBA8UI, "RGBA8UI", 4, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE},
    {GL_R32I, "R32I", 4, GL_RED_INTEGER, GL_INT},
    {GL_DEPTH_COMPONENT16, "DEPTH_COMPONENT16", 2, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT},
    {GL_DEPTH_COMPONENT24, "DEPTH_COMPONENT24", 4, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT},
    {GL_DEPTH_COMPONENT32F, "DEPTH_COMPONENT32F", 4, GL_DEPTH_COMPONENT, GL_FLOAT},
    {GL_DEPTH24_STENCIL8, "DEPTH24_STENCIL8", 4, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8},
    {GL_DEPTH32F_STENCIL8, "DEPTH32F_STENCIL8", 8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV},
};

}  // namespace

std::span<const FormatInfo> formats() { return kFormats; }

const FormatInfo* formatInfo(GLenum format) {
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats), [&](const FormatInfo& f) { return f.format == format; });
  return found == std::end(kFormats) ? nullptr : found;
}

const FormatInfo* formatInfo(std::string_view name) {
  const auto* found =
      std::find_if(std::begin(kFormats), std::end(kFormats), [&](const FormatInfo& f) { return f.name == name; });
  return found == std::end(kFormats) ? nullptr : found;
}

std::int64_t textureBytes(const FormatInfo& info, int width, int height, int layers, int levels) {
  std::int64_t texels = 0;
  for (int level = 0; level < levels; ++level)
    texels += std::int64_t(std::max(1, width >> level)) * std::max(1, height >> level);
  return texels * layers * info.bytes;
}

int fullMipLevels(int width, int height) {
  int levels = 1;
  for (int side = std::max(width, height); side > 1; side >>= 1) ++levels;
  return levels;
}

}  // namespace burnish::gl
