#define GLFW_INCLUDE_NONE
// Keys and mouse: flying, and what has a key of its own.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "view_window.h"

namespace cli::viewer {
namespace {

constexpr double kRadiansPerPixel = 0.004;

double axis(int less, int more) { return double(held(more)) - double(held(less)); }

/// True while the camera moves.
bool fly(State& state, double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  bool moved = false;
  const glm::dvec3 direction(axis(GLFW_KEY_A, GLFW_KEY_D), axis(GLFW_KEY_Q, GLFW_KEY_E), axis(GLFW_KEY_S, GLFW_KEY_W));
  if (!io.KeyCtrl && direction != glm::dvec3(0)) {
    state.camera.move(direction, seconds, io.KeyShift);
    moved = true;
  }
  if (!io.WantCaptureMouse && ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
    if (io.MouseDelta.x != 0 || io.MouseDelta.y != 0) {
      state.camera.turn(-double(io.MouseDelta.x) * kRadiansPerPixel, -double(io.MouseDelta.y) * kRadiansPerPixel);
      state.follows.reset();
    }
    moved = true;
  }
  if (!io.WantCaptureMouse && io.MouseWheel != 0) state.camera.faster(double(io.MouseWheel));
  if (direction != glm::dvec3(0) && moved) state.follows.reset();
  return moved;
}

void switchLayout(State& state, Layout to) {
  state.layout = state.layout == to ? Layout::One : to;
  if (state.layout != Layout::One) state.open[std::size_t(Panel::Compare)] = true;
}

/// A key went down, with control held or not as it did so: a frame may take longer than a tap, and then both are up again.
void takeKey(State& state, const Places& places, const Press& press) {
  if (press.control) {
    if (press.key == GLFW_KEY_S) state.saveQuality();
    if (press.key == GLFW_KEY_O) state.loadQuality();
    return;
  }
  if (ImGui::GetIO().WantTextInput) return;
  switch (press.key) {
    case GLFW_KEY_F: return state.frameAll(float(std::max(places.panes[0].size.x, 1)) / float(std::max(places.panes[0].size.y, 1)));
    case GLFW_KEY_C: return switchLayout(state, Layout::Split);
    case GLFW_KEY_H: return switchLayout(state, Layout::Heat);
    case GLFW_KEY_V: state.debugView = burnish::DebugView((std::size_t(state.debugView) + 1) % burnish::debugViewNames().size()); return;
    case GLFW_KEY_L: return state.lightFromProbes(state.putAside.has_value());
    case GLFW_KEY_P: state.printCamera = true; return;
    case GLFW_KEY_F12: state.savePicture = true; return;
    case GLFW_KEY_TAB: state.showUi = !state.showUi; return;
    case GLFW_KEY_SPACE: state.playing = state.length > 0 && !state.playing; return;
  }
  const auto cameras = camerasOf(state.scene());
  const int camera = press.key - GLFW_KEY_1;
  if (camera >= 0 && camera < std::min(9, int(cameras.size()))) state.lookThrough(cameras[std::size_t(camera)].first);
}

/// True while the line between A and B is dragged.
bool dragDivider(State& state, const Places& places, bool dragging) {
  if (state.layout != Layout::Split || !state.showUi || !ImGui::IsMouseDown(ImGuiMouseButton_Left)) return false;
  const ImGuiIO& io = ImGui::GetIO();
  const float width = float(std::max(places.picture.size.x, 1));
  if (!dragging && (io.WantCaptureMouse || !ImGui::IsMouseClicked(ImGuiMouseButton_Left) || std::abs(io.MousePos.x - float(places.divider)) > 8)) return false;
  state.divider = std::clamp(io.MousePos.x / width, 0.0f, 1.0f);
  return true;
}

}  // namespace

void Window::takeInput() {
  const auto now = Clock::now();
  // A first step after a rest is no leap.
  const double seconds = moving_ || state_.playing ? std::min(std::chrono::duration<double>(now - lastFrame_).count(), 0.5) : 0.016;
  for (const Press& press : std::exchange(presses_, {})) {
    takeKey(state_, places_, press);
    if (press.control && press.key == GLFW_KEY_Q) glfwSetWindowShouldClose(static_cast<GLFWwindow*>(context_->window()), GLFW_TRUE);
  }
  dragging_ = dragDivider(state_, places_, dragging_);
  moving_ = fly(state_, seconds);
  if (state_.playing) state_.pose(std::fmod(state_.time + seconds, std::max(state_.length, 1e-6)));
}

}  // namespace cli::viewer
