// What a draw call costs on this driver, whatever is drawn: 9,780 meshes of 72 triangles (as in make_field.py --distinct) drawn with buffers of their own, from shared buffers, by one
// indirect multi-draw, and as instances of one mesh. Prints CPU ms (user and system) of a frame, median and quartiles. docs/decisions/indirect_draws.md uses it.
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

namespace {

constexpr int kMeshes = 9780, kSide = 6, kStride = 36;

const char* kVertex = R"(#version 450 core
layout(location = 0) in vec3 position; layout(location = 1) in vec4 place;
out vec3 color;
void main() { color = position; gl_Position = vec4(position.xy * place.w + place.xy, 0.5 + 0.1 * position.z, 1); })";
const char* kFragment = R"(#version 450 core
in vec3 color; out vec4 result;
void main() { result = vec4(color, 1); })";

struct Command {
  GLuint count, instances, firstIndex;
  GLint baseVertex;
  GLuint baseInstance;
};

double cpuMs() {
  rusage r{};
  getrusage(RUSAGE_SELF, &r);
  return double(r.ru_utime.tv_sec + r.ru_stime.tv_sec) * 1e3 + double(r.ru_utime.tv_usec + r.ru_stime.tv_usec) * 1e-3;
}

[[noreturn]] void stop(const char* why) {
  std::fprintf(stderr, "draw_calls: %s\n", why);
  std::exit(1);
}

GLuint shader(GLenum stage, const char* text) {
  const GLuint s = glCreateShader(stage);
  glShaderSource(s, 1, &text, nullptr);
  glCompileShader(s);
  GLint good = 0;
  glGetShaderiv(s, GL_COMPILE_STATUS, &good);
  if (!good) stop("a shader does not compile");
  return s;
}

template <class T>
GLuint buffer(const std::vector<T>& data) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferStorage(id, GLsizeiptr(data.size() * sizeof(T)), data.data(), GL_DYNAMIC_STORAGE_BIT);
  return id;
}

template <class T>
std::vector<T> repeated(const std::vector<T>& one) {
  std::vector<T> all;
  for (int i = 0; i < kMeshes; ++i) all.insert(all.end(), one.begin(), one.end());
  return all;
}

void openContext() {
  EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (!eglInitialize(display, nullptr, nullptr)) stop("no EGL surfaceless display");
  eglBindAPI(EGL_OPENGL_API);
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes))) stop("no GL 4.5 core context");
}

}  // namespace

int main() {
  openContext();
  const GLuint program = glCreateProgram();
  glAttachShader(program, shader(GL_VERTEX_SHADER, kVertex));
  glAttachShader(program, shader(GL_FRAGMENT_SHADER, kFragment));
  glLinkProgram(program);
  glUseProgram(program);

  std::vector<float> vertices;
  std::vector<std::uint16_t> indices;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) {
      vertices.insert(vertices.end(), {float(x) / kSide - 0.5f, float(y) / kSide - 0.5f, 0.1f * std::sin(float(x * y))});
      vertices.resize(vertices.size() + kStride / 4 - 3);
    }
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const int q = y * (kSide + 1) + x;
      for (const int k : {q, q + 1, q + kSide + 1, q + 1, q + kSide + 2, q + kSide + 1}) indices.push_back(std::uint16_t(k));
    }
  const GLsizei count = GLsizei(indices.size());
  std::vector<GLuint> ownVertices, ownIndices;
  std::vector<float> places;
  std::vector<Command> commands;
  for (int i = 0; i < kMeshes; ++i) {
    ownVertices.push_back(buffer(vertices));
    ownIndices.push_back(buffer(indices));
    places.insert(places.end(), {float(i % 100) / 50 - 1, float(i / 100) / 50 - 1, 0, 0.02f});
    commands.push_back({GLuint(count), 1, GLuint(i * count), i * (kSide + 1) * (kSide + 1), GLuint(i)});
  }
  const GLuint sharedVertices = buffer(repeated(vertices)), sharedIndices = buffer(repeated(indices)), placeBuffer = buffer(places), commandBuffer = buffer(commands);

  GLuint array = 0;
  glCreateVertexArrays(1, &array);
  glBindVertexArray(array);
  for (GLuint k = 0; k < 2; ++k) {
    glEnableVertexArrayAttrib(array, k);
    glVertexArrayAttribFormat(array, k, k == 0 ? 3 : 4, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array, k, k);
  }
  glVertexArrayVertexBuffer(array, 1, placeBuffer, 0, 16);
  glVertexArrayBindingDivisor(array, 1, 1);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commandBuffer);
  GLuint picture = 0, framebuffer = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &picture);
  glTextureStorage2D(picture, 1, GL_RGBA8, 1280, 720);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, picture, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, 1280, 720);

  const auto shared = [&] {
    glVertexArrayVertexBuffer(array, 0, sharedVertices, 0, kStride);
    glVertexArrayElementBuffer(array, sharedIndices);
  };
  struct Way {
    const char* name;
    std::function<void()> draw;
    std::vector<double> ms;
  };
  Way ways[] = {
      {"buffers of their own, a call each",
       [&] {
         for (std::size_t i = 0; i < kMeshes; ++i) {
           glVertexArrayVertexBuffer(array, 0, ownVertices[i], 0, kStride);
           glVertexArrayElementBuffer(array, ownIndices[i]);
           glDrawElementsInstancedBaseInstance(GL_TRIANGLES, count, GL_UNSIGNED_SHORT, nullptr, 1, GLuint(i));
         }
       },
       {}},
      {"shared buffers, a call each",
       [&] {
         shared();
         for (const Command& c : commands)
           glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, count, GL_UNSIGNED_SHORT, reinterpret_cast<const void*>(std::uintptr_t(c.firstIndex) * 2), 1, c.baseVertex, c.baseInstance);
       },
       {}},
      {"shared buffers, one indirect multi-draw, commands uploaded",
       [&] {
         shared();
         glNamedBufferSubData(commandBuffer, 0, GLsizeiptr(commands.size() * sizeof(Command)), commands.data());
         glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_SHORT, nullptr, kMeshes, 0);
       },
       {}},
      {"one mesh, one instanced draw",
       [&] {
         shared();
         glDrawElementsInstanced(GL_TRIANGLES, count, GL_UNSIGNED_SHORT, nullptr, kMeshes);
       },
       {}},
  };
  constexpr int kWarm = 3, kRounds = 11;
  for (int round = 0; round < kWarm + kRounds; ++round)
    for (Way& way : ways) {
      const double start = cpuMs();
      glClear(GL_COLOR_BUFFER_BIT);
      way.draw();
      glFinish();
      if (round >= kWarm) way.ms.push_back(cpuMs() - start);
    }
  std::printf("%s, %d meshes of %d triangles, CPU ms a frame\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)), kMeshes, 2 * kSide * kSide);
  for (Way& way : ways) {
    std::sort(way.ms.begin(), way.ms.end());
    std::printf("%-60s %7.1f (%.1f to %.1f)\n", way.name, way.ms[kRounds / 2], way.ms[kRounds / 4], way.ms[kRounds * 3 / 4]);
  }
}
