// Two qualities side by side: what B changes, what both cost, how far they are apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view_panels.h"

namespace cli::viewer {
namespace {

/// Four digits, so that two of them fit side by side.
std::string number(double ms, const char* sign = "") { return fmt::format(fmt::runtime(fmt::format("{{:{}.{}f}}", sign, std::abs(ms) >= 1000 ? 0 : std::abs(ms) >= 100 ? 1 : 2)), ms); }
std::string spreadText(const Middle& m) { return m.count == 0 ? "..." : fmt::format("{} [{}, {}]", number(m.median), number(m.low), number(m.high)); }
std::string gapText(const Middle& m) { return m.count == 0 ? "..." : fmt::format("{} [{}, {}]", number(m.median, "+"), number(m.low, "+"), number(m.high, "+")); }

struct Row {
  std::string what, a, b;
};
std::vector<Row> costRows(const Pictures& pictures) {
  const Duel& duel = pictures.duel();
  std::vector<Row> rows{{"frame", spreadText(duel.frame(0)), spreadText(duel.frame(1))}};
  if (!pictures.changed().empty()) rows.push_back({"changed", spreadText(duel.changed(0)), spreadText(duel.changed(1))});
  return rows;
}

std::vector<std::string> errorLines(const State& state, const Pictures& pictures) {
  const auto& difference = pictures.difference();
  if (!difference) return {"error: ..."};
  std::vector<std::string> lines{fmt::format("rms of B - A: {:.3g} % of A's", 100 * difference->rms), fmt::format("B's energy: {:+.3g} %", 100 * difference->energy),
                                 fmt::format("pixels over {:.3g} of white: {:.3g} %", state.threshold, 100 * difference->over), fmt::format("largest: {:.3g} of white", difference->largest)};
  if (difference->skipped > 0) lines.push_back(fmt::format("{} pixels are not finite (magenta)", difference->skipped));
  return lines;
}

void tableCell(std::string_view words, ImU32 color) {
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  text(words);
  ImGui::PopStyleColor();
}

/// The set's term and rung; true when it is to be taken away.
bool editSet(Other::Set& set) {
  const auto terms = burnish::terms();
  std::vector<std::string_view> names;
  for (const burnish::Term& term : terms) names.push_back(term.name);
  const float third = ImGui::GetContentRegionAvail().x * 0.44f;
  ImGui::SetNextItemWidth(third);
  if (combo("##term", set.term, names)) set.rung = terms[set.term].rungs.size() - 1;
  tooltip(terms[set.term].what);
  ImGui::SameLine();
  names.clear();
  for (const burnish::Rung& rung : terms[set.term].rungs) names.push_back(rung.name);
  ImGui::SetNextItemWidth(third);
  combo("##rung", set.rung, names);
  tooltip(terms[set.term].rungs[set.rung].what);
  ImGui::SameLine();
  return ImGui::SmallButton("x");
}

void chooseOther(Other& other) {
  if (other.file) {
    text(other.fileName);
    ImGui::SameLine();
    if (ImGui::SmallButton("x##file")) other.file.reset();
  }
  std::vector<std::string> presets{other.file ? "the file's" : "A's"};
  for (const std::string_view name : burnish::presetNames()) presets.emplace_back(name);
  combo("B's rungs", other.preset, presets);
  tooltip("A's own rungs (or a quality file's, --split FILE.json), or those of a preset; below: what B has in their place");
  for (std::size_t i = 0; i < other.sets.size(); ++i) {
    ImGui::PushID(int(i));
    const bool remove = editSet(other.sets[i]);
    ImGui::PopID();
    if (remove) other.sets.erase(other.sets.begin() + std::ptrdiff_t(i--));
  }
  if (ImGui::SmallButton("+ rung")) other.sets.push_back({0, burnish::terms()[0].rungs.size() - 1});
}

void chooseScale(State& state) {
  constexpr std::array<double, 6> kScales{0, 0.001, 0.01, 0.03, 0.1, 1};
  std::vector<std::string> names;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < kScales.size(); ++i) {
    names.push_back(i == 0 ? "automatic" : fmt::format("{:g} of white", kScales[i]));
    if (state.heatScale == kScales[i]) chosen = i;
  }
  if (combo("map's scale", chosen, names)) state.heatScale = kScales[chosen];
  auto threshold = float(state.threshold);
  if (ImGui::SliderFloat("threshold", &threshold, 1e-4f, 1, "%.4f of white", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) state.threshold = double(threshold);
}

}  // namespace

std::vector<std::string> comparisonLines(const State& state, const Pictures& pictures) {
  const Duel& duel = pictures.duel();
  std::vector<std::string> lines;
  for (const Row& row : costRows(pictures)) lines.push_back(fmt::format("{}: A {} ms, B {} ms", row.what, row.a, row.b));
  lines.push_back(fmt::format("B - A: {} ms, of {} pairs", gapText(duel.gap()), duel.gap().count));
  lines.push_back(pictures.changed().empty() ? "the plans are the same" : fmt::format("passes that differ: {}", listed(pictures.changed())));
  for (std::string& line : errorLines(state, pictures)) lines.push_back(std::move(line));
  return lines;
}

void comparisonTable(const State& state, const Pictures& pictures) {
  const Duel& duel = pictures.duel();
  if (ImGui::BeginTable("costs", 3, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_BordersInnerH)) {
    tableCell("ms", ImGui::GetColorU32(ImGuiCol_TextDisabled));
    tableCell("A", kColorA);
    tableCell("B", kColorB);
    for (const Row& row : costRows(pictures)) {
      tableCell(row.what, ImGui::GetColorU32(ImGuiCol_Text));
      tableCell(row.a, ImGui::GetColorU32(ImGuiCol_Text));
      tableCell(row.b, ImGui::GetColorU32(ImGuiCol_Text));
    }
    ImGui::EndTable();
  }
  text(fmt::format("B - A {}, {} pairs", gapText(duel.gap()), duel.gap().count));
  tooltip("Median and quartiles over pairs of frames that followed each other: A, B, A, B.");
  wrappedDimText(pictures.changed().empty() ? "the plans are the same" : fmt::format("changed: {}", listed(pictures.changed())));
  dimText(clockName(pictures));
  ImGui::Dummy({1, 4});
  for (const std::string& line : errorLines(state, pictures)) text(line);
}

void comparePanel(State& state, Pictures& pictures) {
  auto layout = int(state.layout);
  ImGui::RadioButton("A", &layout, int(Layout::One));
  ImGui::SameLine();
  ImGui::RadioButton("A | B", &layout, int(Layout::Split));
  tooltip("Drag the line between them (C).");
  ImGui::SameLine();
  ImGui::RadioButton("difference", &layout, int(Layout::Heat));
  tooltip("A, B, where they differ and by how much (H)");
  state.layout = Layout(layout);
  chooseOther(state.other);
  if (state.layout == Layout::One) return;
  chooseScale(state);
  if (state.layout == Layout::Split) comparisonTable(state, pictures);
  if (ImGui::SmallButton("measure again")) pictures.measureAgain();
}

}  // namespace cli::viewer
