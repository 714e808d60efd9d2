// What each effect costs: on the samples, every effect that the scene calls for against the same frame with that effect taken off the list, and every effect that a setting calls for
// against the frame without it; written as a page of tables.
// Usage: effect_costs [-o docs/effects.md] [--samples fps,fps+64,rts,space] [--camera hero] [--size 1280x720] [--rounds 9] [--unit build/release/bin/unit_pass]
// Times are CPU milliseconds of the process where the renderer is software (each pass is finished before the next), GPU milliseconds elsewhere. Frames with and without alternate; a figure is
// the median of the rounds' differences with its quartiles. With --unit the program is run before and after each sample and milliseconds are given in its units too (docs/benchmarks.md).
#include <burnish/renderer.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include "paths.h"

using namespace burnish;

namespace {

struct Arguments {
  std::string output, samples = "fps,fps+64,rts,space", camera = "hero", size = "1280x720", rounds = "9", unit;
};

[[noreturn]] void stop(const Error& error) {
  std::cerr << "effect_costs: " << error.message() << '\n';
  std::exit(1);
}

double quantile(std::vector<double> v, double q) {
  std::sort(v.begin(), v.end());
  const double at = q * double(v.size() - 1);
  const std::size_t i = std::size_t(at);
  return i + 1 < v.size() ? v[i] + (v[i + 1] - v[i]) * (at - double(i)) : v.back();
}

/// A frame's passes and their sum, milliseconds.
struct Frame {
  double total = 0;
  std::vector<std::pair<std::string, double>> passes;
};

struct Bench {
  Context& context;
  const Scene& scene;
  const View& view;
  glm::ivec2 size;
};

/// One way to draw the frame, with a renderer of its own.
class Variant {
 public:
  Variant(const Bench& b, Quality quality, std::vector<std::string> removed) : bench_(b), quality_(std::move(quality)) {
    RendererOptions options;
    options.removedEffects = std::move(removed);
    auto renderer = Renderer::create(b.context.procAddress(), options);
    if (!renderer) stop(renderer.error());
    renderer_ = std::move(*renderer);
    auto target = OffscreenTarget::create(b.context.procAddress(), b.size, Output::Display);
    if (!target) stop(target.error());
    target_ = std::move(*target);
    for (int i = 0; i < 3; ++i) draw();
  }
  Frame draw() {
    RenderRequest request;
    request.timing = TimingMode::Profile;
    const auto stats = renderer_->render(bench_.scene, {&bench_.view, 1}, target_->target(), quality_, request);
    if (!stats) stop(stats.error());
    Frame f;
    for (const PassTime& pass : stats->passes) {
      const double ms = renderer_->capabilities().software ? pass.cpuMs : pass.gpuMs;
      f.passes.emplace_back(pass.name, ms);
      f.total += ms;
    }
    return f;
  }
  [[nodiscard]] const FramePlan& plan() const { return renderer_->lastPlan(); }
  [[nodiscard]] const Capabilities& caps() const { return renderer_->capabilities(); }

 private:
  Bench bench_;
  Quality quality_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<OffscreenTarget> target_;
};

struct Spread {
  double median = 0, low = 0, high = 0;
};
Spread spreadOf(const std::vector<double>& v) { return {quantile(v, 0.5), quantile(v, 0.25), quantile(v, 0.75)}; }

/// with - without, alternating.
Spread difference(Variant& with, Variant& without, int rounds) {
  std::vector<double> d;
  for (int i = 0; i < rounds; ++i) {
    const double a = with.draw().total, b = without.draw().total, c = with.draw().total;
    d.push_back(0.5 * (a + c) - b);
  }
  return spreadOf(d);
}

/// Rungs that stand for effects called by settings, each put in force over the default; and the rung of the same frame without.
struct Setting {
  const char *term, *rung, *without;
};
constexpr Setting kSettings[] = {
    {"occlusion", "screen-4", "baked"}, {"occlusion", "screen-8", "baked"}, {"occlusion", "screen-16", "baked"}, 
    {"shadow", "tap", "none"}, {"shadow", "pcf", "none"}, {"shadow", "pcss", "none"}, 
    {"bloom", "scatter", "none"}, {"antialiasing", "edge", "none"}, {"antialiasing", "temporal", "none"}, {"specular-antialiasing", "geometric", "none"}};

double unitMs(const std::string& program) {
  if (program.empty()) return 0;
  FILE* pipe = popen(program.c_str(), "r");
  double ms = 0;
  if (!pipe || std::fscanf(pipe, "unit pass %lf", &ms) != 1) stop({program, "does not print a unit pass", "build it (docs/benchmarks.md), or leave --unit out"});
  pclose(pipe);
  return ms;
}

std::string inUnits(double ms, double unit) { return unit > 0 ? fmt::format(" {:.2f} |", ms / unit) : std::string(); }

/// objects: what in view calls for the effect, 0 for a setting.
std::string rowOf(const std::string& name, const Spread& s, double unit, glm::ivec2 size, int objects) {
  const std::string each = objects > 0 ? fmt::format("{} | {:.1f}", objects, s.median * 1e3 / objects) : std::string("- | -");
  return fmt::format("| {} | {:.2f} | {:.2f} to {:.2f} |{} {:.2f} | {} |\n", name, s.median, s.low, s.high, inUnits(s.median, unit), s.median * 1e6 / (double(size.x) * double(size.y)), each);
}

/// Adds lamps without shadows until the scene has `wanted` local lights without, spread over the box of those that it has (Halton's sequence), each as bright as its lamps are on average.
void addLamps(Scene& scene, int wanted) {
  int have = 0;
  glm::dvec3 low(1e30), high(-1e30);
  double intensity = 0;
  scene.lights.each([&](Id<Light>, const Light& l) {
    if (l.kind == LightKind::Directional) return;
    const Node* node = scene.nodes.get(l.node);
    const glm::dvec3 at = node ? glm::dvec3(node->local[3]) : glm::dvec3(0);
    low = glm::min(low, at), high = glm::max(high, at);
    intensity += l.intensity;
    if (!l.castsShadow) ++have;
  });
  if (have == 0) stop({"lamps", "the scene has none to go by", "name a sample with local lights"});
  const auto halton = [](int i, int base) {
    double f = 1, sum = 0;
    for (; i > 0; i /= base) f /= base, sum += f * (i % base);
    return sum;
  };
  intensity /= have;
  for (int i = 1; have < wanted; ++i, ++have) {
    Node node;
    node.local[3] = glm::dvec4(glm::mix(low, high, glm::dvec3(halton(i, 2), halton(i, 3), halton(i, 5))), 1);
    Light lamp;
    lamp.kind = LightKind::Point;
    lamp.intensity = float(intensity);
    lamp.range = 4;
    lamp.node = scene.nodes.add(node);
    scene.lights.add(lamp);
  }
}

/// title: a sample, or "fps+64": with lamps added until 64 local lights cast no shadows.
std::string sampleText(Context& context, const std::string& title, const Arguments& a, glm::ivec2 size, int rounds) {
  Report report;
  const std::size_t plus = title.find('+');
  const std::string name = title.substr(0, plus);
  auto scene = loadScene(fmt::format(BURNISH_BINARY_DIR "/share/burnish/samples/{0}/{0}.gltf", name), {}, report);
  if (!scene) stop(scene.error());
  if (plus != std::string::npos) addLamps(*scene, std::atoi(title.c_str() + plus + 1));
  View view;
  bool found = false;
  scene->cameras.each([&](Id<Camera>, const Camera& camera) {
    if (camera.name == a.camera) view = viewOf(*scene, camera), found = true;
  });
  if (!found) stop({name, fmt::format("has no camera '{}'", a.camera), "name one of its cameras"});
  const Bench bench{context, *scene, view, size};
  Variant usual(bench, {}, {});
  const FramePlan plan = usual.plan();
  const double before = unitMs(a.unit);
  std::map<std::string, std::vector<double>> passes;
  std::vector<double> totals;
  for (int i = 0; i < rounds; ++i) {
    const Frame f = usual.draw();
    totals.push_back(f.total);
    for (const auto& [pass, ms] : f.passes) passes[pass].push_back(ms);
  }
  const double unit = 0.5 * (before + unitMs(a.unit));
  const std::string unitColumn = unit > 0 ? " units |" : "", unitLine = unit > 0 ? "---|" : "";
  std::string text = fmt::format("\n## {}\n\nThe frame with the default quality, pass by pass{}.\n\n| pass | ms | quartiles |{} called for by |\n|---|---|---|{}---|\n", title,
                                 unit > 0 ? fmt::format(" (a unit here: {:.2f} ms)", unit) : "", unitColumn, unitLine);
  for (const PassPlan& pass : plan.passes) {
    const Spread s = spreadOf(passes[pass.name]);
    text += fmt::format("| {} | {:.2f} | {:.2f} to {:.2f} |{} {} |\n", pass.name, s.median, s.low, s.high, inUnits(s.median, unit), fmt::join(pass.effects, ", "));
  }
  const Spread total = spreadOf(totals);
  text += fmt::format("| frame | {:.2f} | {:.2f} to {:.2f} |{} |\n", total.median, total.low, total.high, inUnits(total.median, unit));
  text += fmt::format("\nEffects, each against the frame without it.\n\n| effect | ms | quartiles |{} ns a pixel | objects | µs an object |\n|---|---|---|{}---|---|---|\n", unitColumn, unitLine);
  for (const EffectPlan& e : plan.effects) {
    if (!e.on || e.name == "geometry" || e.name == "tone_mapping") continue;  // without them there is no picture
    Variant without(bench, {}, {e.name});
    text += rowOf(e.name, difference(usual, without, rounds), unit, size, e.objects);
    std::cerr << fmt::format("effect_costs: {}: {}\n", title, e.name);
  }
  for (const auto& [term, rung, otherwise] : kSettings) {
    Quality with, none;
    if (auto set = setRung(with, term, rung); !set) stop(set.error());
    if (auto set = setRung(none, term, otherwise); !set) stop(set.error());
    Variant on(bench, with, {}), off(bench, none, {});
    if (on.plan().programs == off.plan().programs && on.plan().targets == off.plan().targets) continue;  // the scene does not call for it
    text += rowOf(fmt::format("{}={}", term, rung), difference(on, off, rounds), unit, size, 0);
    std::cerr << fmt::format("effect_costs: {}: {}={}\n", title, term, rung);
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  const std::map<std::string, std::string*> options{{"-o", &a.output}, {"--samples", &a.samples}, {"--camera", &a.camera}, {"--size", &a.size}, {"--rounds", &a.rounds}, {"--unit", &a.unit}};
  for (int i = 1; i < argc; i += 2) {
    const auto option = options.find(argv[i]);
    if (option == options.end() || i + 1 == argc)
      stop({argv[i], "is no option, or lacks its value", "usage: effect_costs [-o FILE] [--samples NAME,NAME] [--camera NAME] [--size WxH] [--rounds N] [--unit PROGRAM]"});
    *option->second = argv[i + 1];
  }
  const int rounds = std::atoi(a.rounds.c_str());
  if (rounds < 1) stop({a.rounds, "is no number of rounds", "give at least 1"});
  glm::ivec2 size;
  if (std::sscanf(a.size.c_str(), "%dx%d", &size.x, &size.y) != 2) stop({a.size, "is no size", "give WxH"});
  auto context = Context::create({.backend = Backend::Egl, .visible = false});
  if (!context) stop(context.error());
  const auto caps = queryCapabilities((*context)->procAddress());
  if (!caps) stop(caps.error());
  std::string text = fmt::format(
      "# What each effect costs\n\n<!-- Written by effect_costs: do not edit. -->\nPrinted by `build/release/bin/effect_costs -o docs/effects.md{}` (camera `{}`, {}x{}, {} rounds) on {}. {}; medians of the\n"
      "rounds with quartiles, frames with and without an effect alternating. A figure within its own quartiles of 0 is nothing. Compare figures within a sample only.\n"
      "Objects are the instances or lights in view that call for the effect. `fps+64` is the sample with lamps added until 64 cast no shadow, beside its 4 that do.\n",
      a.unit.empty() ? "" : " --unit build/release/bin/unit_pass", a.camera, size.x, size.y, rounds, caps->renderer,
      caps->software ? "CPU milliseconds of the process, each pass finished before the next" : "GPU milliseconds");
  for (std::size_t at = 0; at <= a.samples.size();) {
    const std::size_t end = std::min(a.samples.find(',', at), a.samples.size());
    text += sampleText(**context, a.samples.substr(at, end - at), a, size, rounds);
    at = end + 1;
  }
  if (a.output.empty()) return std::cout << text, 0;
  std::ofstream out(a.output);
  out << text;
  out.close();
  if (!out) stop({a.output, "cannot be written", "choose another place"});
  return 0;
}
