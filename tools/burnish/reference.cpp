// burnish reference: path-traced ground truth of a scene.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

using burnish::ReferencePicture;
using burnish::ReferenceProgress;

constexpr int kUsualSamples = 256, kMostSamples = 1'000'000;

struct ReferenceArguments {
  SceneOptions scene;
  std::string output, png, json;
  burnish::ReferenceOptions options;
  bool resume = false;

  [[nodiscard]] std::filesystem::path state() const { return output + ".state"; }
};

/// Seconds until the work ends, by the samples or by the noise, which falls with the root of their number; negative: not known yet.
double secondsLeft(const ReferenceProgress& p, int first, double untilError) {
  if (p.samples <= first) return -1;
  double wanted = p.of;
  if (untilError > 0 && p.error > 0) wanted = std::min(wanted, p.samples * (p.error / untilError) * (p.error / untilError));
  return p.seconds / (p.samples - first) * std::max(wanted - p.samples, 0.0);
}

void watch(ReferenceArguments& arguments, Progress& progress, ReferenceProgress& last) {
  arguments.options.progress = [&arguments, &progress, &last, first = -1](const ReferenceProgress& p) mutable {
    if (first < 0) first = arguments.resume ? p.samples : 0, progress.stage("tracing, samples a pixel");
    last = p;
    progress.detail(fmt::format("noise {:.2f} %", 100 * p.error));
    progress.step(p.samples, p.of, secondsLeft(p, first, arguments.options.untilError));
    return !stopAsked();
  };
}

Json toJson(const ReferenceArguments& arguments, const ReferencePicture& picture, double seconds, const burnish::Report& report) {
  Json out;
  out["schema_version"] = 1;
  out["file"] = arguments.output;
  out["scene"] = picture.scene;
  out["camera"] = picture.camera;
  out["size"] = {picture.radiance.width, picture.radiance.height};
  out["samples"] = picture.samples;
  out["error"] = picture.error;
  out["seed"] = picture.seed;
  out["bounces"] = picture.bounces < 0 ? Json(nullptr) : Json(picture.bounces);
  out["pixel"] = picture.pixelArea ? "area" : "centre";
  out["seconds"] = seconds;
  out["interrupted"] = stopAsked();
  out["warnings"] = warningTexts(report);
  return out;
}

burnish::Result<void> write(const ReferenceArguments& arguments, const ReferencePicture& picture, double seconds, const burnish::Report& report) {
  if (auto written = burnish::writeReference(arguments.output, picture); !written) return written;
  if (!arguments.png.empty()) {
    const burnish::Quality quality = arguments.scene.quality();
    if (auto written = writePicture(arguments.png, burnish::develop(picture.radiance, quality.toneMap, quality.exposureEv)); !written) return written;
  }
  return arguments.json.empty() ? burnish::Result<void>{} : writeJson(arguments.json, toJson(arguments, picture, seconds, report));
}

int runReference(ReferenceArguments& arguments) {
  for (const std::string& file : {arguments.output, arguments.png, arguments.json})
    if (!file.empty() && file != "-")
      if (auto good = checkOutput(file); !good) return printError(good.error());
  Progress progress;
  auto loaded = loadScene(arguments.scene, progress);
  if (!loaded) return progress.finish(), printError(loaded.error());
  std::error_code none;
  if (!arguments.resume) std::filesystem::remove(arguments.state(), none);
  arguments.options.size = arguments.scene.size;
  arguments.options.threads = arguments.scene.threads;
  arguments.options.state = arguments.state();
  ReferenceProgress last;
  watch(arguments, progress, last);
  progress.stage("preparing");
  deferSignals();
  auto picture = burnish::traceReference(loaded->scene, loaded->view, arguments.scene.quality(), arguments.options, loaded->report);
  if (!picture) return progress.finish(), printError(picture.error());
  picture->scene = arguments.scene.scene;
  picture->camera = loaded->cameraName;
  progress.stage("writing " + arguments.output);
  const auto written = write(arguments, *picture, last.seconds, loaded->report);
  progress.finish();
  printWarnings(warningTexts(loaded->report));
  if (!written) return printError(written.error());
  if (stopAsked()) return printError({arguments.output, fmt::format("interrupted with {} samples a pixel: what there is is written", picture->samples), "go on with --resume"});
  if (!arguments.resume) std::filesystem::remove(arguments.state(), none);
  if (arguments.json != "-")
    fmt::print("{} ({}x{}, {}, {} samples a pixel, noise {:.2f} %, {:.1f} s)\n", shown(arguments.output), picture->radiance.width, picture->radiance.height, picture->camera, picture->samples,
               100 * picture->error, last.seconds);
  return kOk;
}

void addTracing(CLI::App& app, ReferenceArguments& arguments) {
  CLI::Option* samples = app.add_option("--spp", arguments.options.samples, fmt::format("samples of each pixel, 1 to {} ({}; with --until-error as many as it takes)", kMostSamples, kUsualSamples))
                             ->type_name("N")
                             ->check(CLI::Range(1, kMostSamples));
  app.add_option_function<double>(
         "--until-error",
         [&arguments, samples](double error) {
           arguments.options.untilError = error;
           if (samples->count() == 0) arguments.options.samples = kMostSamples;
         },
         "end once the noise (rms over the picture of a pixel's standard error, over the picture's rms) is below E; 0.01 is 1 %")
      ->type_name("E")
      ->check(CLI::Range(1e-6, 1.0));
  app.add_option("--seed", arguments.options.seed, "another whole number, other noise (1)")->type_name("S");
  app.add_option("--bounces", arguments.options.bounces, "surfaces that light may meet on its way, the one seen aside; 0: direct light alone (no limit)")->type_name("N")->check(CLI::Range(0, 100000));
  addChoice(app, "--pixel", {"area", "centre"}, [&arguments](std::size_t i) { arguments.options.pixelArea = i == 0; }, "where in a pixel light is gathered: all over it (the default), or in its centre as rasterization does");
}

}  // namespace

Command addReference(CLI::App& program) {
  auto arguments = std::make_shared<ReferenceArguments>();
  arguments->scene.preset = "exact";
  arguments->options.samples = kUsualSamples;
  CLI::App* app = program.add_subcommand("reference", "A scene's picture by path tracing: ground truth, with the same materials and lights (rungs: the preset exact)");
  arguments->scene.addTo(*app);
  app->add_option_function<std::string>(
         "-o,--output",
         [arguments](const std::string& text) {
           if (std::filesystem::path(text).extension() != ".exr") throw CLI::ValidationError("-o", fmt::format("'{}' does not end in .exr", text));
           arguments->output = text;
         },
         "the picture, linear in cd/m², with layers of direct light, albedo, normals and variance")
      ->type_name("OUT.exr")
      ->required();
  addTracing(*app, *arguments);
  app->add_flag("--resume", arguments->resume, "go on from OUT.exr.state, which an interrupted run leaves, and keep it afterwards, so that more samples can be added");
  app->add_option("--png", arguments->png, "the picture as shown, too")->type_name("FILE");
  app->add_option("--json", arguments->json, "write what was done as JSON (- for standard output)")->type_name("FILE");
  return {app, [arguments] { return runReference(*arguments); }};
}

}  // namespace cli
