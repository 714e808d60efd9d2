// burnish plan: what a frame of the scene does and why.
#include <burnish/plan.h>
#include <fmt/format.h>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

struct PlanArguments {
  SceneOptions scene;
  std::string json;
};

/// What every OpenGL 4.5 core context can do: the least values of the specification (OpenGL 4.5 core, tables 23.53 to 23.75).
burnish::Capabilities leastCapabilities() {
  burnish::Capabilities c;
  c.renderer = "OpenGL 4.5 core as the specification demands it";
  c.major = 4;
  c.minor = 5;
  c.debugOutput = c.timerQueries = true;
  c.maxTextureSize = 16384;
  c.maxTextureUnits = 16;
  c.maxUniformBlockBytes = 16384;
  c.maxStorageBlockBytes = 1 << 27;
  c.maxTextureBufferTexels = 65536;
  return c;
}

Json toJson(const burnish::FramePlan& plan) {
  Json out;
  out["schema_version"] = 1;
  out["effects"] = Json::array();
  for (const auto& effect : plan.effects)
    out["effects"].push_back({{"name", effect.name},
                              {"on", effect.on},
                              {"called_by", effect.calledBy == burnish::CalledBy::Scene ? "scene" : "setting"},
                              {"reason", effect.reason},
                              {"passes", effect.passes},
                              {"programs", effect.programs},
                              {"targets", effect.targets},
                              {"bytes", effect.bytes}});
  out["passes"] = Json::array();
  for (const auto& pass : plan.passes) out["passes"].push_back({{"name", pass.name}, {"effects", pass.effects}, {"reads", pass.reads}, {"writes", pass.writes}, {"programs", pass.programs}});
  out["programs"] = Json::array();
  for (const auto& program : plan.programs) out["programs"].push_back(program.name);
  out["targets"] = Json::array();
  for (const auto& target : plan.targets) out["targets"].push_back({{"name", target.name}, {"format", target.format}, {"bytes", target.bytes}});
  return out;
}

std::string namesOr(const std::vector<std::string>& names, const char* none) { return names.empty() ? none : listed(names); }

/// What an effect that is on takes: " [passes; 3 programs; targets, 2.1 MB]", shared with others or not.
std::string costOf(const burnish::EffectPlan& effect) {
  std::vector<std::string> parts;
  if (!effect.passes.empty()) parts.push_back(listed(effect.passes));
  if (!effect.programs.empty()) parts.push_back(fmt::format("{} program{}", effect.programs.size(), effect.programs.size() == 1 ? "" : "s"));
  if (!effect.targets.empty()) parts.push_back(fmt::format("{}: {:.2f} MB", listed(effect.targets), double(effect.bytes) / 1e6));
  return parts.empty() ? std::string() : fmt::format(" [{}]", fmt::join(parts, "; "));
}

void print(const burnish::FramePlan& plan) {
  fmt::print("effects\n");
  for (const auto& effect : plan.effects)
    fmt::print("  {:<3} {:<24} {} ({}){}\n", effect.on ? "on" : "off", effect.name, effect.reason, effect.calledBy == burnish::CalledBy::Scene ? "scene" : "setting", costOf(effect));
  fmt::print("passes\n");
  for (const auto& pass : plan.passes) {
    fmt::print("  {:<14} reads {}; writes {}\n", pass.name, namesOr(pass.reads, "nothing"), namesOr(pass.writes, "nothing"));
    if (!pass.programs.empty()) fmt::print("  {:<14} programs {}\n", "", listed(pass.programs));
  }
  fmt::print("targets\n");
  std::uint64_t bytes = 0;
  for (const auto& target : plan.targets) {
    fmt::print("  {:<14} {:<20} {}x{} {:>12} bytes\n", target.name, target.format, target.width, target.height, target.bytes);
    bytes += target.bytes;
  }
  fmt::print("  {} bytes in all; the G-buffer has {} bytes a pixel beside depth; {} programs\n", bytes, plan.gbufferBytesPerPixel, plan.programs.size());
}

int run(const PlanArguments& arguments) {
  if (!arguments.json.empty() && arguments.json != "-")
    if (auto good = checkOutput(arguments.json); !good) return printError(good.error());
  Progress progress;
  auto loaded = loadScene(arguments.scene, progress);
  progress.finish();
  if (!loaded) return printError(loaded.error());

  std::vector<std::string> warnings = warningTexts(loaded->report);
  burnish::Capabilities capabilities = leastCapabilities();
  const auto context = openContext(arguments.scene);
  if (!context) warnings.push_back(context.error().message() + "; the plan is for " + capabilities.renderer);
  else if (auto found = burnish::queryCapabilities((*context)->procAddress())) capabilities = std::move(*found);
  else warnings.push_back(found.error().message() + "; the plan is for " + capabilities.renderer);

  const burnish::Quality quality = arguments.scene.quality();
  for (std::string& text : burnish::idleRungs(quality)) warnings.push_back("quality: " + std::move(text));
  burnish::PlanOptions options;
  options.size = arguments.scene.size;
  const auto plan = burnish::makePlan(loaded->scene, {&loaded->view, 1}, quality, capabilities, options);
  printWarnings(warnings);
  if (!arguments.json.empty())
    if (auto written = writeJson(arguments.json, toJson(plan)); !written) return printError(written.error());
  if (arguments.json == "-") return kOk;
  fmt::print("{} at {}x{}, {}, on {}\n", shown(arguments.scene.scene), options.size.x, options.size.y, loaded->cameraName, capabilities.renderer);
  print(plan);
  return kOk;
}

}  // namespace

Command addPlan(CLI::App& program) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* app = program.add_subcommand("plan", "The frame plan of a scene: its effects with reasons, passes, targets and bytes");
  arguments->scene.addTo(*app);
  app->add_option("--json", arguments->json, "write the plan as JSON (- for standard output)")->type_name("FILE");
  return {app, [arguments] { return run(*arguments); }};
}

}  // namespace cli
