// What the current context can do, and whether it is enough.
#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>

#include "context/backends.h"

namespace burnish {
namespace {

constexpr const char* kRemedy =
    "install a driver with OpenGL 4.5 core (Mesa 22 or newer has one for every machine), or use OSMesa";

template <class F>
F function(const ProcAddress& get, const char* name) {
  return reinterpret_cast<F>(get(name));
}

struct Reader {
  PFNGLGETSTRINGPROC getString;
  PFNGLGETSTRINGIPROC getStringi;
  PFNGLGETINTEGERVPROC getIntegerv;
  PFNGLGETINTEGER64VPROC getInteger64v;
  PFNGLGETFLOATVPROC getFloatv;
  PFNGLGETQUERYIVPROC getQueryiv;

  explicit Reader(const ProcAddress& get)
      : getString(function<PFNGLGETSTRINGPROC>(get, "glGetString")),
        getStringi(function<PFNGLGETSTRINGIPROC>(get, "glGetStringi")),
        getIntegerv(function<PFNGLGETINTEGERVPROC>(get, "glGetIntegerv")),
        getInteger64v(function<PFNGLGETINTEGER64VPROC>(get, "glGetInteger64v")),
        getFloatv(function<PFNGLGETFLOATVPROC>(get, "glGetFloatv")),
        getQueryiv(function<PFNGLGETQUERYIVPROC>(get, "glGetQueryiv")) {}
  [[nodiscard]] bool complete() const { return getString && getStringi && getIntegerv && getInteger64v && getFloatv && getQueryiv; }
  [[nodiscard]] std::string text(GLenum name) const {
    const GLubyte* s = getString(name);
    return s ? reinterpret_cast<const char*>(s) : "";
  }
  [[nodiscard]] int integer(GLenum name) const {
    GLint v = 0;
    getIntegerv(name, &v);
    return v;
  }
};

bool isSoftware(const std::string& renderer) {
  static constexpr const char* kNames[] = {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"};
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [&](const char* n) { return renderer.find(n) != std::string::npos; });
}

void readLimits(const Reader& gl, Capabilities& caps) {
  caps.maxTextureSize = gl.integer(GL_MAX_TEXTURE_SIZE);
  caps.maxTextureUnits = gl.integer(GL_MAX_TEXTURE_IMAGE_UNITS);
  caps.maxUniformBlockBytes = gl.integer(GL_MAX_UNIFORM_BLOCK_SIZE);
  caps.maxTextureBufferTexels = gl.integer(GL_MAX_TEXTURE_BUFFER_SIZE);
  caps.uniformAlignment = std::max(1, gl.integer(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT));
  GLint64 block = 0;
  gl.getInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
  caps.maxStorageBlockBytes = block;
  GLfloat range[2] = {1, 1};
  gl.getFloatv(GL_POINT_SIZE_RANGE, range);
  caps.maxPointSize = range[1];
}

void readExtensions(const Reader& gl, Capabilities& caps) {
  const int count = gl.integer(GL_NUM_EXTENSIONS);
  for (int i = 0; i < count; ++i)
    if (const GLubyte* s = gl.getStringi(GL_EXTENSIONS, GLuint(i)))
      caps.extensions.emplace_back(reinterpret_cast<const char*>(s));
  std::sort(caps.extensions.begin(), caps.extensions.end());
  const auto has = [&](const char* name) {
    return std::binary_search(caps.extensions.begin(), caps.extensions.end(), name);
  };
  const bool core46 = caps.major > 4 || (caps.major == 4 && caps.minor >= 6);
  caps.anisotropic = core46 || has("GL_ARB_texture_filter_anisotropic") || has("GL_EXT_texture_filter_anisotropic");
  caps.parallelCompile = has("GL_KHR_parallel_shader_compile") || has("GL_ARB_parallel_shader_compile");
  caps.drawParameters = core46 || has("GL_ARB_shader_draw_parameters");
  caps.debugOutput = true;  // core since 4.3
  GLint timestampBits = 0;  // timer queries are core, but a driver may give them no bits
  gl.getQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &timestampBits);
  caps.timerQueries = timestampBits > 0;
  caps.programBinary = gl.integer(GL_NUM_PROGRAM_BINARY_FORMATS) > 0;
}

/// Not needed: extensions, and the robust getters (glGetnTexImage...). Mesa's libglapi lists the latter nowhere and
/// hands out one of 256 spare slots for each unknown name; GLVND's EGL takes all of those, so OSMesa in the same
/// process is left without them.
bool isOptional(std::string_view name) {
  return name.ends_with("ARB") || name.ends_with("EXT") || name.ends_with("KHR") || name.starts_with("glGetn");
}

/// Core functions up to 4.5 that the driver has no address for. glad's loader asks for every one of them by name, so
/// the list is the registry's own.
std::string missingFunctions(const ProcAddress& get) {
  struct Asked {
    const ProcAddress& get;
    std::string missing;
  } asked{get, {}};
  const auto load = [](void* user, const char* name) {
    auto& a = *static_cast<Asked*>(user);
    const auto address = reinterpret_cast<GLADapiproc>(a.get(name));
    if (!address && !isOptional(name)) a.missing += (a.missing.empty() ? "" : ", ") + std::string(name);
    return address;
  };
  GladGLContext table{};
  if (!gladLoadGLContextUserPtr(&table, load, &asked) && asked.missing.empty()) return "the loader found no version";
  return asked.missing;
}

/// The required minima of OpenGL 4.5 that the engine builds on; a driver that is below one is broken, but saying so
/// beats a wrong picture.
Result<void> checkMinima(const std::string& place, const Capabilities& caps) {
  if (caps.maxTextureSize < 4096)
    return fail(place, fmt::format("textures of {} texels a side at most found, 4096 needed", caps.maxTextureSize),
                kRemedy);
  if (caps.maxTextureUnits < 16)
    return fail(place, fmt::format("{} texture units found, 16 needed", caps.maxTextureUnits), kRemedy);
  if (caps.maxUniformBlockBytes < 16384)
    return fail(place, fmt::format("uniform blocks of {} bytes found, 16384 needed", caps.maxUniformBlockBytes),
                kRemedy);
  if (caps.maxTextureBufferTexels < 65536)
    return fail(place, fmt::format("buffer textures of {} texels found, 65536 needed", caps.maxTextureBufferTexels),
                kRemedy);
  return {};
}

}  // namespace

namespace context {

std::string describeCurrent(const ProcAddress& get) {
  const Reader gl(get);
  if (!gl.getString) return "a context without glGetString";
  return fmt::format("OpenGL {} on {}", gl.text(GL_VERSION), gl.text(GL_RENDERER));
}

}  // namespace context

Result<Capabilities> queryCapabilities(const ProcAddress& getProcAddress) {
  if (!getProcAddress)
    return fail("OpenGL", "no getProcAddress function was given", "pass the one of the window library");
  const Reader gl(getProcAddress);
  if (!gl.complete())
    return fail("OpenGL", "getProcAddress does not know glGetString, glGetStringi or glGetIntegerv (OpenGL 3 or newer)",
                kRemedy);
  Capabilities caps;
  caps.vendor = gl.text(GL_VENDOR);
  caps.renderer = gl.text(GL_RENDERER);
  caps.version = gl.text(GL_VERSION);
  if (caps.version.empty())
    return fail("OpenGL", "no context is current on this thread", "make the context current first");
  const std::string place = fmt::format("OpenGL {} on {}", caps.version, caps.renderer);
  if (caps.version.rfind("OpenGL ES", 0) == 0)
    return fail(place, "OpenGL ES found, desktop OpenGL 4.5 core needed", kRemedy);
  caps.major = gl.integer(GL_MAJOR_VERSION);
  caps.minor = gl.integer(GL_MINOR_VERSION);
  if (caps.major < 4 || (caps.major == 4 && caps.minor < 5))
    return fail(place, fmt::format("OpenGL {}.{} found, 4.5 core needed", caps.major, caps.minor), kRemedy);
  caps.software = isSoftware(caps.renderer);
  if (const std::string missing = missingFunctions(getProcAddress); !missing.empty())
    return fail(place, "functions are missing: " + missing, kRemedy);
  readLimits(gl, caps);
  readExtensions(gl, caps);
  if (auto ok = checkMinima(place, caps); !ok) return fail(ok.error());
  return caps;
}

}  // namespace burnish
