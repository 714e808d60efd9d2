// burnish: the engine's program. Argument parsing and printing only; the work is in the library.
#include <fmt/format.h>

#include <algorithm>

#include "commands.h"
#include "messages.h"
#include "output.h"

using namespace cli;

namespace {

/// CLI11's help with whole commands in the usage line, and without what the errors say better (REQUIRED, Needs, Excludes, ranges).
class HelpText : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string name) const override {
    return CLI::Formatter::make_usage(app, app->get_parent() ? "burnish " + name : name);
  }
  std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = make_option_name(option, true) + (option->get_expected_max() > 1 ? "..." : "");
    return option->get_required() ? name : "[" + name + "]";
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string type = option->get_type_name();
    return type.empty() ? "" : " " + type.substr(0, type.find(':'));
  }
};

int usageError(const std::string& text, const CLI::App& app) {
  fmt::print(stderr, "burnish: {}: see '{} --help'\n", shown(text), app.get_parent() ? "burnish " + app.get_name() : "burnish");
  return kUsage;
}

/// The subcommand in use, else the program.
const CLI::App& appInUse(const CLI::App& program, const std::vector<Command>& commands) {
  for (const Command& command : commands)
    if (command.app->parsed()) return *command.app;
  return program;
}

std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

std::string describe(const CLI::ParseError& error, const CLI::App& program, const CLI::App& app) {
  const auto* extras = dynamic_cast<const CLI::ExtrasError*>(&error);
  const std::vector<std::string> rest = program.remaining(true);
  if (!extras || rest.empty()) return error.what();
  const std::string& word = rest.front();
  if (word.rfind("-", 0) != 0) return fmt::format("{}: one argument too many", word);
  return fmt::format("{}: unknown option{}", word, didYouMean(word.substr(0, word.find('=')), optionNames(app)));
}

int runProgram(int argc, char** argv) {
  CLI::App program("A compact deferred renderer that shows what its approximations cost.", "burnish");
  program.set_version_flag("--version", "burnish " BURNISH_VERSION);
  program.formatter(std::make_shared<HelpText>());
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::simple);
  const std::vector<Command> commands = {addRender(program), addView(program), addPlan(program), addBake(program), addPrefilter(program), addReference(program), addCost(program), addInspect(program), addDoctor(program), addStability(program)};

  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.app->get_name());
  if (argc < 2) {
    fmt::print(stderr, "{}", program.help());
    return kUsage;
  }
  if (argv[1][0] != '-' && std::find(names.begin(), names.end(), argv[1]) == names.end())
    return usageError(fmt::format("{}: unknown subcommand{}; there are: {}", argv[1], didYouMean(argv[1], names), listed(names)), program);

  try {
    program.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", appInUse(program, commands).help());
    return kOk;
  } catch (const CLI::CallForVersion&) {
    fmt::print("burnish " BURNISH_VERSION "\n");
    return kOk;
  } catch (const CLI::ParseError& error) {
    const CLI::App& app = appInUse(program, commands);
    return usageError(describe(error, program, app), app);
  }
  for (const Command& command : commands)
    if (command.app->parsed()) return command.run();
  return kUsage;
}

}  // namespace

int main(int argc, char** argv) {
  installSignals();
  try {
    const int code = runProgram(argc, argv);
    if (const auto flushed = flushStandardOutput(); !flushed) return printError(flushed.error());
    return code;
  } catch (const std::exception& error) {  // out of memory, in the main
    return printError({"internal error", error.what(), "please report it with the command that you ran"});
  }
}
