#include "view_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cli::viewer {
namespace {

constexpr int kSidebar = 390;  // pixels at scale 1

ImVec2 toImGui(const Places& places, glm::ivec2 at) { return {float(at.x), float(places.window.y - at.y)}; }

/// Text with a dark ground, so that it reads over any picture.
void label(ImVec2 at, std::string_view words, ImU32 color) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(words.data(), words.data() + words.size());
  list.AddRectFilled({at.x - 5, at.y - 3}, {at.x + size.x + 5, at.y + size.y + 3}, IM_COL32(0, 0, 0, 170), 3);
  list.AddText(at, color, words.data(), words.data() + words.size());
}

/// What fits into a width, with an ellipsis where something is cut off.
std::string fitted(std::string words, float width) {
  if (ImGui::CalcTextSize(words.c_str()).x <= width) return words;
  while (!words.empty() && ImGui::CalcTextSize((words + "...").c_str()).x > width) words.pop_back();
  return words + "...";
}

void drawDivider(const Places& places) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImGuiIO& io = ImGui::GetIO();
  const float x = float(places.picture.at.x + places.divider), top = 0, bottom = float(places.window.y);
  const bool near = !io.WantCaptureMouse && std::abs(io.MousePos.x - x) < 7;
  if (near || ImGui::GetMouseCursor() == ImGuiMouseCursor_ResizeEW) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  list.AddRectFilled({x - 1, top}, {x + 1, bottom}, IM_COL32(255, 255, 255, 220));
  list.AddRectFilled({x - 4, bottom / 2 - 20}, {x + 4, bottom / 2 + 20}, IM_COL32(255, 255, 255, 220), 4);
}

/// The map's colours with numbers: shares of the exposure's white.
void drawColorBar(ImVec2 at, float width, double scale) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float height = ImGui::GetFontSize();
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 c = heatColor(double(i) / (kSteps - 1));
    const float left = at.x + width * float(i) / kSteps, right = at.x + width * float(i + 1) / kSteps;
    list.AddRectFilled({left, at.y}, {right, at.y + height}, ImGui::ColorConvertFloat4ToU32({float(c.x), float(c.y), float(c.z), 1}));
  }
  for (int i = 0; i <= 4; ++i) {
    const std::string number = fmt::format("{:.3g}", scale * i / 4);
    const float x = at.x + width * float(i) / 4, w = ImGui::CalcTextSize(number.c_str()).x;
    list.AddLine({x, at.y + height}, {x, at.y + height + 4}, IM_COL32(200, 200, 200, 255));
    list.AddText({std::clamp(x - w / 2, at.x, at.x + width - w), at.y + height + 5}, IM_COL32(220, 220, 220, 255), number.c_str());
  }
}

/// The last quarter: the scale of the map, costs and error.
void drawFigures(const State& state, const Pictures& pictures, const Places& places) {
  const Rect heat = places.panes[2];
  ImGui::SetNextWindowPos(toImGui(places, {heat.at.x + heat.size.x, heat.at.y + heat.size.y}));
  ImGui::SetNextWindowSize({float(places.picture.size.x - heat.size.x), float(heat.size.y)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {12, 10});
  ImGui::Begin("figures", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  if (const auto& difference = pictures.difference()) {
    text("difference, share of the exposure's white");
    drawColorBar(ImGui::GetCursorScreenPos(), ImGui::GetContentRegionAvail().x, difference->scale);
    ImGui::Dummy({1, ImGui::GetFontSize() * 2 + 14});
  }
  comparisonTable(state, pictures);
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace

Places placesFor(const State& state, glm::ivec2 window, float scale) {
  Places places;
  places.window = glm::max(window, glm::ivec2(1));
  places.sidebar = state.showUi ? std::min(int(std::lround(kSidebar * double(scale))), places.window.x / 2) : 0;
  places.picture = {{0, 0}, {places.window.x - places.sidebar, places.window.y}};
  const glm::ivec2 size = places.picture.size;
  places.divider = std::clamp(int(std::lround(double(state.divider) * size.x)), 0, size.x);
  places.panes = {places.picture, places.picture, Rect{}};
  if (state.layout == Layout::Heat) {
    const glm::ivec2 quarter = glm::max(size / 2, glm::ivec2(1));
    places.panes = {Rect{{0, size.y - quarter.y}, quarter}, Rect{{quarter.x, size.y - quarter.y}, quarter}, Rect{{0, size.y - 2 * quarter.y}, quarter}};
  }
  return places;
}

void drawOverlay(const State& state, const Pictures& pictures, const Places& places) {
  if (!state.showUi) return;
  if (state.layout == Layout::Split) {
    drawDivider(places);
    const float left = float(places.divider) - 20, right = float(places.picture.size.x - places.divider) - 20;
    if (left > 40) label({10, 8}, fitted("A  " + std::string("as set"), left), kColorA);
    if (right > 40) label({float(places.divider) + 12, 8}, fitted("B  " + state.other.name(), right), kColorB);
  }
  if (state.layout == Layout::Heat) {
    const float width = float(places.panes[0].size.x) - 20;
    const auto corner = [&](int pane) { return toImGui(places, places.panes[std::size_t(pane)].at + glm::ivec2(10, places.panes[std::size_t(pane)].size.y - 8)); };
    label(corner(0), fitted("A  as set", width), kColorA);
    label(corner(1), fitted("B  " + state.other.name(), width), kColorB);
    label(corner(2), fitted("|B - A|", width), IM_COL32(230, 230, 230, 255));
    drawFigures(state, pictures, places);
  }
}

void drawSidebar(State& state, Pictures& pictures, const Places& places) {
  if (places.sidebar <= 0) return;
  ImGui::SetNextWindowPos({float(places.window.x - places.sidebar), 0});
  ImGui::SetNextWindowSize({float(places.sidebar), float(places.window.y)});
  ImGui::Begin("sidebar", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (!state.message.empty()) {
    ImGui::PushTextWrapPos(0);
    text(state.message);
    ImGui::PopTextWrapPos();
    ImGui::Separator();
  }
  const float scale = ImGui::GetFontSize() / 15;
  for (std::size_t i = 0; i < kPanelNames.size(); ++i) {
    ImGui::SetNextItemOpen(state.open[i]);
    ImGui::PushID(int(i));
    state.open[i] = ImGui::CollapsingHeader(std::string(kPanelNames[i]).c_str());
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.56f);
    if (state.open[i]) {
      switch (Panel(i)) {
        case Panel::Picture: picturePanel(state, pictures); break;
        case Panel::Quality: qualityPanel(state); break;
        case Panel::Times: timesPanel(pictures, scale); break;
        case Panel::Plan: planPanel(pictures); break;
        case Panel::Compare: comparePanel(state, pictures); break;
        case Panel::Keys: keysPanel(); break;
      }
      ImGui::Dummy({1, 4});
    }
    ImGui::PopItemWidth();
    ImGui::PopID();
  }
  ImGui::End();
}

void keysPanel() {
  constexpr std::pair<const char*, const char*> kKeys[] = {
      {"W A S D", "forward, left, back, right"}, {"Q E", "down, up"},          {"Shift", "four times as fast"},
      {"right mouse", "look around"},            {"wheel", "flying speed"},    {"F", "the whole scene in view"},
      {"1 to 9", "the scene's cameras"},         {"Space", "animation on, off"}, {"C", "compare: A | B"},
      {"H", "A, B and their difference"},        {"V", "the next debug view"}, {"P", "print the camera's options"},
      {"L", "light from probes"},              {"Ctrl S", "save the quality"},  {"Ctrl O", "load the quality"},
      {"F12", "save the picture as PNG"},        {"Tab", "this sidebar"},      {"Ctrl Q", "quit"},
  };
  if (!ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) return;
  for (const auto& [key, what] : kKeys) {
    ImGui::TableNextColumn();
    text(key);
    ImGui::TableNextColumn();
    dimText(what);
  }
  ImGui::EndTable();
}

}  // namespace cli::viewer
