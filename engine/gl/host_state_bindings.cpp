// Rows for what is bound where. Defaults: OpenGL 4.5 core specification, tables 23.2 to 23.65.
#include "gl/host_state_rows.h"

namespace burnish::gl::rows {
namespace {

void textureUnits(Table& t) {
  struct Kind {
    const char* name;
    GLenum target, query;
    StateObject object;
  };
  static constexpr Kind kKinds[] = {
      {"2D", GL_TEXTURE_2D, GL_TEXTURE_BINDING_2D, StateObject::Texture2D},
      {"cube", GL_TEXTURE_CUBE_MAP, GL_TEXTURE_BINDING_CUBE_MAP, StateObject::TextureCube},
      {"buffer", GL_TEXTURE_BUFFER, GL_TEXTURE_BINDING_BUFFER, StateObject::TextureBuffer},
      {"2D array", GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BINDING_2D_ARRAY, StateObject::Texture2DArray},
      {"cube array", GL_TEXTURE_CUBE_MAP_ARRAY, GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, StateObject::TextureCubeArray}};
  // glBindTextureUnit(unit, 0) unbinds every target of a unit, so the targets are bound one by one through the active
  // unit.
  for (GLuint unit = 0; unit < kStateUnits; ++unit) {
    for (const Kind& k : kKinds) {
      add(
          t, fmt::format("texture {} unit {}", k.name, unit), {0}, {0},
          [=](const Gl& gl) {
            gl.ActiveTexture(GL_TEXTURE0 + unit);
            return StateValue{unsignedInteger(gl, k.query)};
          },
          [=](const Gl& gl, const StateValue& v) {
            gl.ActiveTexture(GL_TEXTURE0 + unit);
            gl.BindTexture(k.target, u(v[0]));
          });
      t.back().object = k.object;
      t.back().bulk = true;
    }
    add(
        t, fmt::format("sampler unit {}", unit), {0}, {0},
        [=](const Gl& gl) {
          gl.ActiveTexture(GL_TEXTURE0 + unit);
          return StateValue{unsignedInteger(gl, GL_SAMPLER_BINDING)};
        },
        [=](const Gl& gl, const StateValue& v) { gl.BindSampler(unit, u(v[0])); });
    t.back().object = StateObject::Sampler;
    t.back().bulk = true;
  }
}

void imageUnits(Table& t) {
  for (GLuint unit = 0; unit < kStateImages; ++unit) {
    add(
        t, fmt::format("image unit {}", unit), {0, 0, 0, 0, GL_READ_ONLY, GL_R8}, {0, 0, 0, 0, GL_WRITE_ONLY, GL_RGBA8},
        [=](const Gl& gl) {
          static constexpr GLenum kParts[] = {GL_IMAGE_BINDING_NAME,  GL_IMAGE_BINDING_LEVEL,  GL_IMAGE_BINDING_LAYERED,
                                              GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT};
          StateValue v{};
          for (std::size_t i = 0; i < v.size(); ++i) {
            GLint part = 0;
            gl.GetIntegeri_v(kParts[i], unit, &part);
            v[i] = double(GLuint(part));
          }
          return v;
        },
        [=](const Gl& gl, const StateValue& v) {
          gl.BindImageTexture(unit, u(v[0]), s(v[1]), b(v[2]), s(v[3]), u(v[4]), u(v[5]));
        });
    t.back().object = StateObject::Image;
    t.back().bulk = true;
  }
}

void indexedBuffers(Table& t, const char* name, GLenum target, GLenum binding, GLenum start, GLenum size,
                    GLuint count) {
  for (GLuint i = 0; i < count; ++i) {
    // Name, offset, size; offset and size 0 mean the whole buffer.
    add(
        t, fmt::format("{} {}", name, i), {0, 0, 0}, {0, 256, 512},
        [=](const Gl& gl) {
          GLint id = 0;
          GLint64 from = 0, bytes = 0;
          gl.GetIntegeri_v(binding, i, &id);
          gl.GetInteger64i_v(start, i, &from);
          gl.GetInteger64i_v(size, i, &bytes);
          return StateValue{double(GLuint(id)), double(from), double(bytes)};
        },
        [=](const Gl& gl, const StateValue& v) {
          if (v[0] != 0 && v[2] > 0)
            gl.BindBufferRange(target, i, u(v[0]), GLintptr(v[1]), GLsizeiptr(v[2]));
          else
            gl.BindBufferBase(target, i, u(v[0]));
        });
    t.back().object = StateObject::Buffer;
    t.back().bulk = true;
  }
}

/// Mesa reports the reference clamped to the stencil bits of the framebuffer that is bound: with none it reads 0, and
/// putting that back would lose the host's. So these rows are left alone unless the engine changed them, and stand
/// before the framebuffers' to be compared under the same one.
void stencilFunctions(Table& t) {
  for (const StencilFace& f : kStencilFaces)
    add(
        t, fmt::format("stencil function {}", f.name), {GL_ALWAYS, 0, kAllOnes}, {GL_EQUAL, 3, 0x0f},
        [=](const Gl& gl) {
          return StateValue{integer(gl, f.func), integer(gl, f.ref), unsignedInteger(gl, f.valueMask)};
        },
        [=](const Gl& gl, const StateValue& v) { gl.StencilFuncSeparate(f.face, u(v[0]), s(v[1]), u(v[2])); })
        .lossy = true;
}

}  // namespace

void bindings(Table& t) {
  number(t, "active texture", GL_ACTIVE_TEXTURE, GL_TEXTURE0, GL_TEXTURE5,
         [](const Gl& gl, double v) { gl.ActiveTexture(u(v)); });
  stencilFunctions(t);
  // A pipeline counts only while no program is in use; one restores both.
  binding(t, "program pipeline", StateObject::Pipeline, GL_PROGRAM_PIPELINE_BINDING,
          [](const Gl& gl, double v) { gl.BindProgramPipeline(u(v)); });
  binding(t, "program", StateObject::Program, GL_CURRENT_PROGRAM, [](const Gl& gl, double v) {
    if (v == 0 || gl.IsProgram(u(v))) gl.UseProgram(u(v));
  });
  binding(t, "vertex array", StateObject::VertexArray, GL_VERTEX_ARRAY_BINDING,
          [](const Gl& gl, double v) { gl.BindVertexArray(u(v)); });
  binding(t, "draw framebuffer", StateObject::Framebuffer, GL_DRAW_FRAMEBUFFER_BINDING,
          [](const Gl& gl, double v) { gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, u(v)); });
  binding(t, "read framebuffer", StateObject::Framebuffer, GL_READ_FRAMEBUFFER_BINDING,
          [](const Gl& gl, double v) { gl.BindFramebuffer(GL_READ_FRAMEBUFFER, u(v)); });
  binding(t, "renderbuffer", StateObject::Renderbuffer, GL_RENDERBUFFER_BINDING,
          [](const Gl& gl, double v) { gl.BindRenderbuffer(GL_RENDERBUFFER, u(v)); });
  // Binding an indexed buffer moves the plain binding of its target too: these rows come first and so are restored
  // last.
  bufferBinding(t, "uniform buffer", GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING);
  bufferBinding(t, "shader storage buffer", GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING);
  bufferBinding(t, "array buffer", GL_ARRAY_BUFFER, GL_ARRAY_BUFFER_BINDING);
  bufferBinding(t, "copy read buffer", GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING);
  bufferBinding(t, "copy write buffer", GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING);
  bufferBinding(t, "pixel pack buffer", GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING);
  bufferBinding(t, "pixel unpack buffer", GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING);
  bufferBinding(t, "texture buffer", GL_TEXTURE_BUFFER, GL_TEXTURE_BUFFER_BINDING);
  bufferBinding(t, "draw indirect buffer", GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING);
  bufferBinding(t, "dispatch indirect buffer", GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING);
  bufferBinding(t, "query buffer", GL_QUERY_BUFFER, GL_QUERY_BUFFER_BINDING);
  indexedBuffers(t, "uniform buffer binding", GL_UNIFORM_BUFFER, GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START,
                 GL_UNIFORM_BUFFER_SIZE, kStateBufferBindings);
  indexedBuffers(t, "shader storage buffer binding", GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING,
                 GL_SHADER_STORAGE_BUFFER_START, GL_SHADER_STORAGE_BUFFER_SIZE, kStateStorageBindings);
  textureUnits(t);
  imageUnits(t);
}

}  // namespace burnish::gl::rows
