// burnish view: a window to fly through a scene, with what each part of the picture costs and what an approximation changes.
#include <fmt/format.h>

#include <algorithm>

#include "commands.h"
#include "output.h"
#include "view_window.h"

namespace cli {
namespace {

int run(const viewer::Arguments& arguments) {
  if (!arguments.screenshot.empty())
    if (auto good = checkOutput(arguments.screenshot); !good) return printError(good.error());
  Progress progress;
  auto loaded = loadScene(arguments.scene, progress);
  if (!loaded) return progress.finish(), printError(loaded.error());
  progress.stage("opening the window");
  auto window = viewer::Window::open(arguments, *loaded);
  progress.finish();
  if (!window) return printError(window.error());
  auto done = (*window)->run();
  std::vector<std::string> warnings = warningTexts(loaded->report);
  for (std::string& text : warningTexts((*window)->report())) warnings.push_back(std::move(text));
  printWarnings(warnings);
  if (!done) return printError(done.error());
  if (arguments.frames > 0) (*window)->printSummary();
  return kOk;
}

void addSplit(CLI::App& app, viewer::Arguments& arguments) {
  app.add_option_function<std::vector<std::string>>(
         "--split",
         [&arguments](const std::vector<std::string>& words) {
           for (const std::string& word : words) {
             viewer::Other checked;
             if (auto good = viewer::addWord(checked, word); !good) throw CLI::ValidationError("--split", good.error().message());
             arguments.split.push_back(word);
           }
         },
         "opens with two qualities side by side; B has this rung, the rungs of this preset, or all of this quality file in place of A's; repeatable")
      ->type_name("TERM=RUNG|PRESET|FILE.json")
      ->type_size(1)
      ->allow_extra_args(false)
      ->take_all();
  app.add_flag("--heat", arguments.heat, "opens with A, B and a map of their difference");
}

void addPanels(CLI::App& app, viewer::Arguments& arguments) {
  std::vector<std::string> names(viewer::kPanelNames.begin(), viewer::kPanelNames.end());
  names.emplace_back("none");
  const std::string help = fmt::format("opens with this panel in place of the usual ones (none: without the sidebar); repeatable: {}", listed(names));
  app.add_option_function<std::vector<std::string>>(
         "--panel",
         [&arguments, names](const std::vector<std::string>& words) {
           for (const std::string& word : words) {
             if (std::find(names.begin(), names.end(), word) == names.end()) throw CLI::ValidationError("--panel", fmt::format("'{}' is no panel{}; there are: {}", word, didYouMean(word, names), listed(names)));
             arguments.panels.push_back(word);
           }
         },
         help)
      ->type_name("NAME")
      ->type_size(1)
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

Command addView(CLI::App& program) {
  auto arguments = std::make_shared<viewer::Arguments>();
  CLI::App* app = program.add_subcommand("view", "A window: fly camera, debug views, times, two qualities side by side");
  arguments->scene.backend = burnish::Backend::Glfw;
  arguments->scene.addTo(*app);
  const auto views = burnish::debugViewNames();
  addChoice(*app, "--view", {views.begin(), views.end()}, [arguments](std::size_t i) { arguments->debugView = burnish::DebugView(i); }, "what to draw at first");
  addSplit(*app, *arguments);
  addPanels(*app, *arguments);
  CLI::Option* frames = app->add_option("--frames", arguments->frames, "draws N frames one after the other, prints what they took, and quits")->type_name("N")->check(CLI::Range(1, 100000));
  app->add_option_function<std::string>(
         "--screenshot",
         [arguments](const std::string& text) {
           if (std::filesystem::path(text).extension() != ".png") throw CLI::ValidationError("--screenshot", fmt::format("'{}' does not end in .png", text));
           arguments->screenshot = text;
         },
         "writes what the window shows after the last of --frames")
      ->type_name("FILE.png")
      ->needs(frames);
  app->add_option("--ui-scale", arguments->uiScale, "size of text and panels; without it as the window system says")->type_name("X")->check(CLI::Range(0.5, 4.0));
  return {app, [arguments] {
            if (arguments->scene.backend == burnish::Backend::OsMesa) {
              fmt::print(stderr, "burnish: --backend: osmesa has no window: choose glfw (GLX) or egl\n");
              return int(kUsage);
            }
            return run(*arguments);
          }};
}

}  // namespace cli
