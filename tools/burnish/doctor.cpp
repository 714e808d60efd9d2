// burnish doctor: what this machine's OpenGL can do, and which hard cases fail on its driver. One page for a bug report.
#include <burnish/context.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "commands.h"
#include "doctor_report.h"
#include "messages.h"
#include "output.h"
#include "scene_options.h"

namespace cli {
namespace {

struct DoctorArguments {
  std::optional<burnish::Backend> backend;
  std::string output;
  bool quick = false, noCases = false, extensions = false;
};

BackendReport examine(burnish::Backend backend, const DoctorArguments& arguments, Progress& progress) {
  BackendReport report;
  report.name = burnish::backendName(backend);
  progress.stage("looking at " + report.name);
  SceneOptions options;
  options.backend = backend;
  const auto context = openContext(options);
  if (!context) {
    report.error = context.error().message();
    return report;
  }
  const burnish::ProcAddress address = (*context)->procAddress();
  const auto capabilities = burnish::queryCapabilities(address);
  if (!capabilities) {
    report.error = capabilities.error().message();
    return report;
  }
  report.usable = true;
  report.capabilities = *capabilities;
  report.trial = tryFrame(address);
  if (arguments.noCases) return report;
  progress.stage("hard cases on " + report.name);
  burnish::StabilityOptions cases;
  cases.quick = arguments.quick;
  cases.progress = [&progress](int done, int total, std::string_view) { progress.step(done, total); };
  report.casesRun = true;
  report.cases = burnish::stabilityOnGpu(address, report.name, cases);
  return report;
}

int run(const DoctorArguments& arguments) {
  if (!arguments.output.empty() && arguments.output != "-")
    if (auto good = checkOutput(arguments.output); !good) return printError(good.error());
  std::vector<BackendReport> reports;
  {
    Progress progress;
    for (const auto backend : {burnish::Backend::Egl, burnish::Backend::OsMesa, burnish::Backend::Glfw})
      if (!arguments.backend || *arguments.backend == backend) reports.push_back(examine(backend, arguments, progress));
  }
  const MachineReport machine = lookAtMachine();
  if (!arguments.output.empty())
    if (auto written = writeJson(arguments.output, toJson(machine, reports)); !written) return printError(written.error());
  if (arguments.output != "-") {
    print(machine);
    for (const BackendReport& report : reports) print(report, arguments.extensions);
    printRemedies(reports, arguments.quick);
  }
  const bool usable = std::any_of(reports.begin(), reports.end(), [](const BackendReport& r) { return r.usable; });
  const bool failed = std::any_of(reports.begin(), reports.end(), [](const BackendReport& r) { return r.failed() > 0; });
  if (!usable && !arguments.backend) return printError({"doctor", "no backend gives OpenGL 4.5 core", "install Mesa: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri libosmesa6"});
  return usable && !failed ? kOk : kFailed;
}

}  // namespace

Command addDoctor(CLI::App& program) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* app = program.add_subcommand("doctor", "What this machine's OpenGL can do, and which hard cases fail on its driver; exit code 1 if one does");
  addChoice(*app, "--backend", {"egl", "osmesa", "glfw"}, [arguments](std::size_t i) { arguments->backend = burnish::Backend(i); }, "look at this one only; failing to open it is a failure then");
  app->add_flag("--quick", arguments->quick, "leave out the hard cases that take more than a second or so");
  app->add_flag("--no-cases", arguments->noCases, "leave all of them out: capabilities alone");
  app->add_flag("--extensions", arguments->extensions, "list the driver's extensions too");
  app->add_option("--json", arguments->output, "write all of it as JSON (- for standard output)")->type_name("FILE");
  return {app, [arguments] { return run(*arguments); }};
}

}  // namespace cli
