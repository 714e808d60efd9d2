#include <fmt/format.h>

#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

struct Metric {
  const char* name;
  std::string hint;
  std::string base, exact;
};

std::string decibels(double v) { return std::isfinite(v) ? number(v) + " dB" : number(v); }

std::string plusMinus(const PictureError& e) { return e.rmsSpread > 0 && std::isfinite(e.rmsSpread) ? "± " + percent(e.rmsSpread, 2) : "of the linear difference"; }

std::string tiles(const CostReport& c) {
  const PictureError &b = c.base.error, &x = c.exact.error;
  const bool base = measured(b), exact = measured(x);
  const auto of = [](bool is, const std::string& text) { return is ? text : std::string("n/a"); };
  const Metric metrics[] = {
      {"relative rms", of(base, plusMinus(b)), of(base, percent(b.rms)), of(exact, percent(x.rms))},
      {"energy", b.energy > 0 ? "too bright in all" : "too dark in all", of(base, signedPercent(b.energy)), of(exact, signedPercent(x.energy))},
      {"PSNR", "as developed; more is better", of(base, decibels(b.psnr)), of(exact, decibels(x.psnr))},
      {"Butteraugli", "1 is just seen", of(base, number(b.perceptual)), of(exact, number(x.perceptual))},
      {"99.9th percentile", "of relative differences", of(base, percent(b.p999)), of(exact, percent(x.p999))},
      {"frame", c.clock.c_str(), measured(c.base.ms) ? number(c.base.ms.median, 4) + " ms" : "n/a", measured(c.exact.ms) ? number(c.exact.ms.median, 4) + " ms" : "n/a"},
  };
  std::string out = "<ul class=\"tiles\">\n";
  for (const Metric& m : metrics)
    out += fmt::format("<li><span class=\"name\">{}</span><span class=\"value\">{}</span><span class=\"hint\">{}</span><span class=\"other\">preset exact: {}</span></li>\n", m.name, m.base, escaped(m.hint), m.exact);
  return out + "</ul>\n";
}

std::string figure(const std::string& picture, std::string_view caption) { return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", picture, escaped(caption)); }

std::string pictures(const PageInput& in) {
  const CostReport& c = in.cost;
  const std::string name = baseName(c);
  std::string out = "<div class=\"triptych large\">\n";
  const bool truth = in.pictures.has(c.truthPicture);
  const Image& other = truth ? c.truthPicture : c.exactPicture;
  const std::string_view otherName = truth ? "ground truth" : "preset exact";
  if (!in.pictures.has(c.basePicture) && !in.pictures.has(other)) return "";
  out += figure(flipBox(in, c.basePicture, name, other, otherName), name + " quality (click to flip)");
  out += figure(in.pictures.show(other, otherName), otherName);
  if (in.pictures.has(c.baseDifference)) out += figure(in.pictures.show(c.baseDifference, "difference of the two"), "difference");
  out += "</div>\n";
  if (truth && in.pictures.has(c.exactPicture)) {
    out += "<details><summary>The preset exact against ground truth</summary><div class=\"triptych large\">\n";
    out += figure(flipBox(in, c.exactPicture, "preset exact", c.truthPicture, "ground truth"), "preset exact (click to flip)") + figure(in.pictures.show(c.truthPicture, "ground truth"), "ground truth");
    if (in.pictures.has(c.exactDifference)) out += figure(in.pictures.show(c.exactDifference, "difference of the two"), "difference: what no rung takes away");
    out += "</div></details>\n";
  }
  if (in.pictures.has(c.baseDifference)) out += colourBar(in);
  return out;
}

std::string contributors(const PageInput& in) {
  const CostReport& c = in.cost;
  if (c.contributors.empty()) return "";
  std::string out = fmt::format("<h3 id=\"next\">What to improve next</h3>\n<p>What closing each gap alone would take off the rms of {}. Errors of several terms overlap, so these do not add up.</p>\n", percent(c.base.error.rms));
  out += plotBox(contributorsPlot(c));
  std::string table = "<table><thead><tr><th scope=\"col\">gap</th><th scope=\"col\" class=\"n\">rms</th><th scope=\"col\" class=\"n\">share of the error</th></tr></thead><tbody>\n";
  for (const auto& [name, gain] : c.contributors)
    table += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>\n", escaped(name), signedPercent(-gain), c.base.error.rms > 0 ? percent(gain / c.base.error.rms) : "n/a");
  return out + "<details><summary>As a table</summary>" + scrollBox("What to improve next", table + "</tbody></table>") + "</details>\n";
}

}  // namespace

std::string pageBase(const PageInput& in) {
  const CostReport& c = in.cost;
  std::string out = fmt::format("<section id=\"base\">\n<h2>The {} quality against {}</h2>\n", escaped(baseName(c)), c.against.empty() || c.against == "exact" ? "the preset exact" : escaped(c.against));
  if (!hasTruth(c)) out += "<p>There is no path-traced picture in this report: errors count against the engine's own preset exact.</p>\n";
  return out + tiles(c) + pictures(in) + contributors(in) + "</section>\n";
}

}  // namespace burnish::cost
