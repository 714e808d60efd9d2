// A context of the backend under test (BURNISH_TEST_BACKEND = egl or osmesa; egl when unset). Tests fail, never skip,
// where it cannot be opened.
#pragma once
#include <burnish/context.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <cstring>

#include "gl/device.h"

namespace burnish::test {

inline Backend testBackend() {
  const char* name = std::getenv("BURNISH_TEST_BACKEND");
  if (!name || !*name || std::strcmp(name, "egl") == 0) return Backend::Egl;
  if (std::strcmp(name, "osmesa") == 0) return Backend::OsMesa;
  if (std::strcmp(name, "glfw") == 0) return Backend::Glfw;
  FAIL("BURNISH_TEST_BACKEND is \"" << name << "\"; use egl, osmesa or glfw");
  return Backend::Egl;
}

inline std::unique_ptr<Context> openContext(ContextOptions options) {
  auto made = Context::create(options);
  if (!made) FAIL("no " << backendName(options.backend) << " context: " << made.error().message());
  return std::move(*made);
}
inline std::unique_ptr<Context> openContext() {
  ContextOptions options;
  options.backend = testBackend();
  options.debug = true;
  options.visible = false;
  return openContext(options);
}

inline std::unique_ptr<gl::Device> openDevice(const Context& context) {
  auto made = gl::Device::create(context.procAddress(), true);
  if (!made) FAIL("no device: " << made.error().message());
  return std::move(*made);
}

/// Context and device; any GL error that a test leaves behind is a failure of that test.
struct GlFixture {
  std::unique_ptr<Context> context = openContext();
  std::unique_ptr<gl::Device> device = openDevice(*context);
  const GladGLContext& gl = device->gl;

  ~GlFixture() {
    for (const std::string& e : device->takeErrors()) FAIL_CHECK("GL error: " << e);
    CHECK(device->bytesAllocated() == 0);  // every object of the test is gone by now
  }
};

}  // namespace burnish::test
