// burnish stability: the hard cases on this machine, with the guard ledger.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "commands.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

struct StabilityArguments {
  std::string output;
  std::optional<burnish::Backend> backend;
  std::vector<std::string> cases;
  std::filesystem::path shaders;
  bool quick = false, noCpu = false, noLedger = false;
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
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{:.4g}", v) : std::string("-"); };
  for (const auto& c : cases) {
    if (c.what != what) fmt::print("{:<4} {}\n", c.id, c.what);
    what = c.what;
    fmt::print("       {:<6} {:<8} {:>12} of {:<10.4g}{}\n", c.pass ? "holds" : "FAILS", c.backend, number(c.value), c.bound, c.note.empty() ? "" : " " + shown(c.note));
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
  const auto place = [&](const burnish::StabilityCase& r) { return std::make_pair(std::atoi(r.id.c_str() + 1), std::find(order.begin(), order.end(), r.id + r.what) - order.begin()); };
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return rows;
}

/// "1 case: H12 (egl)" or "3 cases: H12 (egl, osmesa), H15 (double)".
std::string failedCases(const std::vector<burnish::StabilityCase>& rows) {
  std::vector<std::pair<std::string, std::vector<std::string>>> failed;
  for (const auto& r : rows) {
    if (r.pass) continue;
    if (failed.empty() || failed.back().first != r.id) failed.push_back({r.id, {}});
    auto& backends = failed.back().second;
    if (std::find(backends.begin(), backends.end(), r.backend) == backends.end()) backends.push_back(r.backend);
  }
  std::vector<std::string> texts;
  for (const auto& [id, backends] : failed) texts.push_back(fmt::format("{} ({})", id, listed(backends)));
  return fmt::format("{} {}: {}", failed.size(), failed.size() == 1 ? "case" : "cases", listed(texts));
}

/// The backend's rows, and the one of a context that does not open.
void runBackend(burnish::Backend backend, const burnish::StabilityOptions& options, std::vector<burnish::StabilityCase>& rows) {
  SceneOptions context;
  context.backend = backend;
  const std::string name(burnish::backendName(backend));
  const auto opened = openContext(context);
  if (!opened) {
    rows.push_back({"H28", "a context can be opened", name, std::nan(""), 0, false, opened.error().message()});
    return;
  }
  const auto found = burnish::stabilityOnGpu((*opened)->procAddress(), name, options);
  rows.insert(rows.end(), found.begin(), found.end());
}

int run(const StabilityArguments& arguments) {
  if (!arguments.output.empty() && arguments.output != "-")
    if (auto good = checkOutput(arguments.output); !good) return printError(good.error());
  Progress progress;
  const auto step = [&progress](const std::string& stage) {
    progress.stage(stage);
    return [&progress](int done, int total, std::string_view) { progress.step(done, total); };
  };
  burnish::StabilityOptions options{arguments.cases, arguments.quick, arguments.shaders, {}};
  std::vector<burnish::StabilityCase> rows;
  if (!arguments.noCpu) {
    options.progress = step("hard cases on the CPU");
    rows = burnish::stabilityOnCpu(options);
  }
  for (const auto backend : {burnish::Backend::Egl, burnish::Backend::OsMesa, burnish::Backend::Glfw}) {
    if (arguments.backend ? *arguments.backend != backend : backend == burnish::Backend::Glfw) continue;
    options.progress = step(fmt::format("hard cases on {}", burnish::backendName(backend)));
    runBackend(backend, options, rows);
  }
  rows = grouped(std::move(rows));
  std::vector<burnish::GuardRow> guards;
  if (!arguments.noLedger && arguments.cases.empty()) guards = burnish::guardLedger(step("guard ledger"));
  progress.finish();
  if (!arguments.output.empty())
    if (auto written = writeJson(arguments.output, toJson(rows, guards)); !written) return printError(written.error());
  const auto failed = std::count_if(rows.begin(), rows.end(), [](const auto& r) { return !r.pass; });
  if (arguments.output != "-") {
    print(rows);
    if (!guards.empty()) print(guards);
    fmt::print("{} of {} hold{}\n", rows.size() - std::size_t(failed), rows.size(), failed ? "; fails: " + failedCases(rows) : "");
  }
  return failed ? kFailed : kOk;
}

}  // namespace

Command addStability(CLI::App& program) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* app = program.add_subcommand("stability", "The hard cases on this machine's backends, with the guard ledger; exit code 1 if one fails");
  app->add_option("-o,--output", arguments->output, "write the table as JSON (- for standard output)")->type_name("FILE");
  addChoice(*app, "--backend", {"egl", "osmesa", "glfw"}, [arguments](std::size_t i) { arguments->backend = burnish::Backend(i); }, "this backend only (egl and osmesa)");
  app->add_option("--case", arguments->cases, "this case only (H12); may be given again")->type_name("ID")->allow_extra_args(false)->check([](const std::string& id) {
    const auto known = burnish::stabilityIds();
    return std::find(known.begin(), known.end(), id) != known.end() ? std::string() : fmt::format("'{}' is no case; there are: {}", id, listed(known));
  });
  app->add_flag("--quick", arguments->quick, "leave out the cases that take more than a second or so");
  app->add_option("--shaders", arguments->shaders, "a folder that is looked into before the shaders of the library")->type_name("DIR")->check(CLI::ExistingDirectory);
  app->add_flag("--no-cpu", arguments->noCpu, "the backends only");
  app->add_flag("--no-ledger", arguments->noLedger, "leave the guard ledger out (so does --case)");
  return {app, [arguments] { return run(*arguments); }};
}

}  // namespace cli
