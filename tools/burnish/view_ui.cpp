#define GLFW_INCLUDE_NONE
#include "view_ui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <memory>

namespace cli::viewer {
namespace {

constexpr float kTextHeight = 15;  // pixels at scale 1

/// A readable outline font where the system has one, else ImGui's own bitmap font, enlarged.
void chooseFont(float scale) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  std::error_code error;
  for (const char* file : {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"})
    if (std::filesystem::is_regular_file(file, error) && fonts.AddFontFromFileTTF(file, std::round(kTextHeight * scale))) return;
  ImFontConfig config;
  config.SizePixels = std::round(13 * scale);
  fonts.AddFontDefault(&config);
}

void chooseLook(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 3;
  style.ScrollbarSize = 12;
  style.ItemSpacing = {8, 4};
  style.FramePadding = {6, 3};
  style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.10f, 0.11f, 1};
  style.ScaleAllSizes(scale);
}

}  // namespace

burnish::Result<std::unique_ptr<Ui>> Ui::open(GLFWwindow* window, float scale) {
  std::unique_ptr<Ui> ui(new Ui);
  if (scale <= 0) {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    scale = std::max(x, y);
  }
  ui->scale_ = std::clamp(scale, 0.5f, 4.0f);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // nothing is left in the folder where the program was started
  chooseLook(ui->scale_);
  chooseFont(ui->scale_);
  ui->glfw_ = ImGui_ImplGlfw_InitForOpenGL(window, true);
  ui->openGl_ = ui->glfw_ && ImGui_ImplOpenGL3_Init("#version 330");
  if (!ui->openGl_) return burnish::fail("Dear ImGui", "it cannot draw in this window", "install the driver's libGL (apt-get install libgl1)");
  return ui;
}

Ui::~Ui() {
  if (openGl_) ImGui_ImplOpenGL3_Shutdown();
  if (glfw_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Ui::begin(bool blind) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  if (blind) ImGui::GetIO().MousePos = {-FLT_MAX, -FLT_MAX};
  ImGui::NewFrame();
}

void Ui::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void text(std::string_view words) { ImGui::TextUnformatted(words.data(), words.data() + words.size()); }

void dimText(std::string_view words) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  text(words);
  ImGui::PopStyleColor();
}

void wrappedDimText(std::string_view words) {
  ImGui::PushTextWrapPos(0);
  dimText(words);
  ImGui::PopTextWrapPos();
}

void tooltip(std::string_view words) {
  if (words.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 30);
  text(words);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool held(int key) { return !ImGui::GetIO().WantTextInput && ImGui::IsKeyDown(key); }

}  // namespace cli::viewer
