// write_page FOLDER: writes made-up reports into FOLDER/full, FOLDER/hostile and FOLDER/empty, for check_page.py to open.
#include <cstdio>
#include <filesystem>

#include "cost/page_fixture.h"

int main(int count, char** words) {
  if (count != 2) return std::fprintf(stderr, "usage: write_page FOLDER\n"), 2;
  const burnish::test::MadeReport reports[] = {burnish::test::fullReport(), burnish::test::hostileReport(), {}};
  const char* names[] = {"full", "hostile", "empty"};
  for (int i = 0; i < 3; ++i) {
    burnish::Report report;
    const auto written = burnish::writeCostReport(std::filesystem::path(words[1]) / names[i], reports[i].cost, reports[i].budgets, report);
    for (const burnish::Warning& w : report.warnings()) std::fprintf(stderr, "%s: warning: %s\n", names[i], w.message().c_str());
    if (!written) return std::fprintf(stderr, "%s: %s\n", names[i], written.error().message().c_str()), 1;
  }
  return 0;
}
