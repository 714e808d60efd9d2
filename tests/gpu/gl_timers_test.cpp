// Times of passes.
#include <algorithm>

#include "gl/timers.h"
#include "gl_fixture.h"

using namespace burnish;
using namespace burnish::gl;
using burnish::test::GlFixture;

namespace {

struct Targets {
  Texture textures[2];
  Framebuffer framebuffers[2];
  explicit Targets(Device& device) {
    for (int i = 0; i < 2; ++i) {
      textures[i] = std::move(*Texture::create(device, {GL_TEXTURE_2D, GL_RGBA32F, 1024, 1024}, "target"));
      const Attachment color(textures[i]);
      framebuffers[i] = std::move(*Framebuffer::create(device, {&color, 1}, {}, "target"));
    }
  }
};

/// Two passes on framebuffers of their own: one clear, and many.
void frame(Device& device, FrameTimers& timers, const Targets& targets, Timing timing) {
  timers.beginFrame(timing);
  {
    const PassTimer pass(timers, "light");
    targets.framebuffers[0].bind();
    device.gl.Clear(GL_COLOR_BUFFER_BIT);
  }
  {
    const PassTimer pass(timers, "heavy");
    targets.framebuffers[1].bind();
    for (int i = 0; i < 20; ++i) {
      device.gl.ClearColor(float(i), 0, 0, 1);
      device.gl.Enable(GL_SCISSOR_TEST);
      device.gl.Scissor(i, 0, 1000, 1000);  // a part, so that no clear makes the ones before it needless
      device.gl.Clear(GL_COLOR_BUFFER_BIT);
      device.gl.Disable(GL_SCISSOR_TEST);
      device.gl.Flush();
    }
  }
  timers.endFrame();
  device.gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace

TEST_CASE("profile: wall and process time of each pass, at once") {
  GlFixture f;
  const Targets targets(*f.device);
  FrameTimers timers(*f.device);
  PassSample light{"", 1e9, 0}, heavy = light;  // the least of several frames: other programs run, too
  for (int i = 0; i < 8; ++i) {
    frame(*f.device, timers, targets, Timing::Profile);
    REQUIRE(timers.latest().size() == 2);
    if (timers.latest()[0].gpuMs < light.gpuMs) light = timers.latest()[0];
    if (timers.latest()[1].gpuMs < heavy.gpuMs) heavy = timers.latest()[1];
  }
  CHECK(light.name == "light");
  CHECK(heavy.name == "heavy");
  CHECK(light.gpuMs > 0);
  CHECK(heavy.gpuMs > light.gpuMs);
  CHECK(heavy.gpuMs < 60000);
  if (f.device->caps.software) CHECK(heavy.cpuMs > 0.5);  // the work is done by threads of this process
}

TEST_CASE("asynchronous: times arrive some frames later, none is waited for") {
  GlFixture f;
  const Targets targets(*f.device);
  FrameTimers timers(*f.device);
  frame(*f.device, timers, targets, Timing::Async);
  CHECK(timers.latest().empty());
  for (int i = 0; i < 100 && timers.latest().empty(); ++i) {
    frame(*f.device, timers, targets, Timing::Async);
    f.gl.Finish();  // the test waits, the timers do not
  }
  REQUIRE(timers.latest().size() == 2);
  CHECK(timers.latest()[0].name == "light");
  CHECK(timers.latest()[1].name == "heavy");
  CHECK(timers.latest()[1].gpuMs > 0);
  CHECK(timers.latest()[1].gpuMs < 60000);
}

TEST_CASE("asynchronous: more frames in flight than slots") {
  GlFixture f;
  const Targets targets(*f.device);
  FrameTimers timers(*f.device);
  for (int i = 0; i < FrameTimers::kFramesInFlight * 4; ++i) frame(*f.device, timers, targets, Timing::Async);
  f.gl.Finish();
  frame(*f.device, timers, targets, Timing::Async);
  CHECK(timers.latest().size() == 2);
}

TEST_CASE("off: nothing is measured, and stray calls are harmless") {
  GlFixture f;
  FrameTimers timers(*f.device);
  timers.begin("stray");
  timers.end();
  timers.beginFrame(Timing::Off);
  timers.begin("pass");
  timers.end();
  timers.endFrame();
  CHECK(timers.latest().empty());
  timers.beginFrame(Timing::Profile);
  timers.begin("left open");
  timers.endFrame();
  REQUIRE(timers.latest().size() == 1);
  CHECK(timers.latest()[0].name == "left open");
}
