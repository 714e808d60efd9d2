// Dear ImGui over a GLFW window, and its words in this program's look.
#pragma once
#include <burnish/result.h>
#include <imgui.h>

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <string_view>

struct GLFWwindow;

namespace cli::viewer {

/// ImGui's context with its GLFW and OpenGL sides. One at a time, on the main thread.
class Ui {
 public:
  /// `scale`: 0 asks the window system how large text has to be.
  static burnish::Result<std::unique_ptr<Ui>> open(GLFWwindow* window, float scale);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;
  /// A frame's events are known from here on. `blind`: the mouse is nowhere.
  void begin(bool blind);
  void end();    ///< draws onto framebuffer 0
  [[nodiscard]] float scale() const { return scale_; }  ///< 1: a character is 15 pixels high

 private:
  Ui() = default;
  float scale_ = 1;
  bool glfw_ = false, openGl_ = false;
};

/// A line of text, as it is: nothing in it is a format.
void text(std::string_view words);
void dimText(std::string_view words);      ///< for what explains
void wrappedDimText(std::string_view words);
/// Shown while the mouse rests on the last item.
void tooltip(std::string_view words);
/// A key is down (GLFW's number), and no text is being typed.
bool held(int key);

/// A combo box over names. True when another was chosen.
template <class Names>
bool combo(const char* label, std::size_t& chosen, const Names& names) {
  bool changed = false;
  const std::string shownName(chosen < names.size() ? names[chosen] : "");
  if (!ImGui::BeginCombo(label, shownName.c_str())) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    ImGui::PushID(int(i));
    if (ImGui::Selectable(std::string(names[i]).c_str(), i == chosen)) chosen = i, changed = true;
    ImGui::PopID();
  }
  ImGui::EndCombo();
  return changed;
}

}  // namespace cli::viewer
