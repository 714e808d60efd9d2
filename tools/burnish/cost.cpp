// burnish cost: what accuracy costs, on this scene and this machine.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <chrono>
#include <fstream>

#include "commands.h"
#include "cost_budget.h"
#include "cost_text.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {
namespace fs = std::filesystem;
using burnish::fail;
using burnish::Result;

constexpr double kReferenceShare = 0.2;  // of the time, where no number of samples is asked for
constexpr int kMostSamples = 65536, kSamplesWithoutLimit = 256;

struct CostArguments {
  SceneOptions scene;
  std::string output, reference, json;
  int referenceSamples = 0;  ///< 0: as many as kReferenceShare of the time gives
  bool noReference = false, noChoices = false;
  double minutes = 14;
  int rounds = 7;
  std::vector<std::string> terms;
  BudgetArguments budgets;
};

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The command that makes the report again.
std::string commandOf(const CostArguments& a) {
  const SceneOptions& s = a.scene;
  std::string text = fmt::format("burnish cost {} -o {}", s.scene, a.output);
  const auto add = [&](bool given, const std::string& option) { text += given ? " " + option : ""; };
  const auto vector = [](const std::optional<glm::dvec3>& v) { return v ? fmt::format("{:g},{:g},{:g}", v->x, v->y, v->z) : std::string(); };
  add(!s.camera.empty(), "--camera " + s.camera);
  add(s.eye.has_value(), "--eye " + vector(s.eye));
  add(s.target.has_value(), "--target " + vector(s.target));
  add(s.up.has_value(), "--up " + vector(s.up));
  add(s.fovDegrees.has_value(), fmt::format("--fov {:g}", s.fovDegrees.value_or(0)));
  add(true, fmt::format("--size {}x{}", s.size.x, s.size.y));
  add(!s.environment.empty(), "--env " + s.environment);
  add(!s.probes.empty(), "--probes " + s.probes);
  add(s.time.has_value(), fmt::format("--time {:g}", s.time.value_or(0)));
  add(s.preset != "default", "--quality " + s.preset);
  for (const auto& [term, rung] : s.sets) add(true, fmt::format("--set {}={}", term, rung));
  add(s.development.exposureEv.has_value(), fmt::format("--exposure {:g}", s.development.exposureEv.value_or(0)));
  add(!a.reference.empty(), "--reference " + a.reference);
  add(a.referenceSamples > 0, fmt::format("--reference-spp {}", a.referenceSamples));
  add(a.noReference, "--no-reference");
  add(a.noChoices, "--no-choices");
  for (const std::string& term : a.terms) add(true, "--term " + term);
  add(true, fmt::format("--minutes {:g} --rounds {}", a.minutes, a.rounds));
  return text + a.budgets.command();
}

/// Traces the ground truth, or takes up what an earlier call left in the folder: as many samples as that has, unless another number is asked for.
Result<burnish::ReferencePicture> trace(const CostArguments& a, LoadedScene& loaded, Progress& progress) {
  burnish::Quality exact = a.scene.quality();
  (void)burnish::setPreset(exact, "exact");  // the name is known
  const fs::path file = fs::path(a.output) / "reference.exr";
  burnish::ReferenceOptions options;
  options.size = a.scene.size;
  options.samples = a.referenceSamples > 0 ? a.referenceSamples : a.minutes == 0 ? kSamplesWithoutLimit : kMostSamples;
  options.pixelArea = false;
  options.threads = a.scene.threads;
  options.state = fs::path(a.output) / "reference.state";
  const double limit = a.referenceSamples > 0 || a.minutes == 0 ? 1e9 : 60 * a.minutes * kReferenceShare;
  progress.stage("tracing ground truth");
  options.progress = [&](const burnish::ReferenceProgress& p) {
    const double share = limit < 1e9 ? p.seconds / limit : double(p.samples) / double(p.of);
    progress.detail(fmt::format("{} samples a pixel, noise {:.2f} %", p.samples, 100 * p.error));
    progress.step(int(1000 * std::min(share, 1.0)), 1000);
    return p.seconds < limit;
  };
  std::error_code error;
  burnish::ReferenceOptions kept = options;
  if (a.referenceSamples == 0 && fs::exists(options.state, error))
    if (const auto there = burnish::readReference(file)) kept.samples = there->samples;
  auto picture = burnish::traceReference(loaded.scene, loaded.view, exact, kept, loaded.report);
  // What lies there may be of another scene, view or size.
  if (!picture && fs::remove(options.state, error)) picture = burnish::traceReference(loaded.scene, loaded.view, exact, options, loaded.report);
  if (picture)
    if (auto written = burnish::writeReference(file, *picture); !written) return fail(written.error());
  return picture;
}

struct Measured {
  burnish::CostReport cost;
  std::vector<burnish::BudgetResult> budgets;
};

Result<Measured> measure(const CostArguments& a, LoadedScene& loaded, const burnish::ReferencePicture* truth, double minutes, Progress& progress) {
  progress.stage("preparing");
  auto context = openContext(a.scene);
  if (!context) return fail(context.error());
  burnish::CostOptions options;
  options.size = a.scene.size;
  options.base = a.scene.quality();
  options.baseName = a.scene.preset;
  options.truth = truth;
  options.rounds = a.rounds;
  options.minutes = minutes;
  options.terms = a.terms;
  options.choices = !a.noChoices;
  options.backend = burnish::backendName((*context)->backend());
  if (a.scene.threads != 1) options.secondContext = [backend = (*context)->backend()] { return burnish::Context::create({.backend = backend}); };
  progress.stage("measuring");
  options.progress = [&](double share, std::string_view what) {
    progress.detail(std::string(what));
    progress.step(int(1000 * share), 1000);
    return true;
  };
  auto cost = burnish::measureCost((*context)->procAddress(), loaded.scene, loaded.view, options, loaded.report);
  if (!cost) return fail(cost.error());
  auto budgets = burnish::spendBudget((*context)->procAddress(), loaded.scene, loaded.view, options, a.budgets.options(*cost, options.progress), *cost, loaded.report);
  if (!budgets) return fail(budgets.error());
  return Measured{std::move(*cost), std::move(*budgets)};
}

Result<void> copyJson(const fs::path& from, const std::string& to) {
  std::ifstream file(from);
  Json document = Json::parse(file, nullptr, false);
  if (document.is_discarded()) return fail(from.string(), "cannot be read again", "free some space or choose another folder");
  return writeJson(to, document);
}

int run(const CostArguments& a) {
  if (!a.json.empty() && a.json != "-")
    if (auto good = checkOutput(a.json); !good) return printError(good.error());
  std::error_code error;
  fs::create_directories(a.output, error);
  if (auto good = checkOutput(fs::path(a.output) / "cost.json"); !good) return printError(good.error());
  const Stopwatch watch;
  Progress progress;
  const auto failed = [&](const burnish::Error& e) { return progress.finish(), printError(e); };
  auto loaded = loadScene(a.scene, progress);
  if (!loaded) return failed(loaded.error());

  std::optional<burnish::ReferencePicture> truth;
  if (!a.noReference) {
    auto picture = a.reference.empty() ? trace(a, *loaded, progress) : burnish::readReference(a.reference);
    if (!picture) return failed(picture.error());
    if (picture->pixelArea)
      loaded->report.warn(a.reference, "its samples are spread over each pixel, and the renderer's go through the centres: edges count as errors (burnish reference --pixel centre)");
    truth = std::move(*picture);
  }
  const double minutes = a.minutes > 0 ? std::max(a.minutes - watch.seconds() / 60, 0.01) : 0;
  auto measured = measure(a, *loaded, truth ? &*truth : nullptr, minutes, progress);
  if (!measured) return failed(measured.error());
  burnish::CostReport* const cost = &measured->cost;
  cost->scene = a.scene.scene;
  cost->camera = loaded->cameraName;
  cost->command = commandOf(a);
  cost->seconds = watch.seconds();
  for (std::string& text : warningTexts(loaded->report)) cost->warnings.push_back(std::move(text));

  progress.stage("writing " + a.output);
  burnish::Report report;
  auto written = burnish::writeCostReport(a.output, *cost, measured->budgets, report);
  if (written) written = writeQualities(a.output, a.budgets, measured->budgets, *cost);
  for (std::string& text : warningTexts(report)) cost->warnings.push_back(std::move(text));
  if (written && !a.json.empty()) written = copyJson(fs::path(a.output) / "cost.json", a.json);
  progress.finish();
  printWarnings(cost->warnings);
  if (!written) return printError(written.error());
  if (a.json == "-") return kOk;
  printCost(*cost);
  printBudgets(a.output, a.budgets, measured->budgets, *cost);
  fmt::print("\n{} ({:.0f} s)\n", shown((fs::path(a.output) / "index.html").string()), cost->seconds);
  return kOk;
}

}  // namespace

Command addCost(CLI::App& program) {
  auto arguments = std::make_shared<CostArguments>();
  CLI::App* app = program.add_subcommand("cost", "What accuracy costs: time and error of every approximation that the scene exercises");
  arguments->scene.size = {640, 360};
  arguments->scene.addTo(*app);
  app->add_option("-o,--output", arguments->output, "the folder for the page, its data and the reference; made if it is not there")->type_name("DIR")->required();
  CLI::Option* given = app->add_option("--reference", arguments->reference, "ground truth that burnish reference wrote with --pixel centre, in place of tracing it")->type_name("FILE");
  CLI::Option* samples = app->add_option("--reference-spp", arguments->referenceSamples, "samples of each pixel of ground truth; without: what a fifth of the time gives")->type_name("N")->check(CLI::Range(1, 1000000));
  CLI::Option* none = app->add_flag("--no-reference", arguments->noReference, "no ground truth: errors are against exact rungs alone");
  given->excludes(samples)->excludes(none);
  samples->excludes(none);
  app->add_option("--minutes", arguments->minutes, "wall time to spend, ground truth included; 0: no limit (14)")->type_name("M")->check(CLI::Range(0.0, 1e5));
  app->add_option("--rounds", arguments->rounds, "pairs of frames behind each time, at most; fewer when the time runs short, but 5 (7)")->type_name("N")->check(CLI::Range(3, 1000));
  std::vector<std::string> names;
  for (const burnish::Term& term : burnish::terms()) names.emplace_back(term.name);
  for (const std::string_view choice : burnish::costChoices())
    if (std::find(names.begin(), names.end(), choice) == names.end()) names.emplace_back(choice);
  app->add_option_function<std::vector<std::string>>(
         "--term",
         [arguments, names](const std::vector<std::string>& texts) {
           for (const std::string& text : texts)
             if (std::find(names.begin(), names.end(), text) == names.end()) throw CLI::ValidationError("--term", fmt::format("'{}' is no term{}; choose one of: {}", text, didYouMean(text, names), listed(names)));
           arguments->terms = texts;
         },
         "this term alone; repeatable")
      ->type_name("TERM")
      ->type_size(1)
      ->allow_extra_args(false)
      ->take_all();
  arguments->budgets.addTo(*app);
  app->add_flag("--no-choices", arguments->noChoices, "terms alone: no sizes, formats and layouts");
  app->add_option("--json", arguments->json, "write cost.json here too (- for standard output)")->type_name("FILE");
  return {app, [arguments] { return run(*arguments); }};
}

}  // namespace cli
