// What each rung costs and what it changes: every rung of every term on one scene, in one interleaved run, written as a page of tables.
// Usage: rung_costs [-o docs/rungs.md] [--scene fps.gltf] [--camera hero] [--size 480x270] [--rounds 11] [--term NAME]
// Times are of the lighting pass: CPU time of the process where the renderer is software (each pass is finished before the next), timer queries elsewhere. Each frame of a rung
// stands between two of the baseline, and the figure is the median of the ratios with its quartiles, so that drift of the machine cancels.
#include <burnish/renderer.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include "paths.h"

using namespace burnish;

namespace {

struct Arguments {
  std::string output, scene = BURNISH_BINARY_DIR "/share/burnish/samples/fps/fps.gltf", camera = "hero", size = "480x270", term;  ///< term: only this one; empty: all
  int rounds = 11;
};

[[noreturn]] void stop(const Error& error) {
  std::cerr << "rung_costs: " << error.message() << '\n';
  std::exit(1);
}

struct Stage {
  std::unique_ptr<Context> context;
  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<OffscreenTarget> target;
  Scene scene;
  View view;
  glm::ivec2 size{640, 360};
};

/// Milliseconds of the passes that shade: lighting, or forward with what it stands for left out.
double shadingMs(Stage& s, const Quality& quality) {
  RenderRequest request;
  request.output = Output::Linear;
  request.timing = TimingMode::Profile;
  const auto stats = s.renderer->render(s.scene, {&s.view, 1}, s.target->target(), quality, request);
  if (!stats) stop(stats.error());
  double ms = 0;
  for (const PassTime& pass : stats->passes)
    if (pass.name == "lighting" || pass.name == "forward") ms += s.renderer->capabilities().software ? pass.cpuMs : pass.gpuMs;
  return ms;
}

Image picture(Stage& s, const Quality& quality) {
  RenderRequest request;
  request.output = Output::Linear;
  if (const auto stats = s.renderer->render(s.scene, {&s.view, 1}, s.target->target(), quality, request); !stats) stop(stats.error());
  auto image = s.target->read();
  if (!image) stop(image.error());
  return std::move(*image);
}

/// Root mean square of the differences over that of the reference, and the change of the mean.
struct Difference {
  double rms = 0, energy = 0;
};
Difference difference(const Image& a, const Image& reference) {
  double d2 = 0, r2 = 0, sumA = 0, sumR = 0;
  for (std::size_t i = 0; i < a.pixelCount() * 4; ++i) {
    if (i % 4 == 3) continue;
    // Radiance over 100 cd/m² counts as 100: one lamp must not drown the rest.
    const double x = std::min(double(a.f32()[i]), 100.0), r = std::min(double(reference.f32()[i]), 100.0);
    d2 += (x - r) * (x - r), r2 += r * r, sumA += x, sumR += r;
  }
  return {std::sqrt(d2 / r2), sumA / sumR - 1};
}

struct Row {
  std::size_t term = 0, rung = 0;
  Quality quality;
  std::vector<double> ratios;
  Difference difference;
};

double quantile(std::vector<double> v, double q) {
  std::sort(v.begin(), v.end());
  const double at = q * double(v.size() - 1);
  const std::size_t i = std::size_t(at);
  return i + 1 < v.size() ? v[i] + (v[i + 1] - v[i]) * (at - double(i)) : v.back();
}

void measure(Stage& s, const Quality& baseline, std::vector<Row>& rows, int rounds, const char* name) {
  // Compiled and warm before anything counts.
  for (int i = 0; i < 3; ++i) shadingMs(s, baseline);
  for (Row& row : rows) shadingMs(s, row.quality);
  for (int round = 0; round < rounds; ++round) {
    double before = shadingMs(s, baseline);
    for (Row& row : rows) {
      // The frame before the measured one counts for nothing: a driver may have dropped the programs' code since the last round.
      shadingMs(s, row.quality);
      const double ms = shadingMs(s, row.quality), after = shadingMs(s, baseline);
      row.ratios.push_back(ms / (0.5 * (before + after)));
      before = after;
    }
    std::cerr << fmt::format("rung_costs: {}: round {} of {}\n", name, round + 1, rounds);
  }
}

std::vector<Row> rowsOver(const Quality& baseline, const std::string& only) {
  std::vector<Row> rows;
  for (std::size_t t = 0; t < terms().size(); ++t) {
    if (terms()[t].picture || (!only.empty() && only != terms()[t].name)) continue;
    for (std::size_t r = 0; r < terms()[t].rungs.size(); ++r) {
      Row row{t, r, baseline, {}, {}};
      setRung(row.quality, t, r);
      if (terms()[t].name == "path" || terms()[t].rungs[r].forwardOnly) continue;  // another path: the lighting pass is not there
      if (!idleRungs(row.quality).empty() && idleRungs(baseline).empty()) continue;   // does nothing beside the baseline's other rungs
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

/// The most exact rung of a term that the deferred path has.
std::size_t topRung(std::size_t term) {
  std::size_t r = terms()[term].rungs.size() - 1;
  while (terms()[term].rungs[r].forwardOnly) --r;
  return r;
}

std::string tableOf(const std::vector<Row>& rows, const Quality& baseline, bool errors) {
  std::string text = errors ? "| term | rung | time | quartiles | rms | energy |\n|---|---|---|---|---|---|\n" : "| term | rung | time | quartiles |\n|---|---|---|---|\n";
  for (const Row& row : rows) {
    const Term& term = terms()[row.term];
    text += fmt::format("| {} | {}{} | {:.3f} | {:.3f} to {:.3f} |", term.name, term.rungs[row.rung].name, rungOf(baseline, row.term) == row.rung ? " *" : "", quantile(row.ratios, 0.5),
                        quantile(row.ratios, 0.25), quantile(row.ratios, 0.75));
    if (errors) text += fmt::format(" {:.2f} % | {:+.2f} % |", 100 * row.difference.rms, 100 * row.difference.energy);
    text += '\n';
  }
  return text;
}

std::string pageOf(Stage& s, const Arguments& a) {
  Quality seed, usual, exact;
  (void)setPreset(seed, "seed");
  (void)setPreset(exact, "exact");
  std::vector<Row> overSeed = rowsOver(seed, a.term), overUsual = rowsOver(usual, a.term), presets(2);
  presets[0].quality = usual;
  presets[1].quality = exact;
  measure(s, seed, overSeed, a.rounds, "over seed");
  measure(s, usual, overUsual, a.rounds, "over default");
  if (a.term.empty()) measure(s, seed, presets, a.rounds, "presets");
  for (Row& row : overUsual) {
    Quality top = row.quality;
    setRung(top, row.term, topRung(row.term));
    row.difference = difference(picture(s, row.quality), picture(s, top));
  }
  const Capabilities& caps = s.renderer->capabilities();
  std::string text = fmt::format(
      "# What each rung costs\n\n<!-- Written by rung_costs: do not edit. -->\n"
      "Printed by `build/release/bin/rung_costs -o docs/rungs.md` (scene `{}`, camera `{}`, {}x{}, {} rounds) on {}. Times are of the lighting pass, {}: medians of {} ratios to the\n"
      "baseline, whose frames stand before and after each, with quartiles. Compare figures within a table only.\n\n"
      "`burnish render --list-rungs` says what each rung is and where it comes from.\n",
      std::filesystem::path(a.scene).stem().string(), a.camera, s.size.x, s.size.y, a.rounds, caps.renderer, caps.software ? "CPU time of the process" : "GPU time", a.rounds);
  if (a.term.empty())
    text += fmt::format("\n## The presets, over `seed`\n\n| preset | time | quartiles |\n|---|---|---|\n| default | {:.3f} | {:.3f} to {:.3f} |\n| exact | {:.3f} | {:.3f} to {:.3f} |\n",
                      quantile(presets[0].ratios, 0.5), quantile(presets[0].ratios, 0.25), quantile(presets[0].ratios, 0.75), quantile(presets[1].ratios, 0.5), quantile(presets[1].ratios, 0.25),
                      quantile(presets[1].ratios, 0.75));
  text += "\n## `seed` with one rung changed, over `seed`\n\n`*` marks the rung that `seed` has.\n\n" + tableOf(overSeed, seed, false);
  text +=
      "\n## `default` with one rung changed, over `default`\n\n`*` marks the rung that `default` has. rms and energy: root mean square of the difference to the same picture with the term's last\n"
      "rung, over that picture's, and the change of the mean; linear radiance, held at 100 cd/m². Specular models and distributions differ by intent: their last rung is no truth.\n\n" +
      tableOf(overUsual, usual, true);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  std::string rounds = std::to_string(a.rounds);
  const std::map<std::string, std::string*> options{{"-o", &a.output}, {"--scene", &a.scene}, {"--camera", &a.camera}, {"--size", &a.size}, {"--term", &a.term}, {"--rounds", &rounds}};
  for (int i = 1; i < argc; i += 2) {
    const auto option = options.find(argv[i]);
    if (option == options.end() || i + 1 == argc) stop({argv[i], "is no option, or lacks its value", "usage: rung_costs [-o FILE] [--scene FILE] [--camera NAME] [--size WxH] [--rounds N] [--term NAME]"});
    *option->second = argv[i + 1];
  }
  a.rounds = std::atoi(rounds.c_str());
  if (a.rounds < 1) stop({rounds, "is no number of rounds", "give at least 1"});
  Stage s;
  if (std::sscanf(a.size.c_str(), "%dx%d", &s.size.x, &s.size.y) != 2) stop({a.size, "is no size", "give WxH"});
  auto context = Context::create({.backend = Backend::Egl, .visible = false});
  if (!context) stop(context.error());
  s.context = std::move(*context);
  auto renderer = Renderer::create(s.context->procAddress());
  if (!renderer) stop(renderer.error());
  s.renderer = std::move(*renderer);
  auto target = OffscreenTarget::create(s.context->procAddress(), s.size, Output::Linear);
  if (!target) stop(target.error());
  s.target = std::move(*target);
  Report report;
  auto scene = loadScene(a.scene, {}, report);
  if (!scene) stop(scene.error());
  s.scene = std::move(*scene);
  for (const Warning& w : report.warnings()) std::cerr << "rung_costs: warning: " << w.message() << '\n';
  bool found = false;
  s.scene.cameras.each([&](Id<Camera>, const Camera& camera) {
    if (camera.name == a.camera) s.view = viewOf(s.scene, camera), found = true;
  });
  if (!found) stop({a.scene, fmt::format("has no camera '{}'", a.camera), "name one of its cameras"});
  const std::string page = pageOf(s, a);
  if (a.output.empty()) return std::cout << page, 0;
  std::ofstream out(a.output);
  out << page;
  out.close();
  if (!out) stop({a.output, "cannot be written", "choose another place"});
  return 0;
}
