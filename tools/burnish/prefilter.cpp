// burnish prefilter: surroundings -> a cubemap whose levels match the specular lobe.
#include <burnish/image.h>
#include <fmt/format.h>

#include <cmath>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
using burnish::fail;
using burnish::PixelType;
using burnish::Result;

struct PrefilterArguments {
  std::vector<std::string> inputs;
  std::string output, json, sh;
  burnish::PrefilterOptions options;
  bool half = false, whole = false, check = false, deRing = false;

  [[nodiscard]] PixelType type() const { return whole ? PixelType::F32 : PixelType::F16; }
};

constexpr std::string_view kLobes[] = {"blinn-phong", "ggx"};
constexpr int kSteps = 100;  // of the progress line

struct Outcome {
  burnish::EnvironmentFile source;
  burnish::Cubemap cubemap;
  burnish::PrefilterReport report;
  std::optional<burnish::PrefilterCheck> check;
  burnish::Report warnings;
};

/// Sums over a large source take long: fewer texels of it are summed again.
int checkSamples(const burnish::EnvironmentFile& source) {
  constexpr std::size_t kLarge = 1u << 20;
  const std::size_t texels = source.isCube() ? source.cube.levels[0].texels.size() / 3 : source.latLong.pixelCount();
  return texels > kLarge ? 16 : 64;
}

Result<void> filter(const PrefilterArguments& arguments, Outcome& outcome, Progress& progress) {
  progress.stage("reading " + arguments.inputs[0]);
  const std::vector<fs::path> files(arguments.inputs.begin(), arguments.inputs.end());
  auto source = burnish::readEnvironment(files, outcome.warnings);
  if (!source) return fail(source.error());
  outcome.source = std::move(*source);
  if (outcome.source.isCube() && outcome.source.cube.lobe)
    outcome.warnings.warn(arguments.inputs[0], "is filtered already; its level 0 is filtered again");

  burnish::PrefilterOptions options = arguments.options;
  options.progress = [&](double share) { progress.step(int(share * kSteps), kSteps); };
  progress.stage("filtering");
  auto cubemap = outcome.source.isCube() ? burnish::prefilterCubemap(outcome.source.cube.levels[0], options, &outcome.report)
                                         : burnish::prefilterCubemap(outcome.source.latLong, options, &outcome.report);
  if (!cubemap) return fail(cubemap.error());
  outcome.cubemap = std::move(*cubemap);
  if (!arguments.check) return {};

  progress.stage("summing random texels again");
  burnish::PrefilterCheckOptions check;
  check.samples = checkSamples(outcome.source);
  check.error = options.error;
  check.threads = options.threads;
  check.progress = options.progress;
  auto checked = outcome.source.isCube() ? burnish::checkPrefilter(outcome.source.cube.levels[0], outcome.cubemap, check)
                                         : burnish::checkPrefilter(outcome.source.latLong, outcome.cubemap, check);
  if (!checked) return fail(checked.error());
  outcome.check = std::move(*checked);
  return {};
}

Json levelJson(const burnish::PrefilterReport::Level& level) {
  Json out = {{"size", level.size}, {"roughness", level.roughness}, {"power", level.power}};  // infinite: null
  if (level.bands > 0) out["bands"] = level.bands;
  else out["samples"] = level.samples;
  out["ms"] = level.ms;
  return out;
}

Json toJson(const PrefilterArguments& arguments, const Outcome& outcome) {
  Json out;
  out["schema_version"] = 1;
  out["source"] = outcome.source.layout;
  out["size"] = outcome.cubemap.levels[0].size;
  out["lobe"] = kLobes[std::size_t(arguments.options.lobe)];
  out["format"] = arguments.type() == PixelType::F16 ? "half" : "float";
  out["levels"] = Json::array();
  for (const auto& level : outcome.report.levels) out["levels"].push_back(levelJson(level));
  out["total_ms"] = outcome.report.wallMs;
  out["total_cpu_ms"] = outcome.report.cpuMs;
  out["tables_ms"] = outcome.report.tablesMs;
  if (outcome.check) {
    out["check"] = {{"within", outcome.check->within()}, {"rms_bound", arguments.options.error}, {"worst_bound", 10 * arguments.options.error}, {"levels", Json::array()}};
    for (const auto& level : outcome.check->levels)
      out["check"]["levels"].push_back({{"size", level.size},
                                        {"samples", level.samples},
                                        {"rms", level.samples > 0 ? Json(level.rms) : Json()},
                                        {"worst", level.samples > 0 ? Json(level.worst) : Json()},
                                        {"within", level.within}});
  }
  out["warnings"] = warningTexts(outcome.warnings);
  return out;
}

/// What --sh writes.
Result<Json> shJson(const PrefilterArguments& arguments, const Outcome& outcome) {
  const int threads = arguments.options.threads;
  const auto sh = outcome.source.isCube() ? burnish::irradianceSh(outcome.source.cube.levels[0], arguments.deRing, threads)
                                          : burnish::irradianceSh(outcome.source.latLong, arguments.deRing, threads);
  if (!sh) return fail(sh.error());
  Json out;
  out["schema_version"] = 1;
  out["quantity"] = "irradiance / pi";
  out["dering"] = arguments.deRing;
  out["basis"] = {"1", "y", "z", "x", "x*y", "y*z", "3*z*z-1", "x*z", "x*x-y*y"};
  out["coefficients"] = Json::array();
  for (const auto& rgb : *sh) out["coefficients"].push_back(rgb);
  return out;
}

void print(const PrefilterArguments& arguments, const Outcome& outcome) {
  fmt::print("{}: {}\n", shown(arguments.inputs[0]), shown(outcome.source.layout));
  fmt::print("  {:>5} {:>5} {:>9} {:>12} {:>16} {:>9}\n", "level", "size", "roughness", "power", "sum over", "ms");
  for (std::size_t k = 0; k < outcome.report.levels.size(); ++k) {
    const auto& level = outcome.report.levels[k];
    const std::string over = level.bands > 0 ? fmt::format("{} bands", level.bands) : level.samples > 0 ? fmt::format("{} texels", level.samples) : "-";
    fmt::print("  {:>5} {:>5} {:>9.4f} {:>12} {:>16} {:>9.2f}\n", k, level.size, level.roughness, std::isfinite(level.power) ? fmt::format("{:.2f}", level.power) : "-", over, level.ms);
  }
  fmt::print("filtered for {} in {:.1f} ms, {:.1f} ms of CPU ({:.1f} of them tables that later filters share)\n", kLobes[std::size_t(arguments.options.lobe)], outcome.report.wallMs,
             outcome.report.cpuMs, outcome.report.tablesMs);
  if (!outcome.check) return;
  fmt::print("check against sums in double: rms error over the level's rms (bound {:g}), worst texel (bound {:g})\n", arguments.options.error, 10 * arguments.options.error);
  for (std::size_t k = 0; k < outcome.check->levels.size(); ++k) {
    const auto& level = outcome.check->levels[k];
    if (level.samples == 0) fmt::print("  {:>5} {:>5} not compared: the source is no cube of this size\n", k, level.size);
    else fmt::print("  {:>5} {:>5} {:>6} texels   rms {:<10.3g} worst {:<10.3g} {}\n", k, level.size, level.samples, level.rms, level.worst, level.within ? "holds" : "FAILS");
  }
}

int run(const PrefilterArguments& arguments) {
  if (auto good = checkCubemapOutput(arguments.output); !good) return printError(good.error());
  for (const std::string& file : {arguments.json, arguments.sh})
    if (!file.empty() && file != "-")
      if (auto good = checkOutput(file); !good) return printError(good.error());
  Progress progress;
  Outcome outcome;
  if (auto done = filter(arguments, outcome, progress); !done) return progress.finish(), printError(done.error());
  const bool within = !outcome.check || outcome.check->within();
  Result<void> written;
  if (within) {
    progress.stage("writing " + arguments.output);
    written = saveCubemap(arguments.output, outcome.cubemap, arguments.type(), outcome.warnings);
  }
  if (within && written && !arguments.sh.empty()) {
    const auto sh = shJson(arguments, outcome);
    if (!sh) return progress.finish(), printError(sh.error());
    written = writeJson(arguments.sh, *sh);
  }
  if (written && !arguments.json.empty()) written = writeJson(arguments.json, toJson(arguments, outcome));
  progress.finish();
  printWarnings(warningTexts(outcome.warnings));
  if (!written) return printError(written.error());
  const bool quiet = arguments.json == "-" || arguments.sh == "-";
  if (!quiet) print(arguments, outcome);
  if (!within) return printError({arguments.output, "is not written: the check found errors above its bounds", "ask for them with a larger --error, or report it"});
  if (!quiet) fmt::print("{} ({}, {} levels)\n", shown(arguments.output), arguments.type() == PixelType::F16 ? "half" : "float", outcome.cubemap.levels.size());
  return kOk;
}

bool isCubemapName(const std::string& text) {
  const fs::path file(text);
  std::string ending = file.extension().string();
  for (char& c : ending) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  std::error_code ignored;
  return ending == ".dds" || ending == ".ktx2" || ending == ".exr" || ending.empty() || fs::is_directory(file, ignored);
}

void checkSize(const std::string& text, burnish::PrefilterOptions& options) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end || value < 16 || value > 4096 || (value & (value - 1)) != 0)
    throw CLI::ValidationError("--size", fmt::format("'{}' is not a size: give a power of two from 16 to 4096", text));
  options.size = int(value);
}

void checkError(const std::string& text, burnish::PrefilterOptions& options) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end || !(value >= 1e-7 && value <= 0.1)) throw CLI::ValidationError("--error", fmt::format("'{}' is not an error: give a number from 1e-7 to 0.1", text));
  options.error = value;
}

void addOutputs(CLI::App& app, PrefilterArguments& arguments) {
  app.add_option_function<std::string>(
         "-o,--output",
         [&arguments](const std::string& text) {
           if (!isCubemapName(text)) throw CLI::ValidationError("-o", fmt::format("'{}' ends in none of .dds, .ktx2, .exr and is no folder's name", text));
           arguments.output = text;
         },
         "the cubemap: .dds, .ktx2, .exr (all levels in one picture), or a folder of six EXR files a level")
      ->type_name("OUT")
      ->required();
  CLI::Option* half = app.add_flag("--half", arguments.half, "write half floats (the default); values above 65504 are held there, with a warning");
  app.add_flag("--float", arguments.whole, "write floats")->excludes(half);
  CLI::Option* sh = app.add_option("--sh", arguments.sh, "write the source's irradiance in spherical harmonics (L2) as JSON (- for standard output)")->type_name("FILE");
  app.add_flag("--dering", arguments.deRing, "with --sh: damp bands 1 and 2 as little as leaves no direction negative")->needs(sh);
  app.add_option("--json", arguments.json, "write levels, times, errors and warnings as JSON (- for standard output)")->type_name("FILE");
}

}  // namespace

Command addPrefilter(CLI::App& program) {
  auto arguments = std::make_shared<PrefilterArguments>();
  CLI::App* app = program.add_subcommand("prefilter", "Surroundings to a cubemap whose levels match the specular lobe");
  app->add_option("IN", arguments->inputs,
                  "a lat-long picture, cross or strip (.hdr, .exr, .png, .jpg), a .dds or .ktx2 cube, a pattern of six files (face_%s.exr), a folder of them, or six files: +X -X +Y -Y +Z -Z")
      ->required()
      ->type_name("")
      ->expected(1, 6);
  addOutputs(*app, *arguments);
  burnish::PrefilterOptions& options = arguments->options;
  addChoice(*app, "--lobe", {kLobes[0].data(), kLobes[1].data()}, [&options](std::size_t i) { options.lobe = burnish::ReflectionLobe(i); }, "what the levels match (blinn-phong)");
  app->add_option_function<std::string>("--size", [&options](const std::string& text) { checkSize(text, options); }, "texels along an edge of level 0 (256)")->type_name("N");
  app->add_option("--levels", options.levels, "how many levels; without: down to faces of 8x8")->type_name("K")->check(CLI::Range(1, 13));
  app->add_option_function<std::string>("--error", [&options](const std::string& text) { checkError(text, options); },
                                        "rms error of a level over its rms value that is allowed (1e-4)")->type_name("E");
  app->add_option("--threads", options.threads, "at most N threads; the result is the same")->type_name("N")->check(CLI::Range(1, 1024));
  app->add_flag("--check", arguments->check, "sum random texels of every level again, in double; exit code 1 and no file where the error is above --error (rms) or ten times that (worst texel)");
  app->footer(
      "Examples:\n"
      "  burnish prefilter studio.hdr -o studio.ktx2\n"
      "  burnish prefilter sky.exr -o sky.dds --lobe ggx --size 512 --float\n"
      "  burnish prefilter 'face_%s.exr' -o probe/ --levels 9 --check\n"
      "  burnish prefilter cross.hdr -o cross.ktx2 --json times.json");
  return {app, [arguments] {
            if (arguments->inputs.size() != 1 && arguments->inputs.size() != 6) {
              fmt::print(stderr, "burnish: IN is one file or six faces (+X -X +Y -Y +Z -Z), not {}: see 'burnish prefilter --help'\n", arguments->inputs.size());
              return int(kUsage);
            }
            return run(*arguments);
          }};
}

}  // namespace cli
