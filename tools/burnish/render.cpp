// burnish render: one picture, headless.
#include <burnish/renderer.h>
#include <fmt/format.h>

#include "commands.h"
#include "output.h"
#include "render_report.h"
#include "scene_options.h"

namespace cli {
namespace {
using burnish::fail;
using burnish::Result;

constexpr int kUnmeasuredFrames = 2;  // the first compiles and uploads, the second has its timer queries still under way
constexpr int kTemporalFrames = 16;   // of one picture with antialiasing over time, unless --frames says otherwise
constexpr int kMostLateFrames = 4;    // after the last measured frame, to let its timer queries arrive

struct RenderArguments {
  SceneOptions scene;
  std::string output, json;
  burnish::DebugView debugView = burnish::DebugView::Final;
  int frames = 0;  ///< 0: not asked for
  bool profile = false, listRungs = false;

  [[nodiscard]] bool timed() const { return frames > 0 || profile || !json.empty(); }
  [[nodiscard]] burnish::Output outputKind() const {
    return std::filesystem::path(output).extension() == ".exr" ? burnish::Output::Linear : burnish::Output::Display;
  }
};

/// Everything that lives in the context.
struct Session {
  std::unique_ptr<burnish::Context> context;
  std::unique_ptr<burnish::Renderer> renderer;
  std::unique_ptr<burnish::OffscreenTarget> target;
  void (*finish)() = nullptr;  ///< glFinish
};

Result<Session> open(const RenderArguments& arguments) {
  Session session;
  auto context = openContext(arguments.scene);
  if (!context) return fail(context.error());
  session.context = std::move(*context);
  const burnish::ProcAddress address = session.context->procAddress();
  session.finish = reinterpret_cast<void (*)()>(address("glFinish"));
  burnish::RendererOptions options;
  options.debugOutput = true;  // GL errors are counted in the report
  options.linkOnDemand = true;
  auto renderer = burnish::Renderer::create(address, options);
  if (!renderer) return fail(renderer.error());
  session.renderer = std::move(*renderer);
  auto target = burnish::OffscreenTarget::create(address, arguments.scene.size, arguments.outputKind());
  if (!target) return fail(target.error());
  session.target = std::move(*target);
  return session;
}

/// One frame from its call to its last pixel; adds its times to `report` when it is measured.
Result<burnish::FrameStats> drawFrame(Session& session, const LoadedScene& loaded, const RenderArguments& arguments,
                                      const burnish::RenderRequest& request, RenderReport* report) {
  const FrameClock clock;
  auto stats = session.renderer->render(loaded.scene, {&loaded.view, 1}, session.target->target(), arguments.scene.quality(), request);
  session.finish();
  if (!stats) return fail(stats.error());
  if (report) report->addFrame(clock, request.timing == burnish::TimingMode::Off ? nullptr : &*stats);
  return stats;
}

Result<burnish::Image> draw(Session& session, const LoadedScene& loaded, const RenderArguments& arguments, RenderReport& report, Progress& progress) {
  burnish::RenderRequest request;
  request.output = arguments.outputKind();
  request.debugView = arguments.debugView;
  const bool timed = arguments.timed();
  const int frames = arguments.frames > 0 ? arguments.frames : arguments.scene.quality().antialiasing == burnish::Antialiasing::Temporal ? kTemporalFrames : 1;
  const auto mode = !timed ? burnish::TimingMode::Off : arguments.profile ? burnish::TimingMode::Profile : burnish::TimingMode::Async;

  for (int i = 0; i < (timed ? kUnmeasuredFrames : 0); ++i) {
    progress.stage("preparing");
    request.timing = mode;
    request.countNonfinite = i == 0;  // its pass must not be in the measured frames
    auto stats = drawFrame(session, loaded, arguments, request, nullptr);
    if (!stats) return fail(stats.error());
    report.addCounts(*stats, request.countNonfinite);
  }
  progress.stage("rendering");
  request.timing = mode;
  for (int i = 0; i < frames; ++i) {
    progress.step(i, frames);
    request.countNonfinite = !timed && i + 1 == frames;
    auto stats = drawFrame(session, loaded, arguments, request, timed ? &report : nullptr);
    if (!stats) return fail(stats.error());
    report.addCounts(*stats, request.countNonfinite);
  }
  report.plan = session.renderer->lastPlan();
  auto picture = session.target->read();
  for (int i = 0; i < kMostLateFrames && mode == burnish::TimingMode::Async; ++i) {
    auto stats = drawFrame(session, loaded, arguments, request, nullptr);
    if (!stats) return fail(stats.error());
    report.addPassTimes(*stats);
  }
  return picture;
}

/// How radiance became the picture, for people.
std::string development(const RenderArguments& arguments, float exposureEv) {
  if (arguments.debugView != burnish::DebugView::Final) return fmt::format("view {}", burnish::debugViewNames()[std::size_t(arguments.debugView)]);
  if (arguments.outputKind() == burnish::Output::Linear) return "linear";
  if (arguments.scene.development.exposureEv) return fmt::format("EV100 {:.2f}", exposureEv);
  return exposureEv == 0 ? "automatic exposure" : fmt::format("EV100 {:.2f}, automatic", exposureEv);
}

void listRungs() {
  const burnish::Quality usual;
  for (std::size_t t = 0; t < burnish::terms().size(); ++t) {
    const burnish::Term& term = burnish::terms()[t];
    fmt::print("{}: {}\n", term.name, term.what);
    for (std::size_t r = 0; r < term.rungs.size(); ++r) {
      const burnish::Rung& rung = term.rungs[r];
      fmt::print("  {} {:<24} {}{}{}\n", burnish::rungOf(usual, t) == r ? '*' : ' ', rung.name, rung.what, rung.forwardOnly ? " [forward only]" : "",
                 rung.source.empty() ? "" : fmt::format(" ({})", rung.source));
    }
  }
  fmt::print("* in force by default. Presets: {}. Set one with --set TERM=RUNG.\n", fmt::join(burnish::presetNames(), ", "));
}

int run(const RenderArguments& arguments) {
  if (arguments.listRungs) return listRungs(), kOk;
  for (const std::string& file : {arguments.output, arguments.json})
    if (!file.empty() && file != "-")
      if (auto good = checkOutput(file); !good) return printError(good.error());
  Progress progress;
  auto loaded = loadScene(arguments.scene, progress);
  if (!loaded) return progress.finish(), printError(loaded.error());
  progress.stage("preparing");
  auto session = open(arguments);
  if (!session) return progress.finish(), printError(session.error());

  RenderReport report;
  report.backend = burnish::backendName(session->context->backend());
  report.renderer = session->renderer->capabilities().renderer;
  report.size = arguments.scene.size;
  report.profile = arguments.profile;
  report.quality = arguments.scene.quality();
  auto picture = draw(*session, *loaded, arguments, report, progress);
  if (!picture) return progress.finish(), printError(picture.error());
  report.warnings = warningTexts(loaded->report);
  for (std::string& text : warningTexts(session->renderer->report())) report.warnings.push_back(std::move(text));
  report.warnAboutCounts();

  progress.stage("writing " + arguments.output);
  auto written = writePicture(arguments.output, *picture);
  if (written && !arguments.json.empty()) written = writeJson(arguments.json, report.toJson());
  progress.finish();
  printWarnings(report.warnings);
  if (!written) return printError(written.error());
  if (arguments.json == "-") return kOk;
  report.print();
  fmt::print("{} ({}x{}, {}, {})\n", shown(arguments.output), report.size.x, report.size.y, loaded->cameraName, development(arguments, report.exposureEv));
  return kOk;
}

}  // namespace

Command addRender(CLI::App& program) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* app = program.add_subcommand("render", "One picture of a scene, headless");
  arguments->scene.addTo(*app, false);
  app->add_option_function<std::string>(
         "-o,--output",
         [arguments](const std::string& text) {
           const auto ending = std::filesystem::path(text).extension();
           if (ending != ".png" && ending != ".exr") throw CLI::ValidationError("-o", fmt::format("'{}' ends in neither .png nor .exr", text));
           arguments->output = text;
         },
         "the picture: .png as shown, .exr linear in cd/m² and untouched by exposure")
      ->type_name("IMG.png|.exr");
  const auto views = burnish::debugViewNames();
  addChoice(*app, "--view", {views.begin(), views.end()}, [arguments](std::size_t i) { arguments->debugView = burnish::DebugView(i); }, "what to draw");
  app->add_option("--frames", arguments->frames, "draw N frames and report median and p95 times; the last one is the picture, two unmeasured ones go first. antialiasing=temporal draws 16 if nothing is said")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  app->add_flag("--profile", arguments->profile, "finish between passes: per-pass times that are right on software renderers too");
  app->add_option("--json", arguments->json, "write times, effects, programs and warnings as JSON (- for standard output)")->type_name("FILE");
  app->add_flag("--list-rungs", arguments->listRungs, "list every term with its rungs and their sources, and do nothing else");
  // SCENE and -o are asked for here, since --list-rungs goes without.
  return {app, [arguments] {
            if (!arguments->listRungs && (arguments->scene.scene.empty() || arguments->output.empty())) {
              fmt::print(stderr, "burnish: {} is required: see 'burnish render --help'\n", arguments->scene.scene.empty() ? "SCENE" : "--output");
              return int(kUsage);
            }
            return run(*arguments);
          }};
}

}  // namespace cli
