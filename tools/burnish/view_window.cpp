#define GLFW_INCLUDE_NONE
#include "view_window.h"

#include <GLFW/glfw3.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <thread>

#include "output.h"

namespace cli::viewer {
using burnish::fail;
using burnish::Result;

namespace {

constexpr double kQuietSeconds = 0.25;  // without an event before a picture is drawn again just to time it
constexpr int kAwakeFrames = 3;         // ImGui takes up to three frames to answer an event
constexpr auto kFrameTime = std::chrono::milliseconds(16);

Window& ownerOf(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

/// How much coarser than the window moving pictures are, so that some ten of them fit into a second.
int shrinkFor(double fullMs) { return fullMs < 80 ? 1 : fullMs < 350 ? 2 : 4; }

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const Arguments& arguments, LoadedScene& loaded) {
  std::unique_ptr<Window> window(new Window(arguments, loaded));
  burnish::ContextOptions options;
  options.backend = burnish::Backend::Glfw;
  options.glfwEgl = arguments.scene.backend == burnish::Backend::Egl;
  options.width = arguments.scene.size.x;
  options.height = arguments.scene.size.y;
  const std::string title = "burnish - " + shown(arguments.scene.scene);
  options.title = title.c_str();
  auto context = burnish::Context::create(options);
  if (!context && !std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return fail("view", "no X display", "set DISPLAY, or run it under xvfb-run -a");
  if (!context) return fail(context.error());
  window->context_ = std::move(*context);
  const burnish::ProcAddress address = window->context_->procAddress();
  auto renderer = burnish::Renderer::create(address, {});
  if (!renderer) return fail(renderer.error());
  window->renderer_ = std::move(*renderer);
  auto gl = Gl::load(address);
  if (!gl) return fail(gl.error());
  window->gl_ = std::move(*gl);
  window->heat_ = std::make_unique<Canvas>(*window->gl_);
  window->listen();
  auto ui = Ui::open(static_cast<GLFWwindow*>(window->context_->window()), arguments.uiScale);
  if (!ui) return fail(ui.error());
  window->ui_ = std::move(*ui);
  window->pictures_ = std::make_unique<Pictures>(address, *window->renderer_);
  if (!window->renderer_->capabilities().software && !window->scripted()) glfwSwapInterval(1);
  return window;
}

Window::~Window() = default;

/// Every event wakes the loop. ImGui calls these before its own.
void Window::listen() {
  auto* window = static_cast<GLFWwindow*>(context_->window());
  glfwSetWindowUserPointer(window, this);
  static constexpr auto wake = [](GLFWwindow* of) {
    ownerOf(of).awake_ = kAwakeFrames;
    ownerOf(of).lastEvent_ = Clock::now();
  };
  glfwSetKeyCallback(window, [](GLFWwindow* of, int key, int, int action, int modifiers) {
    wake(of);
    if (action == GLFW_PRESS) ownerOf(of).presses_.push_back({key, (modifiers & GLFW_MOD_CONTROL) != 0});
  });
  glfwSetCharCallback(window, [](GLFWwindow* of, unsigned) { wake(of); });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* of, int, int, int) { wake(of); });
  glfwSetCursorPosCallback(window, [](GLFWwindow* of, double, double) { wake(of); });
  glfwSetCursorEnterCallback(window, [](GLFWwindow* of, int) { wake(of); });
  glfwSetScrollCallback(window, [](GLFWwindow* of, double, double) { wake(of); });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* of, int) { wake(of); });
  glfwSetWindowRefreshCallback(window, [](GLFWwindow* of) { wake(of); });
  glfwSetFramebufferSizeCallback(window, [](GLFWwindow* of, int, int) { wake(of); });
}

Wanted Window::wanted() const {
  Wanted wanted;
  wanted.view = state_.camera.view();
  wanted.a = state_.quality;
  wanted.b = state_.layout == Layout::One ? state_.quality : state_.otherQuality();
  wanted.debugView = state_.debugView;
  wanted.size = places_.panes[0].size;
  wanted.layout = state_.layout;
  wanted.heatScale = state_.heatScale;
  wanted.threshold = state_.threshold;
  wanted.moment = state_.moment;
  return wanted;
}

/// Waits for an event where nothing is left to do. False: there was none, and nothing has to be drawn.
bool Window::waitForWork() {
  const bool busy = scripted() || awake_ > 0 || moving_ || state_.playing || state_.continuous;
  if (busy) {
    // Software renderers do not wait for the screen.
    if (!scripted()) std::this_thread::sleep_until(lastFrame_ + kFrameTime);
    glfwPollEvents();
  } else {
    // A picture that is still to be timed waits until the hand rests; everything else waits for events alone.
    const bool settled = pictures_->settled(wanted());
    glfwWaitEventsTimeout(settled ? 10.0 : 0.02);
    if (!settled) return true;
  }
  return busy || awake_ > 0;
}

Result<void> Window::drawPictures() {
  const Wanted now = wanted();
  if (places_.panes[0].empty()) return {};
  const bool fresh = pictures_->shows(now);
  const bool quiet = std::chrono::duration<double>(Clock::now() - lastEvent_).count() > kQuietSeconds;
  if (fresh && !scripted() && !state_.continuous && (pictures_->settled(now) || !quiet)) return {};
  const bool coarse = pictures_->onCpu() && state_.smallWhileMoving && !scripted() && !fresh && (moving_ || state_.playing || ImGui::IsAnyItemActive());
  auto drawn = pictures_->draw(state_.scene(), now, coarse ? shrinkFor(fullMs_) : 1);
  if (!drawn) {
    // The window stays, so that the setting can be taken back.
    state_.message = drawn.error().message();
    return scripted() ? drawn : Result<void>();
  }
  if (pictures_->shrink() == 1) fullMs_ = pictures_->lastMs();
  return {};
}

void Window::showPictures() {
  gl_->clear(places_.window, {0.09f, 0.10f, 0.11f});
  for (int i = 0; i < (state_.layout == Layout::One ? 1 : 2); ++i) {
    const burnish::Target from = pictures_->picture(i);
    Rect to = places_.panes[std::size_t(i)], part{{0, 0}, from.size};
    if (state_.layout == Layout::Split && to.size.x > 0) {
      // In pixels of the window, then of the picture, which may be coarser.
      const int begin = i == 0 ? 0 : places_.divider, end = i == 0 ? places_.divider : to.size.x;
      part = {{begin * from.size.x / to.size.x, 0}, {end * from.size.x / to.size.x - begin * from.size.x / to.size.x, from.size.y}};
      to = {{to.at.x + begin, to.at.y}, {end - begin, to.size.y}};
    }
    gl_->blit(from.framebuffer, part, to, part.size != to.size);
  }
  if (state_.layout != Layout::Heat || !pictures_->difference()) return;
  if (heatOf_ != pictures_->framesDrawn()) heat_->upload(pictures_->difference()->heat);
  heatOf_ = pictures_->framesDrawn();
  gl_->blit(heat_->framebuffer(), {{0, 0}, heat_->size()}, places_.panes[2], heat_->size() != places_.panes[2].size);
}

void Window::drawUi() {
  drawSidebar(state_, *pictures_, places_);
  drawOverlay(state_, *pictures_, places_);
  ui_->end();
}

Result<void> Window::run() {
  for (int frames = 0;;) {
    if (!waitForWork()) {
      if (glfwWindowShouldClose(static_cast<GLFWwindow*>(context_->window()))) return {};
      continue;
    }
    if (awake_ > 0) --awake_;
    ui_->begin(scripted());  // what a script draws does not depend on where the pointer is
    takeInput();
    glm::ivec2 size(0);
    glfwGetFramebufferSize(static_cast<GLFWwindow*>(context_->window()), &size.x, &size.y);
    places_ = placesFor(state_, size, ui_->scale());
    if (auto drawn = drawPictures(); !drawn) return ImGui::EndFrame(), drawn;
    showPictures();
    if (std::exchange(state_.savePicture, false)) savePicture();
    if (std::exchange(state_.printCamera, false)) printCamera();
    drawUi();
    lastFrame_ = Clock::now();
    const bool last = scripted() && ++frames >= arguments_.frames;
    if (last && !arguments_.screenshot.empty())
      if (auto saved = saveScreenshot(); !saved) return saved;
    if (!context_->present() || last) return {};
  }
}

Result<void> Window::saveScreenshot() { return writePicture(arguments_.screenshot, gl_->readWindow({{0, 0}, places_.window})); }

/// The pictures as they stand in the window, before anything is written over them.
void Window::savePicture() {
  const std::string stem = fmt::format("burnish-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::string file = stem + ".png";
  for (int more = 2; std::filesystem::exists(file); ++more) file = fmt::format("{}-{}.png", stem, more);  // of the same second
  auto good = checkOutput(file);
  if (good) good = writePicture(file, gl_->readWindow(places_.picture));
  state_.message = good ? "saved " + file : good.error().message();
}

void Window::printCamera() {
  const std::string options = state_.camera.options();
  state_.message = options.empty() ? "--eye and --target cannot say an orthographic view" : options;
  if (options.empty()) return;
  glfwSetClipboardString(static_cast<GLFWwindow*>(context_->window()), options.c_str());
  fmt::print("{}\n", options);
  std::fflush(stdout);
}

void Window::printSummary() const {
  const burnish::Capabilities& machine = renderer_->capabilities();
  fmt::print("window {}x{}, pictures {}x{}, {}\n", places_.window.x, places_.window.y, pictures_->drawn().size.x, pictures_->drawn().size.y, shown(machine.renderer));
  const History& history = pictures_->history();
  if (!history.frames().empty()) fmt::print("frame: {:.2f} ms ({}), {:.2f} ms wall\n", history.medianTotal(), clockName(*pictures_), history.medianWall());
  if (state_.layout == Layout::One) return;
  fmt::print("B: {}\n", state_.other.name());
  for (const std::string& line : comparisonLines(state_, *pictures_)) fmt::print("{}\n", line);
}

}  // namespace cli::viewer
