// Contexts: what opens, what the errors say, and that several live side by side.
#include <dlfcn.h>

#include <atomic>
#include <thread>

#include "context/library.h"
#include "gl/objects.h"
#include "gl_fixture.h"
#include "subprocess.h"

using namespace burnish;
using namespace burnish::test;
using Catch::Matchers::Contains;

namespace {

/// Clears an own framebuffer to a grey and reads one texel back: proves that calls reach the context that is meant.
int clearAndRead(gl::Device& device, int grey) {
  auto texture = gl::Texture::create(device, {GL_TEXTURE_2D, GL_RGBA8, 8, 8}, "target");
  REQUIRE(texture);
  const gl::Attachment color(*texture);
  auto framebuffer = gl::Framebuffer::create(device, {&color, 1}, {}, "target");
  REQUIRE(framebuffer);
  framebuffer->bind();
  device.gl.ClearColor(float(grey) / 255, 0, 0, 1);
  device.gl.Clear(GL_COLOR_BUFFER_BIT);
  std::array<std::byte, 8 * 8 * 4> pixels{};
  texture->read(0, pixels);
  device.gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  return int(pixels[4 * 9]);
}

ContextOptions optionsOf(Backend backend) {
  ContextOptions options;
  options.backend = backend;
  return options;
}

}  // namespace

TEST_CASE("a context has 4.5 core and says what it is") {
  auto context = openContext();
  CHECK(context->backend() == testBackend());
  auto caps = queryCapabilities(context->procAddress());
  REQUIRE(caps);
  CHECK(caps->major * 10 + caps->minor >= 45);
  CHECK_FALSE(caps->renderer.empty());
  CHECK_FALSE(caps->vendor.empty());
  CHECK(caps->maxTextureSize >= 4096);
  CHECK(caps->maxPointSize >= 16);
  CHECK(caps->maxStorageBlockBytes >= (1 << 24));
  CHECK(std::is_sorted(caps->extensions.begin(), caps->extensions.end()));
  CHECK(caps->software ==
        (caps->renderer.find("llvmpipe") != std::string::npos || caps->renderer.find("softpipe") != std::string::npos));
  CHECK(context->present());
  CHECK(context->window() == nullptr);
}

TEST_CASE("capabilities without a context, or with a half-empty driver, are errors") {
  CHECK_THAT(queryCapabilities({}).error().message(), Contains("getProcAddress"));
  CHECK_THAT(queryCapabilities([](const char*) -> void* { return nullptr; }).error().message(),
             Contains("glGetString"));
  auto context = openContext();
  const ProcAddress whole = context->procAddress();
  const ProcAddress partial = [&](const char* name) {
    return std::strcmp(name, "glCreateTextures") == 0 ? nullptr : whole(name);
  };
  CHECK_THAT(queryCapabilities(partial).error().message(), Contains("functions are missing: glCreateTextures"));
  CHECK_FALSE(gl::Device::create(partial, false));
  context->release();
  CHECK_FALSE(queryCapabilities(whole));
}

TEST_CASE("backend names") {
  CHECK(backendName(Backend::Egl) == "egl");
  CHECK(backendName(Backend::OsMesa) == "osmesa");
  CHECK(backendName(Backend::Glfw) == "glfw");
}

TEST_CASE("a missing library is one error that names it and the package") {
  static constexpr const char* kNames[] = {"libNoSuchGL.so.1", "libNoSuchGL.so"};
  auto library = context::Library::open(kNames, "libnosuch1");
  REQUIRE_FALSE(library);
  CHECK_THAT(library.error().message(), Contains("libNoSuchGL.so.1") && Contains("apt-get install libnosuch1"));
}

TEST_CASE("two contexts in one process, taken in turns") {
  auto first = openContext();
  auto deviceA = openDevice(*first);
  auto second = openContext();
  auto deviceB = openDevice(*second);
  for (int turn = 0; turn < 3; ++turn) {
    REQUIRE(first->makeCurrent());
    CHECK(clearAndRead(*deviceA, 10 + turn) == 10 + turn);
    REQUIRE(second->makeCurrent());
    CHECK(clearAndRead(*deviceB, 200 + turn) == 200 + turn);
  }
  CHECK(deviceB->takeErrors().empty());
  deviceB.reset();
  second.reset();
  REQUIRE(first->makeCurrent());
  CHECK(clearAndRead(*deviceA, 77) == 77);  // the end of one leaves the other alone
  CHECK(deviceA->takeErrors().empty());
}

TEST_CASE("two threads, a context each, at the same time") {
  std::array<std::string, 2> problems;
  std::atomic<int> started{0};
  const auto work = [&](int index) {
    std::string& problem = problems[std::size_t(index)];
    ContextOptions options = optionsOf(testBackend());
    auto context = Context::create(options);
    if (!context) return void(problem = context.error().message());
    auto device = gl::Device::create((*context)->procAddress(), false);
    if (!device) return void(problem = device.error().message());
    ++started;
    while (started < 2) std::this_thread::yield();
    for (int i = 0; i < 200 && problem.empty(); ++i) {
      const int grey = index * 100 + i % 50;
      auto texture = gl::Texture::create(**device, {GL_TEXTURE_2D, GL_RGBA8, 4, 4}, "t");
      if (!texture) return void(problem = texture.error().message());
      texture->clear({float(grey) / 255, 0, 0, 1});
      std::array<std::byte, 64> pixels{};
      texture->read(0, pixels);
      if (int(pixels[0]) != grey) problem = "wrong texel";
    }
    if (!(*device)->takeErrors().empty()) problem = "GL errors";
  };
  std::thread a(work, 0), b(work, 1);
  a.join();
  b.join();
  CHECK(problems[0].empty());
  CHECK(problems[1].empty());
}

TEST_CASE("a context moves between threads when it is released") {
  auto context = openContext();
  auto device = openDevice(*context);
  context->release();
  int read = 0;
  bool current = false;
  std::thread([&] {
    current = bool(context->makeCurrent());
    if (current) {
      auto texture = gl::Texture::create(*device, {GL_TEXTURE_2D, GL_R8, 1, 1}, "t");
      texture->clear({1, 0, 0, 0});
      std::array<std::byte, 1> texel{};
      texture->read(0, texel);
      read = int(texel[0]);
    }
    context->release();
  }).join();
  CHECK(current);
  CHECK(read == 255);
  REQUIRE(context->makeCurrent());
}

TEST_CASE("OSMesa and EGL side by side: no gl symbol leaks, calls reach their own context") {
  auto egl = openContext(optionsOf(Backend::Egl));
  auto eglDevice = openDevice(*egl);
  const std::string eglRenderer = eglDevice->caps.renderer;
  egl->release();
  auto osmesa = openContext(optionsOf(Backend::OsMesa));
  auto osmesaDevice = openDevice(*osmesa);
  CHECK(dlsym(RTLD_DEFAULT, "glClear") == nullptr);  // OSMesa exports it; RTLD_LOCAL keeps it in
  CHECK(dlsym(RTLD_DEFAULT, "OSMesaMakeCurrent") == nullptr);
  for (int turn = 0; turn < 3; ++turn) {
    osmesa->release();
    REQUIRE(egl->makeCurrent());
    CHECK(clearAndRead(*eglDevice, 20 + turn) == 20 + turn);
    CHECK(reinterpret_cast<const char*>(eglDevice->gl.GetString(GL_RENDERER)) == eglRenderer);
    egl->release();
    REQUIRE(osmesa->makeCurrent());
    CHECK(clearAndRead(*osmesaDevice, 120 + turn) == 120 + turn);
  }
  CHECK(osmesaDevice->takeErrors().empty());
  osmesaDevice.reset();
  osmesa.reset();
  REQUIRE(egl->makeCurrent());
  CHECK(clearAndRead(*eglDevice, 5) == 5);
  CHECK(eglDevice->takeErrors().empty());
}

TEST_CASE("impossible sizes are errors") {
  ContextOptions options = optionsOf(Backend::OsMesa);
  options.width = 0;
  CHECK_THAT(Context::create(options).error().message(), Contains("0x64"));
  options.width = 1 << 20;
  CHECK_FALSE(Context::create(options));
}

// ---- what needs another environment runs in a process of its own ----

TEST_CASE("hidden: this driver is too old", "[.old]") {
  auto made = Context::create(optionsOf(testBackend()));
  REQUIRE_FALSE(made);
  CHECK_THAT(made.error().message(), Contains("OpenGL 4.3") && Contains("4.5 core needed"));
  if (testBackend() == Backend::Egl) CHECK_THAT(made.error().message(), Contains("EGL 1."));
}
TEST_CASE("a driver with OpenGL 4.3 is refused, with what was found") {
  const auto here = queryCapabilities(openContext()->procAddress());
  REQUIRE(here);
  if (here->version.find("Mesa") == std::string::npos) {
    WARN("only Mesa can be told to be older than it is: " << here->version);
    return;
  }
  const Outcome outcome = runSelf("env MESA_GL_VERSION_OVERRIDE=4.3 MESA_GLSL_VERSION_OVERRIDE=430", "[.old]");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
}

TEST_CASE("hidden: no display", "[.nodisplay]") {
  auto made = Context::create(optionsOf(Backend::Glfw));
  REQUIRE_FALSE(made);
  CHECK_THAT(made.error().message(), Contains("GLFW") && Contains("DISPLAY"));
}
TEST_CASE("a window without a display is one clear error") {
  const Outcome outcome = runSelf("env -u DISPLAY -u WAYLAND_DISPLAY", "[.nodisplay]");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
}

TEST_CASE("hidden: windows", "[.glfw]") {
  for (const bool throughEgl : {false, true}) {
    CAPTURE(throughEgl);
    ContextOptions options = optionsOf(Backend::Glfw);
    options.glfwEgl = throughEgl;
    options.width = 80;
    options.height = 60;
    auto window = openContext(options);
    CHECK(window->backend() == Backend::Glfw);
    CHECK(window->window() != nullptr);
    auto device = openDevice(*window);
    CHECK(clearAndRead(*device, 42) == 42);
    device->gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
    device->gl.ClearColor(0, 1, 0, 1);
    device->gl.Clear(GL_COLOR_BUFFER_BIT);
    std::array<GLubyte, 4> pixel{};
    device->gl.ReadPixels(40, 30, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    CHECK(pixel[1] == 255);
    CHECK(window->present());
    // A second window beside the first, gone before it: GLFW must stay up.
    {
      auto second = openContext(options);
      auto secondDevice = openDevice(*second);
      CHECK(clearAndRead(*secondDevice, 43) == 43);
      secondDevice.reset();
    }
    REQUIRE(window->makeCurrent());
    CHECK(clearAndRead(*device, 44) == 44);
    CHECK(device->takeErrors().empty());
  }
}
TEST_CASE("windows through GLX and through EGL, under Xvfb") {
  if (std::system("command -v xvfb-run > /dev/null 2>&1") != 0) FAIL("xvfb-run is missing: apt-get install xvfb xauth");
  // The server stays as it is between two windows: while it resets itself after its last client, it takes no other.
  const Outcome outcome = runSelf("env ASAN_OPTIONS=detect_leaks=0 xvfb-run -a -s '-screen 0 640x480x24 -noreset'", "[.glfw]");
  INFO(outcome.output);
  CHECK(outcome.status == 0);
}
