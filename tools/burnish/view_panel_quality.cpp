// Every term with its rungs, and the sizes.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "output.h"
#include "view_panels.h"

namespace cli::viewer {
namespace {

std::string rungHelp(const burnish::Rung& rung) {
  std::string help = fmt::format("{}: {}", rung.name, rung.what);
  if (!rung.source.empty()) help += fmt::format("\n{}", rung.source);
  if (rung.forwardOnly) help += "\nForward only: the G-buffer does not hold what it needs, so the whole frame takes the forward path.";
  return help;
}

void chooseRung(State& state, std::size_t index, const std::vector<std::string>& idle) {
  const burnish::Term& term = burnish::terms()[index];
  const std::size_t inForce = burnish::rungOf(state.quality, index);
  const burnish::Rung& rung = term.rungs[inForce];
  // "term=rung has no effect with ..."
  const std::string start = fmt::format("{}=", term.name);
  const auto why = std::find_if(idle.begin(), idle.end(), [&](const std::string& line) { return line.rfind(start, 0) == 0; });
  const bool isIdle = why != idle.end();
  ImGui::PushID(int(index));
  if (isIdle) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  const bool open = ImGui::BeginCombo("##rung", std::string(rung.name).c_str());
  if (isIdle) ImGui::PopStyleColor();
  if (!open) tooltip(rungHelp(rung) + (isIdle ? "\nIdle: " + *why : std::string()));
  if (open) {
    for (std::size_t r = 0; r < term.rungs.size(); ++r) {
      const std::string name = fmt::format("{}{}", term.rungs[r].name, term.rungs[r].forwardOnly ? " (forward only)" : "");
      if (ImGui::Selectable(name.c_str(), r == inForce)) burnish::setRung(state.quality, index, r);
      tooltip(rungHelp(term.rungs[r]));
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  if (isIdle)
    dimText(fmt::format("{} (idle)", term.name));
  else
    text(term.name);
  tooltip(term.what);
  ImGui::PopID();
}

template <class T>
void choosePower(const char* label, T& value, T from, T to, const char* help) {
  if (!ImGui::BeginCombo(label, fmt::format("{}", value).c_str())) return tooltip(help);
  for (T size = from; size <= to; size *= 2)
    if (ImGui::Selectable(fmt::format("{}", size).c_str(), size == value)) value = size;
  ImGui::EndCombo();
}

void chooseSizes(burnish::Quality& quality) {
  choosePower("shadow map", quality.shadowResolution, 128, 8192, "texels along a side of a shadow map");
  ImGui::SliderInt("cascades", &quality.shadowCascades, 1, 4);
  tooltip("shadow maps of a directional light");
  choosePower("shadow maps", quality.shadowMaps, 1, 1024, "of one view, at most");
  ImGui::DragFloat("shadow distance", &quality.shadowDistance, 0.5f, 0, 1e4f, quality.shadowDistance > 0 ? "%.1f m" : "all", ImGuiSliderFlags_AlwaysClamp);
  tooltip("from the eye, up to which directional lights have shadows; 0: as far as there is something to see");
  ImGui::SliderFloat("occlusion radius", &quality.occlusionRadius, 0.05f, 10, "%.2f m", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::SliderFloat("light threshold", &quality.lightThreshold, 1e-4f, 1, "%.4f lux", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  tooltip("irradiance under which a light without a range is cut off");
  ImGui::SliderInt("transparent layers", &quality.transparentLayers, 1, 64, "%d", ImGuiSliderFlags_AlwaysClamp);
  ImGui::SliderFloat("resolution scale", &quality.resolutionScale, 0.25f, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  tooltip("pixels that are shaded along a side, over those of the picture");
  ImGui::SliderFloat("bloom share", &quality.bloomShare, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
}

/// The file's name with a button for each way.
void chooseFile(State& state) {
  std::array<char, 512> name{};
  state.qualityFile.copy(name.data(), name.size() - 1);
  if (ImGui::InputText("file", name.data(), name.size())) state.qualityFile = name.data();
  if (ImGui::SmallButton("save")) state.saveQuality();
  tooltip("Rungs and sizes, for --quality FILE of every subcommand; the exposure is no part of it.");
  ImGui::SameLine();
  if (ImGui::SmallButton("load")) state.loadQuality();
}

}  // namespace

void qualityPanel(State& state) {
  text("preset");
  for (const std::string_view name : burnish::presetNames()) {
    ImGui::SameLine();
    if (ImGui::SmallButton(std::string(name).c_str())) (void)burnish::setPreset(state.quality, name);
  }
  if (const std::string rung = burnish::forwardOnlyRung(state.quality); !rung.empty()) wrappedDimText(fmt::format("{} needs what the G-buffer does not hold: this is the forward path, slow on purpose.", rung));
  const std::vector<std::string> idle = burnish::idleRungs(state.quality);
  for (std::size_t t = 0; t < burnish::terms().size(); ++t) chooseRung(state, t, idle);
  ImGui::Separator();
  chooseSizes(state.quality);
  ImGui::Separator();
  chooseFile(state);
}

}  // namespace cli::viewer
