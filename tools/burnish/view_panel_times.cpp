// Where the time goes: a stacked graph of the last frames, with the current medians.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view_panels.h"

namespace cli::viewer {
namespace {

/// Passes in the order of their first appearance; neighbours differ in lightness as well as in hue.
constexpr ImU32 kPassColors[] = {
    IM_COL32(86, 156, 214, 255), IM_COL32(242, 182, 80, 255), IM_COL32(120, 190, 110, 255), IM_COL32(206, 110, 170, 255), IM_COL32(150, 222, 220, 255), IM_COL32(214, 96, 77, 255),
    IM_COL32(190, 170, 240, 255), IM_COL32(160, 130, 90, 255), IM_COL32(240, 228, 120, 255), IM_COL32(110, 120, 150, 255), IM_COL32(250, 160, 140, 255), IM_COL32(70, 140, 130, 255),
};
ImU32 colorOf(std::size_t pass) { return kPassColors[pass % std::size(kPassColors)]; }

/// A round number that is not below.
double ceiling(double ms) {
  if (!(ms > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(ms)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0})
    if (step * power >= ms) return step * power;
  return 10 * power;
}

void drawGraph(const History& history, float scale) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 110 * scale};
  double most = 0;
  for (const History::Frame& frame : history.frames()) most = std::max(most, frame.total);
  const double top = ceiling(most);
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, IM_COL32(12, 13, 15, 255));
  const float column = size.x / float(History::kFrames);
  const std::size_t missing = History::kFrames - history.frames().size();
  for (std::size_t i = 0; i < history.frames().size(); ++i) {
    const History::Frame& frame = history.frames()[i];
    const bool whole = frame.size == history.frames().back().size;
    const float left = std::round(at.x + column * float(missing + i)), right = std::round(at.x + column * float(missing + i + 1));
    double sum = 0;
    for (const std::size_t pass : frame.order) {
      const float low = at.y + size.y * float(1 - sum / top);
      sum += frame.ms[pass];
      const float high = at.y + size.y * float(1 - sum / top);
      const ImU32 color = colorOf(pass);
      list.AddRectFilled({left, high}, {std::max(right - 1, left + 1), low}, whole ? color : (color & 0x00ffffffu) | 0x60000000u);
    }
  }
  for (const double share : {0.5, 1.0}) {
    const float y = at.y + size.y * float(1 - share);
    list.AddLine({at.x, y}, {at.x + size.x, y}, IM_COL32(255, 255, 255, 50));
    list.AddText({at.x + 4, y + 1}, IM_COL32(200, 200, 200, 255), fmt::format("{:.4g} ms", top * share).c_str());
  }
  ImGui::Dummy(size);
  tooltip("One column a frame, the newest at the right; a frame's passes from the bottom up. Pale columns had another size.");
}

void legendRow(ImU32 color, std::string_view name, double ms, double of) {
  ImGui::TableNextColumn();
  if (color != 0) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetFontSize() * 0.7f;
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 3}, {at.x + side, at.y + 3 + side}, color);
  }
  ImGui::Dummy({ImGui::GetFontSize() * 0.7f, 1});
  ImGui::TableNextColumn();
  text(name);
  ImGui::TableNextColumn();
  text(fmt::format("{:8.2f} ms", ms));
  ImGui::TableNextColumn();
  dimText(of > 0 ? fmt::format("{:3.0f} %", 100 * ms / of) : std::string());
}

}  // namespace

std::string_view clockName(const Pictures& pictures) {
  return pictures.onCpu() ? "CPU time of the process, finished between passes" : "GPU time";
}

void timesPanel(const Pictures& pictures, float scale) {
  const History& history = pictures.history();
  if (history.frames().empty()) return dimText("no frame was timed yet");
  drawGraph(history, scale);
  dimText(clockName(pictures));
  tooltip(pictures.onCpu() ? "A software renderer: user + system time of all its threads, with the queue emptied after each pass." : "Timer queries; they arrive some frames later.");
  if (!ImGui::BeginTable("passes", 4, ImGuiTableFlags_SizingFixedFit)) return;
  const double total = history.medianTotal();
  for (const std::size_t pass : history.frames().back().order) legendRow(colorOf(pass), history.names()[pass], history.medianOf(pass), total);
  legendRow(0, "all passes", total, 0);
  legendRow(0, "wall time", history.medianWall(), 0);
  ImGui::EndTable();
}

}  // namespace cli::viewer
