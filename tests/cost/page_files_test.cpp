// The files of a cost report: complete or absent, one clear error, and plots without the program that draws PNG.
#include <burnish/measure.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "cost/page_fixture.h"
#include "cost/plots.h"
#include "cost/plots_png.h"

using namespace burnish;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "burnish-page-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
};

/// A variable of the environment, put back at the end.
struct Variable {
  std::string name, old;
  Variable(const char* n, const std::string& value) : name(n), old(std::getenv(n) ? std::getenv(n) : "") { ::setenv(n, value.c_str(), 1); }
  ~Variable() { ::setenv(name.c_str(), old.c_str(), 1); }
};

void script(const fs::path& file, const std::string& text) {
  std::ofstream(file) << "#!/bin/sh\n" << text << "\n";
  ::chmod(file.c_str(), 0755);
}

std::size_t filesIn(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder, error) ? static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator())) : 0;
}

}  // namespace

TEST_CASE("Page: without the program for PNG there is one warning, and the rest", "[page]") {
  const test::MadeReport made = test::fullReport();
  Folder folder, empty;
  const Variable path("PATH", empty.path.string());
  Report report;
  REQUIRE(writeCostReport(folder.path / "deep" / "cost", made.cost, made.budgets, report));
  REQUIRE(report.warnings().size() == 1);
  CHECK(report.warnings()[0].message().find("librsvg2-bin") != std::string::npos);
  const fs::path plots = folder.path / "deep" / "cost" / "plots";
  CHECK(fs::exists(plots / "front.svg"));
  CHECK_FALSE(fs::exists(plots / "front.png"));
  CHECK(fs::file_size(folder.path / "deep" / "cost" / "index.html") > 100'000);
}

TEST_CASE("Page: a program for PNG that fails, lies or hangs costs no more than its time", "[page]") {
  const test::MadeReport made = test::fullReport();
  const std::string svg = cost::contributorsPlot(made.cost).drawing.file("t", "d");
  Folder folder;
  const auto with = [&](const std::string& text, double seconds) {
    script(folder.path / "draw", text);
    return cost::rasterized(svg, (folder.path / "draw").string(), seconds);
  };
  CHECK_FALSE(with("cat >/dev/null; exit 3", 10));
  CHECK_FALSE(with("cat", 10));  // not a PNG
  CHECK_FALSE(with("true", 10));
  const auto begin = std::chrono::steady_clock::now();
  const auto hung = with("sleep 60 & sleep 60", 0.3);
  REQUIRE_FALSE(hung);
  CHECK(hung.error().what.find("longer") != std::string::npos);
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));
  CHECK_FALSE(cost::rasterized(svg, (folder.path / "absent").string()));
  // What it is given is the drawing, and what it writes is what we get.
  script(folder.path / "copy", "cat >" + (folder.path / "given.svg").string() + "; printf '\\211PNG\\r\\n\\032\\nrest'");
  const auto bytes = cost::rasterized(svg, (folder.path / "copy").string());
  REQUIRE(bytes);
  CHECK(bytes->size() == 12);
  std::ifstream given(folder.path / "given.svg");
  CHECK(std::string(std::istreambuf_iterator<char>(given), {}) == svg);
}

TEST_CASE("Page: a folder that takes no files is one clear error", "[page]") {
  const test::MadeReport made = test::fullReport();
  Folder folder;
  Report report;
  std::ofstream(folder.path / "file") << "x";
  for (const fs::path& place : {folder.path / "file", folder.path / "file" / "below", fs::path("/proc/burnish-cost")}) {
    const auto written = writeCostReport(place, made.cost, made.budgets, report);
    REQUIRE_FALSE(written);
    CHECK(written.error().place.find(place.filename().string()) != std::string::npos);
    CHECK_FALSE(written.error().remedy.empty());
  }
  // Something that is not ours lies where the plots go: it stays.
  fs::create_directories(folder.path / "taken" / "plots");
  std::ofstream(folder.path / "taken" / "plots" / "thesis.txt") << "mine";
  CHECK_FALSE(writeCostReport(folder.path / "taken", made.cost, made.budgets, report));
  CHECK(fs::file_size(folder.path / "taken" / "plots" / "thesis.txt") == 4);
  CHECK(filesIn(folder.path / "taken") == 2);
}

TEST_CASE("Page: a disk that is full leaves the old files whole", "[page]") {
  const test::MadeReport made = test::fullReport();
  Folder folder, empty;
  const Variable path("PATH", empty.path.string());
  Report report;
  REQUIRE(writeCostReport(folder.path, made.cost, made.budgets, report));
  const auto page = fs::file_size(folder.path / "index.html");
  const std::size_t count = filesIn(folder.path);
  rlimit old{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
  const rlimit small{200'000, old.rlim_max};  // plots and tables fit, the page does not
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  const auto written = writeCostReport(folder.path, made.cost, made.budgets, report);
  ::setrlimit(RLIMIT_FSIZE, &old);
  REQUIRE_FALSE(written);
  CHECK(written.error().place.find("index.html") != std::string::npos);
  CHECK(fs::file_size(folder.path / "index.html") == page);
  CHECK(filesIn(folder.path) == count);
}

TEST_CASE("Page: plots of an earlier report go", "[page]") {
  test::MadeReport made = test::fullReport();
  Folder folder, empty;
  const Variable path("PATH", empty.path.string());
  Report report;
  REQUIRE(writeCostReport(folder.path, made.cost, made.budgets, report));
  CHECK(fs::exists(folder.path / "plots" / "ladder-lobe.svg"));
  made.cost.terms.clear();
  REQUIRE(writeCostReport(folder.path, made.cost, {}, report));
  CHECK_FALSE(fs::exists(folder.path / "plots" / "ladder-lobe.svg"));
  CHECK(filesIn(folder.path) == 6);  // three files, the folder, two plots
}

TEST_CASE("Page: the same report gives the same bytes", "[page]") {
  const test::MadeReport made = test::fullReport();
  Folder a, b, empty;
  const Variable path("PATH", empty.path.string());
  Report report;
  REQUIRE(writeCostReport(a.path, made.cost, made.budgets, report));
  REQUIRE(writeCostReport(b.path, made.cost, made.budgets, report));
  for (const char* name : {"index.html", "cost.json", "cost.csv", "plots/front.svg"}) {
    std::ifstream one(a.path / name, std::ios::binary), two(b.path / name, std::ios::binary);
    CHECK(std::string(std::istreambuf_iterator<char>(one), {}) == std::string(std::istreambuf_iterator<char>(two), {}));
  }
}

TEST_CASE("Page: points of the front are each there once, by time, with their names", "[page]") {
  const test::MadeReport made = test::fullReport();
  const auto marks = cost::frontMarks(made.cost, made.budgets);
  CHECK(std::is_sorted(marks.begin(), marks.end(), [](const auto& x, const auto& y) { return x.point->ms.median < y.point->ms.median; }));
  int base = 0, chosen = 0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) CHECK_FALSE(marks[i].point->quality == marks[j].point->quality);
    base += marks[i].label == "default (base)", chosen += !marks[i].chosen.empty();
  }
  CHECK(base == 1);
  CHECK(chosen == 3);
  // What has no time or no error is no point.
  const auto hostile = test::hostileReport();
  for (const auto& m : cost::frontMarks(hostile.cost, hostile.budgets)) CHECK(std::isfinite(m.point->ms.median + m.point->error.rms));
}

TEST_CASE("Page: no name on the front is struck through, by the spread of a time or by the front itself", "[page]") {
  test::MadeReport made = test::fullReport();
  const auto widen = [](FrontPoint& p) { p.ms.low = p.ms.median * 0.5, p.ms.high = p.ms.median * 1.8, p.ms.count = 7; };
  widen(made.cost.base), widen(made.cost.exact);
  for (FrontPoint& p : made.cost.front) widen(p);
  const std::string text = cost::frontPlot(made.cost, made.budgets).drawing.file("front", "");
  struct Line {
    double left, right, y, bottom;
  };
  std::vector<Line> lines;
  const std::regex line(R"re(<line x1="([0-9.]+)" y1="([0-9.]+)" x2="([0-9.]+)" y2="([0-9.]+)" class="spread"/>)re");
  for (std::sregex_iterator m(text.begin(), text.end(), line), end; m != end; ++m)
    if ((*m)[2] == (*m)[4]) lines.push_back({std::stod((*m)[1]), std::stod((*m)[3]), std::stod((*m)[2]), std::stod((*m)[2])});
  REQUIRE(lines.size() >= 2);
  std::smatch front;
  REQUIRE(std::regex_search(text, front, std::regex(R"re(<polyline points="([^"]+)" class="front"/>)re")));
  std::istringstream corners(front[1].str());
  std::vector<double> at;
  for (double x = 0, y = 0; corners >> x && corners.ignore() && corners >> y;) at.push_back(x), at.push_back(y);
  REQUIRE(at.size() >= 6);
  for (std::size_t i = 0; i + 3 < at.size(); i += 2) lines.push_back({std::min(at[i], at[i + 2]), std::max(at[i], at[i + 2]), std::min(at[i + 1], at[i + 3]), std::max(at[i + 1], at[i + 3])});
  const std::regex name(R"re(<text x="([0-9.]+)" y="([0-9.]+)"( text-anchor="middle")? class="strong">([^<]+)</text>)re");
  int names = 0;
  for (std::sregex_iterator m(text.begin(), text.end(), name), end; m != end; ++m, ++names) {
    const double width = cost::textWidth((*m)[4].str(), 12), x = std::stod((*m)[1]) - ((*m)[3].matched ? width / 2 : 0), y = std::stod((*m)[2]);
    INFO((*m)[4] << " at " << x << ", " << y);
    // From the top of its capitals to its base line.
    for (const Line& l : lines) CHECK((l.bottom < y - 10 || l.y > y || l.right < x || l.left > x + width));
  }
  CHECK(names >= 2);
}
