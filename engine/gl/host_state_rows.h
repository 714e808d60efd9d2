// How rows of the host state table are written; for host_state_bindings.cpp and host_state_fixed.cpp alone.
#pragma once
#include <fmt/format.h>

#include "gl/host_state.h"

namespace burnish::gl::rows {

using Gl = GladGLContext;
using Table = std::vector<StateEntry>;

inline double integer(const Gl& gl, GLenum name) {
  std::array<GLint, 4> v{};  // some drivers write two for GL_POLYGON_MODE
  gl.GetIntegerv(name, v.data());
  return v[0];
}
/// GL names and masks are unsigned: 32 bits would be cut at 2^31 - 1.
inline double unsignedInteger(const Gl& gl, GLenum name) {
  std::array<GLint64, 4> v{};
  gl.GetInteger64v(name, v.data());
  return double(GLuint(v[0]));
}
inline GLuint u(double v) { return GLuint(v); }
inline GLint s(double v) { return GLint(v); }
inline GLboolean b(double v) { return v != 0 ? GL_TRUE : GL_FALSE; }

inline StateEntry& add(Table& t, std::string name, StateValue initial, StateValue other,
                       std::function<StateValue(const Gl&)> get,
                       std::function<void(const Gl&, const StateValue&)> set) {
  t.push_back({std::move(name), StateObject::None, initial, other, std::move(get), std::move(set), false, false});
  return t.back();
}

inline void flag(Table& t, std::string name, GLenum cap, bool on = false) {
  add(
      t, std::move(name), {double(on)}, {double(!on)},
      [cap](const Gl& gl) { return StateValue{double(gl.IsEnabled(cap))}; },
      [cap](const Gl& gl, const StateValue& v) { v[0] != 0 ? gl.Enable(cap) : gl.Disable(cap); });
}

inline void flagIndexed(Table& t, const std::string& name, GLenum cap, GLuint index) {
  add(
      t, fmt::format("{} {}", name, index), {0}, {1},
      [=](const Gl& gl) { return StateValue{double(gl.IsEnabledi(cap, index))}; },
      [=](const Gl& gl, const StateValue& v) { v[0] != 0 ? gl.Enablei(cap, index) : gl.Disablei(cap, index); });
}

/// State of one number whose setter takes it alone.
template <class Set>
void number(Table& t, std::string name, GLenum query, double initial, double other, Set set) {
  add(
      t, std::move(name), {initial}, {other}, [query](const Gl& gl) { return StateValue{unsignedInteger(gl, query)}; },
      [set](const Gl& gl, const StateValue& v) { set(gl, v[0]); });
}

template <int N, class Set>
void floats(Table& t, std::string name, GLenum query, StateValue initial, StateValue other, Set set) {
  add(
      t, std::move(name), initial, other,
      [query](const Gl& gl) {
        std::array<GLfloat, 4> f{};
        gl.GetFloatv(query, f.data());
        StateValue v{};
        for (std::size_t i = 0; i < N; ++i) v[i] = f[i];
        return v;
      },
      set);
}

template <class Bind>
void binding(Table& t, std::string name, StateObject object, GLenum query, Bind bind) {
  number(t, std::move(name), query, 0, 0, bind);
  t.back().object = object;
}

inline void bufferBinding(Table& t, std::string name, GLenum target, GLenum query) {
  binding(t, std::move(name), StateObject::Buffer, query,
          [target](const Gl& gl, double v) { gl.BindBuffer(target, u(v)); });
}

/// Masks of the stencil default to all ones; of those, formats have eight.
constexpr double kAllOnes = 0xff;

struct StencilFace {
  const char* name;
  GLenum face, func, ref, valueMask, fail, depthFail, pass, writeMask;
};
constexpr StencilFace kStencilFaces[] = {
    {"front", GL_FRONT, GL_STENCIL_FUNC, GL_STENCIL_REF, GL_STENCIL_VALUE_MASK, GL_STENCIL_FAIL,
     GL_STENCIL_PASS_DEPTH_FAIL, GL_STENCIL_PASS_DEPTH_PASS, GL_STENCIL_WRITEMASK},
    {"back", GL_BACK, GL_STENCIL_BACK_FUNC, GL_STENCIL_BACK_REF, GL_STENCIL_BACK_VALUE_MASK, GL_STENCIL_BACK_FAIL,
     GL_STENCIL_BACK_PASS_DEPTH_FAIL, GL_STENCIL_BACK_PASS_DEPTH_PASS, GL_STENCIL_BACK_WRITEMASK}};

void bindings(Table& t);       ///< objects bound, stencil functions
void fixedFunction(Table& t);  ///< everything else

}  // namespace burnish::gl::rows
