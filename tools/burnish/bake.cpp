// burnish bake: a scene's reflection and ambient probes, baked over bounces into a folder.
#include <burnish/probe.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

using burnish::BounceReport;
using burnish::fail;
using burnish::Result;

struct BakeArguments {
  SceneOptions scene;
  std::string output, merge, json;
  burnish::BakeOptions options;
  int shard = 0, shards = 0, bounce = 0;
  bool automatic = false, resume = false;

  [[nodiscard]] bool quiet() const { return json == "-"; }
};

constexpr std::string_view kLobes[] = {"blinn-phong", "ggx"};

std::string restText(const BounceReport& b) { return std::isfinite(b.rest) ? fmt::format("{:.3g} %", 100 * b.rest) : std::string("not known yet"); }

void printBounce(const BounceReport& b) {
  fmt::print("bounce {}: change {:.3g} %, q {}, estimated rest {}, {} captured, {} reused\n", b.bounce, 100 * b.change, b.ratio > 0 ? fmt::format("{:.3f}", b.ratio) : "-", restText(b), b.captured, b.reused);
  std::fflush(stdout);
}

Json bounceJson(const BounceReport& b) {
  return {{"bounce", b.bounce}, {"change", b.change}, {"light", b.light}, {"ratio", b.ratio}, {"rest", b.rest}, {"captured", b.captured}, {"reused", b.reused}};
}

/// `finished`: the folder's set is written.
Json toJson(const std::string& folder, bool finished, std::span<const BounceReport> bounces, const burnish::BakeReport* times, const burnish::Report& warnings) {
  Json out;
  out["schema_version"] = 1;
  out["folder"] = folder;
  out["finished"] = finished;
  out["bounces"] = Json::array();
  for (const BounceReport& b : bounces) out["bounces"].push_back(bounceJson(b));
  if (times) out["capture_ms"] = times->captureMs, out["filter_ms"] = times->filterMs, out["store_ms"] = times->storeMs, out["wall_ms"] = times->wallMs;
  out["warnings"] = warningTexts(warnings);
  return out;
}

/// What there is to bake, for people.
std::string placesText(const burnish::ProbeSet& set) {
  std::string text = fmt::format("{} reflection probe{}", set.reflections.size(), set.reflections.size() == 1 ? "" : "s");
  if (set.grid) text += fmt::format(", a lattice of {} x {} x {} points", set.grid->counts.x, set.grid->counts.y, set.grid->counts.z);
  return text;
}

constexpr int kSteps = 100;  // of the progress line

/// The file's places, with --auto those that its rooms ask for too.
Result<void> findPlaces(const BakeArguments& arguments, LoadedScene& loaded, Progress& progress) {
  burnish::ProbeSet& set = loaded.scene.probes;
  if (arguments.automatic) {
    burnish::PlacementOptions options;
    options.threads = arguments.scene.threads;
    options.progress = [&progress](double share) { progress.step(int(share * kSteps), kSteps); };
    progress.stage("finding rooms");
    auto placed = burnish::placeProbes(loaded.scene, options, loaded.report);
    if (!placed) return fail(placed.error());
    set = std::move(*placed);
    if (set.reflections.empty() && !set.grid) return fail(arguments.scene.scene, "no rooms were found in it, and it has no places for probes", "name nodes as docs/probes.md says");
  }
  if (set.reflections.empty() && !set.grid) return fail(arguments.scene.scene, "has no places for probes", "have them found with --auto, or name nodes as docs/probes.md says");
  return {};
}

/// The job's reports go to the terminal as they come.
burnish::BakeJob jobOf(const BakeArguments& arguments, Progress& progress) {
  burnish::BakeJob job;
  job.folder = arguments.output;
  job.resume = arguments.resume;
  if (arguments.shards > 0) job.shard = arguments.shard - 1, job.shards = arguments.shards, job.bounce = arguments.bounce;
  job.progress = [&progress, current = 0](int bounce, int done, int total, double secondsLeft) mutable {
    if (bounce != current) progress.stage(fmt::format("bounce {}", bounce));
    current = bounce;
    progress.step(done, total, secondsLeft);
  };
  if (!arguments.quiet())
    job.bounced = [&progress](const BounceReport& bounce) {
      progress.finish();
      printBounce(bounce);
    };
  return job;
}

void print(const BakeArguments& arguments, const burnish::BakeReport& baked, const burnish::ProbeSet& places) {
  if (arguments.shards > 0) {
    const BounceReport& b = baked.bounces.front();
    fmt::print("bounce {}, shard {}/{}: {} captured, {} reused\n", b.bounce, arguments.shard, arguments.shards, b.captured, b.reused);
  }
  fmt::print("CPU time: {:.1f} s capturing, {:.1f} s filtering, {:.1f} s storing; {:.1f} s in all by the clock\n", baked.captureMs / 1000, baked.filterMs / 1000, baked.storeMs / 1000, baked.wallMs / 1000);
  if (arguments.shards == 0) fmt::print("{} ({}, {} bounces)\n", shown(arguments.output), placesText(places), baked.bounces.size());
}

int runBake(const BakeArguments& arguments) {
  if (!arguments.json.empty() && !arguments.quiet())
    if (auto good = checkOutput(arguments.json); !good) return printError(good.error());
  Progress progress;
  auto loaded = loadScene(arguments.scene, progress);
  if (!loaded) return progress.finish(), printError(loaded.error());
  if (auto found = findPlaces(arguments, *loaded, progress); !found) return progress.finish(), printError(found.error());
  progress.stage("preparing");
  const auto context = openContext(arguments.scene);
  if (!context) return progress.finish(), printError(context.error());
  burnish::BakeOptions options = arguments.options;
  options.quality = arguments.scene.quality();
  options.threads = arguments.scene.threads;
  const auto baked = burnish::bakeProbes((*context)->procAddress(), loaded->scene, options, jobOf(arguments, progress), loaded->report);
  progress.finish();
  printWarnings(warningTexts(loaded->report));
  if (!baked) return printError(baked.error());
  if (!arguments.json.empty())
    if (auto written = writeJson(arguments.json, toJson(arguments.output, arguments.shards == 0, baked->bounces, &*baked, loaded->report)); !written) return printError(written.error());
  if (!arguments.quiet()) print(arguments, *baked, loaded->scene.probes);
  return kOk;
}

int runMerge(const BakeArguments& arguments) {
  if (!arguments.json.empty() && !arguments.quiet())
    if (auto good = checkOutput(arguments.json); !good) return printError(good.error());
  burnish::Report report;
  Progress progress;
  progress.stage("joining");
  const auto joined = burnish::mergeBounce(arguments.merge, report);
  progress.finish();
  printWarnings(warningTexts(report));
  if (!joined) return printError(joined.error());
  if (!arguments.json.empty())
    if (auto written = writeJson(arguments.json, toJson(arguments.merge, joined->finished, {&joined->bounce, 1}, nullptr, report)); !written) return printError(written.error());
  if (arguments.quiet()) return kOk;
  printBounce(joined->bounce);
  if (joined->finished) fmt::print("{} (finished, {} bounces)\n", shown(arguments.merge), joined->bounce.bounce);
  else fmt::print("bounce {} can be baked\n", joined->bounce.bounce + 1);
  return kOk;
}

std::optional<int> parseWhole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

void checkShard(const std::string& text, BakeArguments& arguments) {
  const std::size_t slash = text.find('/');
  const auto shard = parseWhole(std::string_view(text).substr(0, slash)), shards = slash == std::string::npos ? std::nullopt : parseWhole(std::string_view(text).substr(slash + 1));
  if (!shard || !shards || *shard < 1 || *shard > *shards || *shards > 100000) throw CLI::ValidationError("--shard", fmt::format("'{}' is not a shard: give I/N, 1 <= I <= N, for example 2/4", text));
  arguments.shard = *shard, arguments.shards = *shards;
}

void checkSize(const char* flag, const std::string& text, int& size) {
  const auto value = parseWhole(text);
  if (!value || *value < 16 || *value > 2048 || (*value & (*value - 1)) != 0) throw CLI::ValidationError(flag, fmt::format("'{}' is not a size: give a power of two from 16 to 2048", text));
  size = *value;
}

void addShares(CLI::App& app, BakeArguments& arguments) {
  const auto addShare = [&app](const char* flag, const char* type, const char* help, double& value, double least) {
    app.add_option_function<std::string>(
           flag,
           [flag, least, &value](const std::string& text) {
             char* end = nullptr;
             const double found = std::strtod(text.c_str(), &end);
             if (text.empty() || *end || !(found >= least && found <= 1)) throw CLI::ValidationError(flag, fmt::format("'{}' is not a share: give a number from {:g} to 1", text, least));
             value = found;
           },
           help)
        ->type_name(type);
  };
  addShare("--until", "E", "stop when the estimated rest of the light is under this share of it (0.01)", arguments.options.until, 1e-6);
  addShare("--albedo-limit", "A", "what surfaces reflect at most in all while baking (0.98); brighter ones are darkened, with a warning", arguments.options.albedoLimit, 0);
}

void addOptions(CLI::App& app, BakeArguments& arguments) {
  app.add_option("-o,--output", arguments.output, "the folder of probes: new, empty, or one that holds probes (with --resume)")->type_name("DIR");
  app.add_option("--bounces", arguments.options.bounces, "bake this many bounces, without a look at the rest")->type_name("N")->check(CLI::Range(1, 1000));
  addShares(app, arguments);
  app.add_flag("--auto", arguments.automatic, "find rooms in the geometry: a probe for each, and a lattice; places of the file stay");
  app.add_flag("--resume", arguments.resume, "go on with what the folder holds: what has not changed is not baked again");
  app.add_option_function<std::string>("--shard", [&arguments](const std::string& text) { checkShard(text, arguments); }, "bake part I of N of one bounce (--bounce), beside other processes")->type_name("I/N");
  app.add_option("--bounce", arguments.bounce, "with --shard: which bounce; the one before must be joined")->type_name("K")->check(CLI::Range(1, 1000));
  app.add_option("--merge", arguments.merge, "join the shards of a bounce in this folder, and permit the next; needs no SCENE")->type_name("DIR");
  app.add_option_function<std::string>("--size", [&arguments](const std::string& text) { checkSize("--size", text, arguments.options.size); }, "texels along an edge of a reflection probe (128)")->type_name("N");
  app.add_option_function<std::string>("--ambient-size", [&arguments](const std::string& text) { checkSize("--ambient-size", text, arguments.options.ambientSize); }, "texels along an edge of a capture of the lattice (16)")->type_name("N");
  addChoice(app, "--lobe", {kLobes[0].data(), kLobes[1].data()}, [&arguments](std::size_t i) { arguments.options.lobe = burnish::ReflectionLobe(i); }, "what the levels match (blinn-phong)");
  app.add_option("--json", arguments.json, "write bounces, times and warnings as JSON (- for standard output)")->type_name("FILE");
}

void relate(CLI::App& app) {
  const auto option = [&app](const char* name) { return app.get_option(name); };
  option("--bounces")->excludes(option("--until"));
  option("--bounce")->needs(option("--shard"));
  option("--shard")->needs(option("--bounce"));
  for (const char* other : {"SCENE", "--output", "--bounces", "--until", "--auto", "--resume", "--shard", "--size", "--ambient-size", "--lobe", "--albedo-limit"}) option("--merge")->excludes(option(other));
}

}  // namespace

Command addBake(CLI::App& program) {
  auto arguments = std::make_shared<BakeArguments>();
  CLI::App* app = program.add_subcommand("bake", "A scene's reflection and ambient probes, captured by the engine over many bounces");
  arguments->scene.addSceneTo(*app, false);
  addOptions(*app, *arguments);
  relate(*app);
  app->footer(
      "Examples:\n"
      "  burnish bake hall.gltf -o probes\n"
      "  burnish bake hall.gltf -o probes --auto            # a file without places\n"
      "  burnish bake hall.gltf -o probes --resume          # after a change, or a stop\n"
      "  burnish bake hall.gltf -o probes --shard 2/8 --bounce 1\n"
      "  burnish bake --merge probes\n"
      "  burnish render hall.gltf --probes probes -o hall.png");
  return {app, [arguments] {
            if (!arguments->merge.empty()) return runMerge(*arguments);
            if (arguments->scene.scene.empty() || arguments->output.empty()) {
              fmt::print(stderr, "burnish: {} is required: see 'burnish bake --help'\n", arguments->scene.scene.empty() ? "SCENE or --merge" : "--output");
              return int(kUsage);
            }
            return runBake(*arguments);
          }};
}

}  // namespace cli
