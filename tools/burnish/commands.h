// One function a subcommand: it adds itself to the program and returns what runs it.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace cli {

struct Command {
  CLI::App* app;
  std::function<int()> run;  ///< returns the exit code
};

Command addRender(CLI::App& program);
Command addPlan(CLI::App& program);
Command addBake(CLI::App& program);
Command addPrefilter(CLI::App& program);
Command addInspect(CLI::App& program);
Command addDoctor(CLI::App& program);
Command addReference(CLI::App& program);
Command addStability(CLI::App& program);
Command addCost(CLI::App& program);
Command addView(CLI::App& program);

}  // namespace cli
