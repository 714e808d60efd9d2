#include "plan_text.h"

#include <fmt/format.h>

#include "messages.h"

namespace cli {

Json planJson(const burnish::FramePlan& plan) {
  Json out;
  out["effects"] = Json::array();
  for (const auto& effect : plan.effects)
    out["effects"].push_back({{"name", effect.name},
                              {"on", effect.on},
                              {"called_by", effect.calledBy == burnish::CalledBy::Scene ? "scene" : "setting"},
                              {"reason", effect.reason},
                              {"objects", effect.objects},
                              {"passes", effect.passes},
                              {"programs", effect.programs},
                              {"targets", effect.targets},
                              {"bytes", effect.bytes}});
  out["passes"] = Json::array();
  for (const auto& pass : plan.passes) out["passes"].push_back({{"name", pass.name}, {"reads", pass.reads}, {"writes", pass.writes}, {"effects", pass.effects}, {"programs", pass.programs}});
  out["programs"] = Json::array();
  for (const auto& program : plan.programs) out["programs"].push_back(program.name);
  out["targets"] = Json::array();
  for (const auto& target : plan.targets) out["targets"].push_back({{"name", target.name}, {"format", target.format}, {"layers", target.layers}, {"bytes", target.bytes}});
  return out;
}

namespace {
std::string namesOr(const std::vector<std::string>& names, const char* none) { return names.empty() ? none : listed(names); }

std::string callerOf(const burnish::EffectPlan& effect) {
  if (effect.calledBy == burnish::CalledBy::Setting) return "setting";
  return effect.objects > 1 ? fmt::format("scene, {} objects", effect.objects) : "scene";
}
}  // namespace

std::string costOf(const burnish::EffectPlan& effect) {
  std::vector<std::string> parts;
  if (!effect.passes.empty()) parts.push_back(listed(effect.passes));
  if (!effect.programs.empty()) parts.push_back(fmt::format("{} program{}", effect.programs.size(), effect.programs.size() == 1 ? "" : "s"));
  if (!effect.targets.empty()) parts.push_back(fmt::format("{}: {:.2f} MB", listed(effect.targets), double(effect.bytes) / 1e6));
  return parts.empty() ? std::string() : fmt::format(" [{}]", fmt::join(parts, "; "));
}

void printPlan(const burnish::FramePlan& plan) {
  fmt::print("effects\n");
  for (const auto& effect : plan.effects)
    fmt::print("  {:<3} {:<24} {} ({}){}\n", effect.on ? "on" : "off", effect.name, effect.reason, callerOf(effect), costOf(effect));
  fmt::print("passes\n");
  for (const auto& pass : plan.passes) {
    fmt::print("  {:<14} reads {}; writes {}\n", pass.name, namesOr(pass.reads, "nothing"), namesOr(pass.writes, "nothing"));
    if (!pass.programs.empty()) fmt::print("  {:<14} programs {}\n", "", listed(pass.programs));
  }
  fmt::print("targets\n");
  std::uint64_t bytes = 0;
  for (const auto& target : plan.targets) {
    fmt::print("  {:<14} {:<20} {}x{}{} {:>12} bytes\n", target.name, target.format, target.width, target.height, target.layers > 0 ? fmt::format("x{}", target.layers) : std::string(), target.bytes);
    bytes += target.bytes;
  }
  fmt::print("  {} bytes in all; the G-buffer has {} bytes a pixel beside depth; {} programs\n", bytes, plan.gbufferBytesPerPixel, plan.programs.size());
}

}  // namespace cli
