// Rows for fixed-function state. Defaults: OpenGL 4.5 core specification, tables 23.2 to 23.65.
#include "gl/host_state_rows.h"

namespace burnish::gl::rows {
namespace {

// ---- per draw buffer and per viewport (the plain calls set every index, so every index is saved) ----

void drawBuffers(Table& t) {
  for (GLuint i = 0; i < kStateDrawBuffers; ++i) {
    flagIndexed(t, "blend", GL_BLEND, i);
    const auto geti = [i](const Gl& gl, GLenum name) {
      GLint v = 0;
      gl.GetIntegeri_v(name, i, &v);
      return double(GLuint(v));
    };
    add(
        t, fmt::format("blend function {}", i), {GL_ONE, GL_ZERO, GL_ONE, GL_ZERO},
        {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_DST_ALPHA},
        [=](const Gl& gl) {
          return StateValue{geti(gl, GL_BLEND_SRC_RGB), geti(gl, GL_BLEND_DST_RGB), geti(gl, GL_BLEND_SRC_ALPHA),
                            geti(gl, GL_BLEND_DST_ALPHA)};
        },
        [=](const Gl& gl, const StateValue& v) { gl.BlendFuncSeparatei(i, u(v[0]), u(v[1]), u(v[2]), u(v[3])); });
    add(
        t, fmt::format("blend equation {}", i), {GL_FUNC_ADD, GL_FUNC_ADD}, {GL_MAX, GL_FUNC_SUBTRACT},
        [=](const Gl& gl) {
          return StateValue{geti(gl, GL_BLEND_EQUATION_RGB), geti(gl, GL_BLEND_EQUATION_ALPHA)};
        },
        [=](const Gl& gl, const StateValue& v) { gl.BlendEquationSeparatei(i, u(v[0]), u(v[1])); });
    add(
        t, fmt::format("colour mask {}", i), {1, 1, 1, 1}, {0, 1, 0, 0},
        [=](const Gl& gl) {
          std::array<GLboolean, 4> m{};
          gl.GetBooleani_v(GL_COLOR_WRITEMASK, i, m.data());
          return StateValue{double(m[0]), double(m[1]), double(m[2]), double(m[3])};
        },
        [=](const Gl& gl, const StateValue& v) { gl.ColorMaski(i, b(v[0]), b(v[1]), b(v[2]), b(v[3])); });
  }
  floats<4>(t, "blend colour", GL_BLEND_COLOR, {0, 0, 0, 0}, {0.25, 0.5, 0.75, 1},
            [](const Gl& gl, const StateValue& v) {
              gl.BlendColor(GLfloat(v[0]), GLfloat(v[1]), GLfloat(v[2]), GLfloat(v[3]));
            });
}

void viewports(Table& t) {
  for (GLuint i = 0; i < kStateViewports; ++i) {
    flagIndexed(t, "scissor test", GL_SCISSOR_TEST, i);
    add(
        t, fmt::format("viewport {}", i), {}, {3, 4, 33, 21},
        [=](const Gl& gl) {
          std::array<GLfloat, 4> f{};
          gl.GetFloati_v(GL_VIEWPORT, i, f.data());
          return StateValue{f[0], f[1], f[2], f[3]};
        },
        [=](const Gl& gl, const StateValue& v) {
          gl.ViewportIndexedf(i, GLfloat(v[0]), GLfloat(v[1]), GLfloat(v[2]), GLfloat(v[3]));
        })
        .initial.reset();
    add(
        t, fmt::format("scissor box {}", i), {}, {5, 6, 17, 19},
        [=](const Gl& gl) {
          std::array<GLint, 4> f{};
          gl.GetIntegeri_v(GL_SCISSOR_BOX, i, f.data());
          return StateValue{double(f[0]), double(f[1]), double(f[2]), double(f[3])};
        },
        [=](const Gl& gl, const StateValue& v) { gl.ScissorIndexed(i, s(v[0]), s(v[1]), s(v[2]), s(v[3])); })
        .initial.reset();
    add(
        t, fmt::format("depth range {}", i), {0, 1}, {0.25, 0.75},
        [=](const Gl& gl) {
          std::array<GLdouble, 2> d{};
          gl.GetDoublei_v(GL_DEPTH_RANGE, i, d.data());
          return StateValue{d[0], d[1]};
        },
        [=](const Gl& gl, const StateValue& v) { gl.DepthRangeIndexed(i, v[0], v[1]); });
  }
}

// ---- fixed function ----

void depth(Table& t) {
  flag(t, "depth test", GL_DEPTH_TEST);
  flag(t, "depth clamp", GL_DEPTH_CLAMP);
  number(t, "depth function", GL_DEPTH_FUNC, GL_LESS, GL_GEQUAL, [](const Gl& gl, double v) { gl.DepthFunc(u(v)); });
  number(t, "depth mask", GL_DEPTH_WRITEMASK, 1, 0, [](const Gl& gl, double v) { gl.DepthMask(b(v)); });
  floats<1>(t, "clear depth", GL_DEPTH_CLEAR_VALUE, {1}, {0.5},
            [](const Gl& gl, const StateValue& v) { gl.ClearDepth(v[0]); });
}

void stencil(Table& t) {
  flag(t, "stencil test", GL_STENCIL_TEST);
  for (const StencilFace& f : kStencilFaces) {
    add(
        t, fmt::format("stencil operation {}", f.name), {GL_KEEP, GL_KEEP, GL_KEEP}, {GL_INCR, GL_INVERT, GL_REPLACE},
        [=](const Gl& gl) {
          return StateValue{integer(gl, f.fail), integer(gl, f.depthFail), integer(gl, f.pass)};
        },
        [=](const Gl& gl, const StateValue& v) { gl.StencilOpSeparate(f.face, u(v[0]), u(v[1]), u(v[2])); });
    number(t, fmt::format("stencil mask {}", f.name), f.writeMask, kAllOnes, 0x33,
           [face = f.face](const Gl& gl, double v) { gl.StencilMaskSeparate(face, u(v)); });
  }
  number(t, "clear stencil", GL_STENCIL_CLEAR_VALUE, 0, 7, [](const Gl& gl, double v) { gl.ClearStencil(s(v)); });
}

void raster(Table& t) {
  flag(t, "cull face", GL_CULL_FACE);
  number(t, "cull face mode", GL_CULL_FACE_MODE, GL_BACK, GL_FRONT, [](const Gl& gl, double v) { gl.CullFace(u(v)); });
  number(t, "front face", GL_FRONT_FACE, GL_CCW, GL_CW, [](const Gl& gl, double v) { gl.FrontFace(u(v)); });
  number(t, "polygon mode", GL_POLYGON_MODE, GL_FILL, GL_LINE,
         [](const Gl& gl, double v) { gl.PolygonMode(GL_FRONT_AND_BACK, u(v)); });
  flag(t, "polygon offset fill", GL_POLYGON_OFFSET_FILL);
  flag(t, "polygon offset line", GL_POLYGON_OFFSET_LINE);
  flag(t, "polygon offset point", GL_POLYGON_OFFSET_POINT);
  add(
      t, "polygon offset", {0, 0}, {1.5, 2},
      [](const Gl& gl) {
        GLfloat factor = 0, units = 0;
        gl.GetFloatv(GL_POLYGON_OFFSET_FACTOR, &factor);
        gl.GetFloatv(GL_POLYGON_OFFSET_UNITS, &units);
        return StateValue{factor, units};
      },
      [](const Gl& gl, const StateValue& v) { gl.PolygonOffset(GLfloat(v[0]), GLfloat(v[1])); });
  add(
      t, "clip control", {GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE}, {GL_UPPER_LEFT, GL_ZERO_TO_ONE},
      [](const Gl& gl) {
        return StateValue{integer(gl, GL_CLIP_ORIGIN), integer(gl, GL_CLIP_DEPTH_MODE)};
      },
      [](const Gl& gl, const StateValue& v) { gl.ClipControl(u(v[0]), u(v[1])); });
  for (GLuint i = 0; i < 8; ++i) flag(t, fmt::format("clip distance {}", i), GL_CLIP_DISTANCE0 + i);
  flag(t, "primitive restart", GL_PRIMITIVE_RESTART);
  flag(t, "primitive restart fixed index", GL_PRIMITIVE_RESTART_FIXED_INDEX);
  number(t, "primitive restart index", GL_PRIMITIVE_RESTART_INDEX, 0, 65535,
         [](const Gl& gl, double v) { gl.PrimitiveRestartIndex(u(v)); });
  number(t, "provoking vertex", GL_PROVOKING_VERTEX, GL_LAST_VERTEX_CONVENTION, GL_FIRST_VERTEX_CONVENTION,
         [](const Gl& gl, double v) { gl.ProvokingVertex(u(v)); });
  number(t, "patch vertices", GL_PATCH_VERTICES, 3, 4,
         [](const Gl& gl, double v) { gl.PatchParameteri(GL_PATCH_VERTICES, s(v)); });
  flag(t, "rasterizer discard", GL_RASTERIZER_DISCARD);
  flag(t, "line smooth", GL_LINE_SMOOTH);
  flag(t, "polygon smooth", GL_POLYGON_SMOOTH);
  floats<1>(t, "line width", GL_LINE_WIDTH, {1}, {0.5},
            [](const Gl& gl, const StateValue& v) { gl.LineWidth(GLfloat(v[0])); });
  flag(t, "program point size", GL_PROGRAM_POINT_SIZE);
  floats<1>(t, "point size", GL_POINT_SIZE, {1}, {3},
            [](const Gl& gl, const StateValue& v) { gl.PointSize(GLfloat(v[0])); });
  floats<1>(t, "point fade threshold", GL_POINT_FADE_THRESHOLD_SIZE, {1}, {2},
            [](const Gl& gl, const StateValue& v) { gl.PointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, GLfloat(v[0])); });
  number(t, "point sprite origin", GL_POINT_SPRITE_COORD_ORIGIN, GL_UPPER_LEFT, GL_LOWER_LEFT,
         [](const Gl& gl, double v) { gl.PointParameteri(GL_POINT_SPRITE_COORD_ORIGIN, s(v)); });
}

void fragments(Table& t) {
  flag(t, "framebuffer sRGB", GL_FRAMEBUFFER_SRGB);
  flag(t, "cube map seamless", GL_TEXTURE_CUBE_MAP_SEAMLESS);
  flag(t, "multisample", GL_MULTISAMPLE, true);
  flag(t, "sample mask", GL_SAMPLE_MASK);
  add(
      t, "sample mask value", {4294967295.0}, {0x5},
      [](const Gl& gl) {
        GLint mask = 0;
        gl.GetIntegeri_v(GL_SAMPLE_MASK_VALUE, 0, &mask);
        return StateValue{double(GLuint(mask))};
      },
      [](const Gl& gl, const StateValue& v) { gl.SampleMaski(0, u(v[0])); });
  flag(t, "sample coverage", GL_SAMPLE_COVERAGE);
  flag(t, "sample alpha to coverage", GL_SAMPLE_ALPHA_TO_COVERAGE);
  flag(t, "sample alpha to one", GL_SAMPLE_ALPHA_TO_ONE);
  flag(t, "sample shading", GL_SAMPLE_SHADING);
  floats<1>(t, "least sample shading", GL_MIN_SAMPLE_SHADING_VALUE, {0}, {0.5},
            [](const Gl& gl, const StateValue& v) { gl.MinSampleShading(GLfloat(v[0])); });
  add(
      t, "sample coverage value", {1, 0}, {0.5, 1},
      [](const Gl& gl) {
        GLfloat value = 0;
        gl.GetFloatv(GL_SAMPLE_COVERAGE_VALUE, &value);
        return StateValue{value, integer(gl, GL_SAMPLE_COVERAGE_INVERT)};
      },
      [](const Gl& gl, const StateValue& v) { gl.SampleCoverage(GLfloat(v[0]), b(v[1])); });
  flag(t, "dither", GL_DITHER, true);
  flag(t, "logic operation", GL_COLOR_LOGIC_OP);
  number(t, "logic operation code", GL_LOGIC_OP_MODE, GL_COPY, GL_XOR,
         [](const Gl& gl, double v) { gl.LogicOp(u(v)); });
  number(t, "clamp read colour", GL_CLAMP_READ_COLOR, GL_FIXED_ONLY, GL_FALSE,
         [](const Gl& gl, double v) { gl.ClampColor(GL_CLAMP_READ_COLOR, u(v)); });
  floats<4>(t, "clear colour", GL_COLOR_CLEAR_VALUE, {0, 0, 0, 0}, {0.5, 0.25, 0.125, 1},
            [](const Gl& gl, const StateValue& v) {
              gl.ClearColor(GLfloat(v[0]), GLfloat(v[1]), GLfloat(v[2]), GLfloat(v[3]));
            });
}

void pixelStore(Table& t) {
  struct Store {
    const char* name;
    GLenum parameter;
    double initial, other;
  };
  static constexpr Store kStores[] = {
      {"unpack swap bytes", GL_UNPACK_SWAP_BYTES, 0, 1},   {"unpack lsb first", GL_UNPACK_LSB_FIRST, 0, 1},
      {"unpack row length", GL_UNPACK_ROW_LENGTH, 0, 17},  {"unpack image height", GL_UNPACK_IMAGE_HEIGHT, 0, 9},
      {"unpack skip rows", GL_UNPACK_SKIP_ROWS, 0, 2},     {"unpack skip pixels", GL_UNPACK_SKIP_PIXELS, 0, 3},
      {"unpack skip images", GL_UNPACK_SKIP_IMAGES, 0, 1}, {"unpack alignment", GL_UNPACK_ALIGNMENT, 4, 2},
      {"pack swap bytes", GL_PACK_SWAP_BYTES, 0, 1},       {"pack lsb first", GL_PACK_LSB_FIRST, 0, 1},
      {"pack row length", GL_PACK_ROW_LENGTH, 0, 18},      {"pack image height", GL_PACK_IMAGE_HEIGHT, 0, 8},
      {"pack skip rows", GL_PACK_SKIP_ROWS, 0, 4},         {"pack skip pixels", GL_PACK_SKIP_PIXELS, 0, 5},
      {"pack skip images", GL_PACK_SKIP_IMAGES, 0, 2},     {"pack alignment", GL_PACK_ALIGNMENT, 4, 8}};
  for (const Store& store : kStores)
    number(t, store.name, store.parameter, store.initial, store.other,
           [p = store.parameter](const Gl& gl, double v) { gl.PixelStorei(p, s(v)); });
}

void vertexAttributes(Table& t) {
  // Index 0 is left out: it has no current value in compatibility contexts of hosts.
  for (GLuint i = 1; i < 16; ++i)
    add(
        t, fmt::format("current vertex attribute {}", i), {0, 0, 0, 1}, {1, 0.5, 0.25, 2},
        [=](const Gl& gl) {
          std::array<GLfloat, 4> f{};
          gl.GetVertexAttribfv(i, GL_CURRENT_VERTEX_ATTRIB, f.data());
          return StateValue{f[0], f[1], f[2], f[3]};
        },
        [=](const Gl& gl, const StateValue& v) {
          gl.VertexAttrib4f(i, GLfloat(v[0]), GLfloat(v[1]), GLfloat(v[2]), GLfloat(v[3]));
        });
}

void debugGroups(Table& t) {
  // Groups that the engine left open are closed; those of the host stay. The bottom of the stack counts as one.
  add(
      t, "debug group depth", {1}, {3},
      [](const Gl& gl) { return StateValue{integer(gl, GL_DEBUG_GROUP_STACK_DEPTH)}; },
      [](const Gl& gl, const StateValue& v) {
        int depth = s(integer(gl, GL_DEBUG_GROUP_STACK_DEPTH));
        for (; depth > s(v[0]); --depth) gl.PopDebugGroup();
        for (; depth < s(v[0]); ++depth) gl.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, 4, "host");
      })
      .initial.reset();
}

}  // namespace

void fixedFunction(Table& t) {
  drawBuffers(t);
  viewports(t);
  depth(t);
  stencil(t);
  raster(t);
  fragments(t);
  pixelStore(t);
  vertexAttributes(t);
  debugGroups(t);
}

}  // namespace burnish::gl::rows
