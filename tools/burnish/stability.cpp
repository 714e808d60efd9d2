// burnish stability: the hard cases on this machine, with the guard ledger.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

struct StabilityArguments {
  std::string output;
  std::optional<burnish::Backend> backend;
  bool noLedger = false;
};

Json toJson(const std::vector<burnish::StabilityCase>& cases, const std::vector<burnish::GuardRow>& guards) {
  Json out;
  out["schema_version"] = 1;
  out["cases"] = Json::array();
  for (const auto& c : cases)
    out["cases"].push_back({{"id", c.id}, {"case", c.what}, {"backend", c.backend}, {"value", c.value}, {"bound", c.bound}, {"pass", c.pass}, {"note", c.note}});
  out["guards"] = Json::array();
  for (const auto& g : guards)
    out["guards"].push_back({{"name", g.name},
                             {"value", g.value},
                             {"reason", g.reason},
                             {"worst_energy_loss", g.worstEnergyLoss},
                             {"where", g.where},
                             {"worst_energy_gain", g.worstEnergyGain},
                             {"nonfinite_without", g.nonfiniteWithout}});
  return out;
}

void print(const std::vector<burnish::StabilityCase>& cases) {
  std::string what;
  for (const auto& c : cases) {
    if (c.what != what) fmt::print("{:<4} {}\n", c.id, c.what);
    what = c.what;
    fmt::print("       {:<6} {:<8} {:>12.4g} of {:<10.4g}{}\n", c.pass ? "holds" : "FAILS", c.backend, c.value, c.bound, c.note.empty() ? "" : " " + shown(c.note));
  }
}

void print(const std::vector<burnish::GuardRow>& guards) {
  fmt::print("guard ledger: the largest share of reflected energy that each guard takes away (over rungs x roughness x angle), and how many values are not finite without it\n");
  fmt::print("  {:<28} {:>12} {:>10} {:>11}\n", "guard", "value", "loss", "not finite");
  for (const auto& g : guards) {
    fmt::print("  {:<28} {:>12} {:>10.3g} {:>11}{}\n", g.name, std::isnan(g.value) ? "clamp" : fmt::format("{:g}", g.value), g.worstEnergyLoss, g.nonfiniteWithout, g.where.empty() ? "" : "  " + g.where);
    fmt::print("      {}\n", g.reason);
  }
}

/// One table in which each case's rows stand together.
std::vector<burnish::StabilityCase> grouped(std::vector<burnish::StabilityCase> rows) {
  std::vector<std::string> order;
  for (const auto& r : rows)
    if (std::find(order.begin(), order.end(), r.id + r.what) == order.end()) order.push_back(r.id + r.what);
  const auto place = [&](const burnish::StabilityCase& r) { return std::make_pair(r.id, std::find(order.begin(), order.end(), r.id + r.what) - order.begin()); };
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return rows;
}

int run(const StabilityArguments& arguments) {
  if (!arguments.output.empty() && arguments.output != "-")
    if (auto good = checkOutput(arguments.output); !good) return printError(good.error());
  Progress progress;
  const auto step = [&progress](const std::string& stage) {
    progress.stage(stage);
    return [&progress](int done, int total, std::string_view) { progress.step(done, total); };
  };
  std::vector<burnish::StabilityCase> rows = burnish::stabilityOnCpu(step("hard cases on the CPU"));
  for (const auto backend : {burnish::Backend::Egl, burnish::Backend::OsMesa, burnish::Backend::Glfw}) {
    if (arguments.backend ? *arguments.backend != backend : backend == burnish::Backend::Glfw) continue;
    SceneOptions options;
    options.backend = backend;
    const std::string name(burnish::backendName(backend));
    const auto context = openContext(options);
    if (!context) {
      rows.push_back({"H28", "a context can be opened", name, std::nan(""), 0, false, context.error().message()});
      continue;
    }
    const auto found = burnish::stabilityOnGpu((*context)->procAddress(), name, step("hard cases on " + name));
    rows.insert(rows.end(), found.begin(), found.end());
  }
  rows = grouped(std::move(rows));
  std::vector<burnish::GuardRow> guards;
  if (!arguments.noLedger) guards = burnish::guardLedger(step("guard ledger"));
  progress.finish();
  if (!arguments.output.empty())
    if (auto written = writeJson(arguments.output, toJson(rows, guards)); !written) return printError(written.error());
  std::size_t failed = 0;
  for (const auto& r : rows) failed += r.pass ? 0 : 1;
  if (arguments.output != "-") {
    print(rows);
    if (!guards.empty()) print(guards);
    fmt::print("{} of {} hold\n", rows.size() - failed, rows.size());
  }
  return failed ? kFailed : kOk;
}

}  // namespace

Command addStability(CLI::App& program) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* app = program.add_subcommand("stability", "The hard cases on this machine's backends, with the guard ledger; exit code 1 if one fails");
  app->add_option("-o,--output", arguments->output, "write the table as JSON (- for standard output)")->type_name("FILE");
  addChoice(*app, "--backend", {"egl", "osmesa", "glfw"}, [arguments](std::size_t i) { arguments->backend = burnish::Backend(i); }, "this backend only (egl and osmesa)");
  app->add_flag("--no-ledger", arguments->noLedger, "leave the guard ledger out");
  return {app, [arguments] { return run(*arguments); }};
}

}  // namespace cli
