// burnish plan: what a frame of the scene does and why.
#include <burnish/plan.h>
#include <fmt/format.h>

#include "commands.h"
#include "output.h"
#include "plan_text.h"
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

Json versioned(Json plan) {
  Json out;
  out["schema_version"] = 1;
  out.update(plan);
  return out;
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
    if (auto written = writeJson(arguments.json, versioned(planJson(plan))); !written) return printError(written.error());
  if (arguments.json == "-") return kOk;
  fmt::print("{} at {}x{}, {}, on {}\n", shown(arguments.scene.scene), options.size.x, options.size.y, loaded->cameraName, capabilities.renderer);
  printPlan(plan);
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
