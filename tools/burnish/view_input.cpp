#define GLFW_INCLUDE_NONE
// Keys and mouse: flying, and what has a key of its own.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

/// `presses`: keys that went down since the last frame. ImGui alone would miss those that are up again: a frame may take longer than a tap.
void takeKeys(State& state, const Places& places, const std::vector<int>& presses) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl || io.WantTextInput) return;
  const auto press = [&presses](int key) { return std::find(presses.begin(), presses.end(), key) != presses.end(); };
  const float aspect = float(std::max(places.panes[0].size.x, 1)) / float(std::max(places.panes[0].size.y, 1));
  if (press(GLFW_KEY_F)) state.frameAll(aspect);
  if (press(GLFW_KEY_C)) switchLayout(state, Layout::Split);
  if (press(GLFW_KEY_H)) switchLayout(state, Layout::Heat);
  if (press(GLFW_KEY_V)) state.debugView = burnish::DebugView((std::size_t(state.debugView) + 1) % burnish::debugViewNames().size());
  if (press(GLFW_KEY_P)) state.printCamera = true;
  if (press(GLFW_KEY_F12)) state.savePicture = true;
  if (press(GLFW_KEY_TAB)) state.showUi = !state.showUi;
  if (press(GLFW_KEY_SPACE) && state.length > 0) state.playing = !state.playing;
  const auto cameras = camerasOf(state.scene());
  for (int i = 0; i < 9 && i < int(cameras.size()); ++i)
    if (press(GLFW_KEY_1 + i)) state.lookThrough(cameras[std::size_t(i)].first);
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
  takeKeys(state_, places_, std::exchange(presses_, {}));
  dragging_ = dragDivider(state_, places_, dragging_);
  moving_ = fly(state_, seconds);
  if (state_.playing) state_.pose(std::fmod(state_.time + seconds, std::max(state_.length, 1e-6)));
  if (ImGui::GetIO().KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Q, false)) glfwSetWindowShouldClose(static_cast<GLFWwindow*>(context_->window()), GLFW_TRUE);
}

}  // namespace cli::viewer
