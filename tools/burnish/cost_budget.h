// burnish cost --budget and --target-error: what is asked for, and what is said of the answer.
#pragma once
#include <burnish/measure.h>

#include <CLI/CLI.hpp>
#include <filesystem>

namespace cli {

struct BudgetArguments {
  struct Request {
    std::string text;     ///< as it was typed
    double value = 0;     ///< milliseconds, share of the base's frame, or rms
    bool share = false, error = false;
    [[nodiscard]] std::string file() const;  ///< "quality_50_percent.json"
  };
  std::vector<Request> requests;
  double minutes = 4;  ///< of each

  /// --budget, --target-error, --budget-minutes. What is no number is a usage error.
  void addTo(CLI::App& app);
  /// " --budget 50%" and so on, as the command line had them.
  [[nodiscard]] std::string command() const;
  /// For spendBudget, once the base's frame is known. `progress` goes with the first.
  [[nodiscard]] std::vector<burnish::BudgetOptions> options(const burnish::CostReport& cost, std::function<bool(double, std::string_view)> progress) const;
};

/// A quality file for each result into the folder.
burnish::Result<void> writeQualities(const std::filesystem::path& folder, const BudgetArguments& arguments, const std::vector<burnish::BudgetResult>& results, const burnish::CostReport& cost);
/// What was chosen, why, and what more time would buy.
void printBudgets(const std::filesystem::path& folder, const BudgetArguments& arguments, const std::vector<burnish::BudgetResult>& results, const burnish::CostReport& cost);

}  // namespace cli
