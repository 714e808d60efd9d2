#include "cost_budget.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "messages.h"

namespace cli {
namespace {

using burnish::BudgetResult;
using burnish::CostReport;
using burnish::FrontPoint;
using Request = BudgetArguments::Request;

double numberOf(const std::string& flag, const std::string& text, std::string_view digits, const char* expected) {
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value) || value <= 0) throw CLI::ValidationError(flag, fmt::format("'{}' is no {}", text, expected));
  return value;
}

Request timeRequest(const std::string& text) {
  const bool share = text.ends_with('%');
  Request r{text, numberOf("--budget", text, std::string_view(text).substr(0, text.size() - (share ? 1 : 0)), "budget: give milliseconds above 0, or a share of the base quality's frame, for example 50%"), share, false};
  if (share) r.value /= 100;
  return r;
}
Request errorRequest(const std::string& text) {
  const bool percent = text.ends_with('%');
  Request r{text, numberOf("--target-error", text, std::string_view(text).substr(0, text.size() - (percent ? 1 : 0)), "error: give a relative rms above 0, for example 0.02 or 2%"), false, true};
  if (percent) r.value /= 100;
  return r;
}

std::string timeOf(const FrontPoint& p) { return fmt::format("{:.3g} ms ({:.3g} to {:.3g})", p.ms.median, p.ms.low, p.ms.high); }
std::string errorOf(const FrontPoint& p) {
  return p.error.rmsSpread > 0 ? fmt::format("{:.3g} % ± {:.2g} %", 100 * p.error.rms, 100 * p.error.rmsSpread) : fmt::format("{:.3g} %", 100 * p.error.rms);
}

/// What one setting costs by itself, where it was measured: "-1.2 ms, error +0.3 %".
std::string aloneText(const std::string& setting, const CostReport& cost) {
  const std::size_t equals = setting.find('=');
  for (const FrontPoint& p : cost.front)
    if (p.settings.size() == 1 && p.settings.front() == setting && equals != std::string::npos)
      return fmt::format("alone {:+.2g} ms, error {:+.2g} %", p.ms.median - cost.base.ms.median, 100 * (p.error.rms - cost.base.error.rms));
  return "measured with others alone";
}

/// Settings of one that the other has not.
std::vector<std::string> differing(const FrontPoint& from, const FrontPoint& to) {
  std::vector<std::string> out;
  for (const std::string& s : to.settings)
    if (std::find(from.settings.begin(), from.settings.end(), s) == from.settings.end()) out.push_back(s);
  for (const std::string& s : from.settings) {
    const std::string name = s.substr(0, s.find('=') + 1);
    if (std::none_of(to.settings.begin(), to.settings.end(), [&](const std::string& t) { return t.starts_with(name); })) out.push_back(name + "as the base");
  }
  return out;
}

std::string askedFor(const Request& request, const BudgetResult& result) {
  if (request.error) return fmt::format("an error of {:.3g} %", 100 * result.targetError);
  return request.share ? fmt::format("{} of the base's frame, {:.3g} ms", request.text, result.ms) : fmt::format("{:.3g} ms", result.ms);
}

CLI::Option* addList(CLI::App& app, const char* flag, const char* type, const char* help, std::vector<Request>& requests, Request (*parse)(const std::string&)) {
  return app
      .add_option_function<std::vector<std::string>>(
          flag,
          [&requests, parse](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) requests.push_back(parse(text));
          },
          help)
      ->type_name(type)
      ->type_size(1)
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace

std::string Request::file() const {
  const std::string number = fmt::format("{:g}", share ? 100 * value : value);
  return error ? fmt::format("quality_error_{}.json", number) : fmt::format("quality_{}_{}.json", number, share ? "percent" : "ms");
}

void BudgetArguments::addTo(CLI::App& app) {
  CLI::Option* time = addList(app, "--budget", "MS|SHARE%", "finds the quality with the least error whose frame takes no longer: milliseconds, or a share of the base quality's frame; repeatable", requests, timeRequest);
  CLI::Option* error = addList(app, "--target-error", "E", "finds the fastest quality whose error is no larger: relative rms, 0.02 or 2%; repeatable", requests, errorRequest);
  (void)time, (void)error;
  app.add_option("--budget-minutes", minutes, "wall time for each budget, beside --minutes; 0: until nothing better is promised (4)")->type_name("M")->check(CLI::Range(0.0, 1e5));
}

std::string BudgetArguments::command() const {
  std::string text;
  for (const Request& r : requests) text += fmt::format(" {} {}", r.error ? "--target-error" : "--budget", r.text);
  return requests.empty() ? text : text + fmt::format(" --budget-minutes {:g}", minutes);
}

std::vector<burnish::BudgetOptions> BudgetArguments::options(const CostReport& cost, std::function<bool(double, std::string_view)> progress) const {
  std::vector<burnish::BudgetOptions> out;
  for (const Request& r : requests) {
    burnish::BudgetOptions& o = out.emplace_back();
    if (r.error) o.targetError = r.value;
    else o.ms = r.share ? r.value * cost.base.ms.median : r.value;
    o.minutes = minutes;
    o.progress = progress;
  }
  return out;
}

burnish::Result<void> writeQualities(const std::filesystem::path& folder, const BudgetArguments& arguments, const std::vector<BudgetResult>& results, const CostReport& cost) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const FrontPoint& best = results[i].best;
    const std::string comment = fmt::format("{} for {} at {}x{}, {}: {} of {} against {} ms of the base; error {} against {}, {:.3g} % of the base. {}", askedFor(arguments.requests[i], results[i]), cost.scene, cost.size.x,
                                            cost.size.y, cost.camera, timeOf(best), cost.clock, fmt::format("{:.3g}", cost.base.ms.median), errorOf(best), cost.against, 100 * cost.base.error.rms, cost.command);
    if (auto written = burnish::writeQuality(folder / arguments.requests[i].file(), best.quality, comment); !written) return written;
  }
  return {};
}

void printBudgets(const std::filesystem::path& folder, const BudgetArguments& arguments, const std::vector<BudgetResult>& results, const CostReport& cost) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    const BudgetResult& r = results[i];
    fmt::print("\nFor {}: {}\n", askedFor(arguments.requests[i], r), shown((folder / arguments.requests[i].file()).string()));
    if (!r.met) fmt::print("  NOT MET: nothing that was measured {}; this is the nearest\n", arguments.requests[i].error ? "misses so little" : "is so fast");
    fmt::print("  {}, error {} against {}; the base: {}, {}; {} combinations were rendered\n", timeOf(r.best), errorOf(r.best), cost.against, timeOf(cost.base), errorOf(cost.base), r.measured);
    if (r.best.settings.empty()) fmt::print("  the base quality itself\n");
    for (const std::string& setting : r.best.settings) fmt::print("  {:<34} {}\n", setting, aloneText(setting, cost));
    if (r.next) fmt::print("  {:.3g} ms more buy an error of {}: {}\n", r.next->ms.median - r.best.ms.median, errorOf(*r.next), fmt::join(differing(r.best, *r.next), ", "));
    else fmt::print("  nothing that was measured is more exact\n");
  }
}

}  // namespace cli
