// The plan of the last frame: each effect with its reason, passes and targets.
#include <fmt/format.h>

#include <algorithm>

#include "view_panels.h"

namespace cli::viewer {
namespace {

std::string callerOf(const burnish::EffectPlan& effect) {
  if (effect.calledBy == burnish::CalledBy::Setting) return "setting";
  return effect.objects > 0 ? fmt::format("scene: {} object{}", effect.objects, effect.objects == 1 ? "" : "s") : "scene";
}

std::string bytesText(std::uint64_t bytes) {
  if (bytes == 0) return {};
  if (bytes < 1000) return fmt::format("{} B", bytes);
  return bytes < 1'000'000 ? fmt::format("{:.1f} kB", double(bytes) / 1e3) : fmt::format("{:.1f} MB", double(bytes) / 1e6);
}

void effectRow(const burnish::EffectPlan& effect) {
  ImGui::TableNextColumn();
  if (effect.on)
    text(effect.name);
  else
    dimText(effect.name);
  ImGui::TableNextColumn();
  dimText(effect.on ? bytesText(effect.bytes) : "off");
  ImGui::TableNextColumn();
  std::string more = fmt::format("{} ({})", effect.reason, callerOf(effect));
  if (!effect.passes.empty()) more += fmt::format("\npasses: {}", listed(effect.passes));
  wrappedDimText(more);
  if (!effect.programs.empty() || !effect.targets.empty()) tooltip(fmt::format("programs: {}\ntargets: {}", listed(effect.programs), listed(effect.targets)));
}

void effects(const burnish::FramePlan& plan, bool on) {
  if (!ImGui::BeginTable(on ? "on" : "off", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) return;
  float widest = 0;
  for (const burnish::EffectPlan& effect : plan.effects) widest = std::max(widest, effect.on == on ? ImGui::CalcTextSize(effect.name.c_str()).x : 0);
  ImGui::TableSetupColumn("effect", ImGuiTableColumnFlags_WidthFixed, widest);
  ImGui::TableSetupColumn("bytes", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("000.0 MB").x);
  ImGui::TableSetupColumn("why", ImGuiTableColumnFlags_WidthStretch);
  for (const burnish::EffectPlan& effect : plan.effects) {
    if (effect.on != on) continue;
    ImGui::TableNextRow();
    effectRow(effect);
  }
  ImGui::EndTable();
}

void passes(const burnish::FramePlan& plan) {
  for (const burnish::PassPlan& pass : plan.passes) {
    text(pass.name);
    tooltip(fmt::format("reads {}\nwrites {}\nprograms {}\ncalled by {}", listed(pass.reads), listed(pass.writes), listed(pass.programs), listed(pass.effects)));
  }
}

}  // namespace

void planPanel(const Pictures& pictures) {
  const burnish::FramePlan& plan = pictures.plan();
  std::uint64_t bytes = 0;
  for (const burnish::TargetPlan& target : plan.targets) bytes += target.bytes;
  dimText(fmt::format("{} passes, {} programs, {} of targets", plan.passes.size(), plan.programs.size(), bytesText(bytes)));
  dimText(fmt::format("G-buffer: {} bytes a pixel beside depth", plan.gbufferBytesPerPixel));
  effects(plan, true);
  if (ImGui::TreeNode("effects that are off")) {
    effects(plan, false);
    ImGui::TreePop();
  }
  if (ImGui::TreeNode("passes")) {
    passes(plan);
    ImGui::TreePop();
  }
}

}  // namespace cli::viewer
