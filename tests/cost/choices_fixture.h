// What the tests of choices share: a bench on a scene, and the choices of it.
#pragma once
#include <fmt/format.h>

#include <iostream>

#include "cost/choices.h"
#include "cost/choices_rows.h"
#include "render/transparent.h"

namespace burnish::test {

struct ChoiceStage {
  std::unique_ptr<Context> context = openContext();
  Scene scene;
  View view;
  CostOptions options;
  Report report;
  std::unique_ptr<cost::Bench> bench;

  ~ChoiceStage() {
    if (context->makeCurrent()) bench.reset();
  }
  void start() {
    auto made = cost::Bench::create(context->procAddress(), scene, view, options.size, options.base, report);
    if (!made) FAIL(made.error().message());
    bench = std::move(*made);
  }
  cost::Choices choices(std::vector<std::string> only, double minutes = 0) {
    options.terms = std::move(only);
    if (!bench) start();
    const auto base = bench->picture(options.base);
    REQUIRE(base);
    const cost::Against against{*base, nullptr, bench->developed(**base)};
    cost::Clock clock(minutes, {});
    const ProcAddress address = context->procAddress();
    auto made = cost::measureChoices({address, *bench, against, options, clock});
    if (!made) FAIL(made.error().message());
    return std::move(*made);
  }
};

inline const RungCost& rungNamed(const TermCost& cost, std::string_view name) {
  const auto found = std::find_if(cost.rungs.begin(), cost.rungs.end(), [&](const RungCost& r) { return r.name == name; });
  if (found == cost.rungs.end()) FAIL("no setting '" << name << "' of " << cost.name);
  return *found;
}

inline void print(const TermCost& cost) {
  std::cout << fmt::format("  {} ({}), exact {}\n", cost.name, cost.calledBy, cost.exactRung);
  for (const RungCost& r : cost.rungs)
    std::cout << fmt::format("    {:<22} rms {:.2e}, energy {:+.2e}, pass {:.3f} ms, frame {:.3f} ms{}{}  {}\n", r.name, r.exact.rms, r.exact.energy, r.passMs.median, r.frameMs.median, r.inForce ? ", in force" : "",
                             r.dominated ? ", dominated" : "", r.note);
}

}  // namespace burnish::test
