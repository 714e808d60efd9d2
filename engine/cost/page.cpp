#include "cost/page.h"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <system_error>

#include "core/file.h"
#include "cost/csv.h"
#include "cost/json.h"
#include "cost/page_text.h"
#include "cost/plots_png.h"

namespace burnish {
namespace cost {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kPictureBytes = 13'500'000;  // as base64: with text and plots the page stays under 15 MB

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

/// White of the difference pictures where the report has none: their largest value.
double whiteOf(const CostReport& cost) {
  if (std::isfinite(cost.differenceScale) && cost.differenceScale > 0) return cost.differenceScale;
  double most = 0;
  const auto look = [&](const Image& i) {
    if (i.type == PixelType::F32 && i.channels == 1 && i.data.size() == i.byteSize())
      for (std::size_t p = 0; p < i.pixelCount(); ++p)
        if (std::isfinite(i.f32()[p])) most = std::max(most, static_cast<double>(i.f32()[p]));
  };
  look(cost.baseDifference);
  for (const TermCost& t : cost.terms)
    for (const RungCost& r : t.rungs) look(r.difference);
  return most > 0 ? most : 1;
}

void wantPictures(const CostReport& cost, PagePictures& pictures) {
  for (const Image* i : {&cost.basePicture, &cost.truthPicture, &cost.exactPicture, &cost.baseDifference, &cost.exactDifference}) pictures.want(*i, true);
  for (const TermCost& t : cost.terms) {
    pictures.want(t.exactPicture, false);
    for (const RungCost& r : t.rungs) pictures.want(r.picture, false), pictures.want(r.difference, false);
  }
}

core::NamedBytes named(const std::string& name, std::span<const std::byte> bytes) { return {name, {bytes.begin(), bytes.end()}}; }

/// SVG of every plot, and PNG as far as the program for it works.
std::vector<core::NamedBytes> plotFiles(const std::vector<const Plot*>& plots, Report& report) {
  std::vector<core::NamedBytes> files;
  bool drawing = true;
  for (const Plot* plot : plots) {
    const std::string svg = plot->drawing.file(plot->title, plot->about);
    files.push_back(named(plot->name + ".svg", bytesOf(svg)));
    if (!drawing) continue;
    auto png = rasterized(svg);
    if (png) {
      files.push_back({plot->name + ".png", std::move(*png)});
    } else {
      report.warn("plots", "not all plots are there as PNG: " + png.error().message());
      drawing = false;
    }
  }
  return files;
}

Result<void> makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return {};
  return fail(folder.string(), fmt::format("the folder cannot be made ({})", error ? error.message() : "there is a file of this name"), "choose a folder that can be written to");
}

}  // namespace

std::string costPage(const CostReport& cost, const std::vector<BudgetResult>& budgets, const std::vector<Plot>& ladders, Report& report) {
  PagePictures pictures(whiteOf(cost));
  wantPictures(cost, pictures);
  pictures.encode(kPictureBytes, report);
  const PageInput in{cost, budgets, ladders, pictures};
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  // Whatever a text tries: nothing is fetched and nothing is sent.
  out += "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'\">\n";
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"Burnish\">\n";
  out += fmt::format("<title>{}: what accuracy costs</title>\n<style>\n{}</style>\n</head>\n<body>\n", escaped(cost.scene.empty() ? "scene" : cost.scene), pageStyle());
  out += pageHead(in) + "<main id=\"main\">\n" + pageBase(in) + pageFront(in) + pageBudgets(in) + pageTerms(in, false) + pageTerms(in, true) + pageTail(in) + "</main>\n";
  out += pictures.definitions();
  out += fmt::format("<script>\n{}</script>\n</body>\n</html>\n", pageScript());
  return out;
}

}  // namespace cost

Result<void> writeCostReport(const std::filesystem::path& folder, const CostReport& cost, const std::vector<BudgetResult>& budgets, Report& report) {
  std::vector<cost::Plot> ladders;
  const std::vector<std::string> names = cost::ladderNames(cost);
  for (std::size_t i = 0; i < cost.terms.size(); ++i) ladders.push_back(cost::ladderPlot(cost, cost.terms[i], names[i]));
  const cost::Plot front = cost::frontPlot(cost, budgets), contributors = cost::contributorsPlot(cost);
  std::vector<const cost::Plot*> plots{&front, &contributors};
  for (const cost::Plot& ladder : ladders) plots.push_back(&ladder);

  if (auto good = cost::makeFolder(folder); !good) return good;
  const std::vector<core::NamedBytes> files = cost::plotFiles(plots, report);
  // Plots of an earlier report go with their folder; a folder with anything else is not ours.
  const auto ours = [](std::string_view name) { return name.ends_with(".svg") || name.ends_with(".png"); };
  if (auto good = core::replaceFolder(folder / "plots", files, ours); !good) return good;
  if (auto good = core::writeFileAtomic(folder / "cost.csv", cost::bytesOf(cost::costCsv(cost))); !good) return good;
  if (auto good = core::writeFileAtomic(folder / "cost.json", cost::bytesOf(cost::costJson(cost, budgets))); !good) return good;
  return core::writeFileAtomic(folder / "index.html", cost::bytesOf(cost::costPage(cost, budgets, ladders, report)));
}

}  // namespace burnish
