#include <fmt/format.h>

#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

using Kind = FrontMark::Kind;

std::string settings(const CostReport& cost, const FrontPoint& p) { return escaped(settingsText(p, p.quality == cost.base.quality ? "the base quality" : "as the base quality")); }

std::string pointRow(const CostReport& cost, const FrontMark& m) {
  const FrontPoint& p = *m.point;
  const char* standing = p.dominated || m.kind == Kind::Dominated ? "dominated" : m.kind == Kind::Front ? "on the front" : "";
  std::string name = escaped(m.label.empty() ? (m.chosen.empty() ? standing : "") : m.label);
  if (!m.chosen.empty()) name += fmt::format(" <span class=\"mark chosen\">{}</span>", escaped(m.chosen));
  if ((!m.label.empty() || !m.chosen.empty()) && *standing) name += fmt::format(" <span class=\"mark\">{}</span>", standing);
  return fmt::format("<tr{}><th scope=\"row\">{}</th><td>{}</td><td>{}{}</td><td>{}</td><td>{}</td><td class=\"t\">{}</td></tr>\n", m.kind == Kind::Base ? " class=\"base\"" : p.dominated ? " class=\"lesser\"" : "", name,
                     spreadText(p.ms), percent(p.error.rms), p.error.rmsSpread > 0 ? " ± " + percent(p.error.rmsSpread, 2) : "", signedPercent(p.error.energy), number(p.error.perceptual), settings(cost, p));
}

std::string nextText(const BudgetResult& b) {
  if (!b.next) return b.met ? "Nothing that was measured is better at any price." : "";
  const double ms = b.next->ms.median - b.best.ms.median, error = b.best.error.rms - b.next->error.rms;
  std::string text = fmt::format("{} ms more buy {} less error", number(ms), percent(error));
  if (b.best.error.rms > 0) text += fmt::format(" ({} of it)", percent(error / b.best.error.rms));
  if (ms > 0 && error > 0) text += fmt::format(", at {} a millisecond", percent(error / ms));
  return text + ".";
}

}  // namespace

std::string pageFront(const PageInput& in) {
  const CostReport& c = in.cost;
  const std::vector<FrontMark> marks = frontMarks(c, in.budgets);
  std::string out = "<section id=\"front\">\n<h2>Time against error</h2>\n";
  out += fmt::format("<p>Each point is a whole quality, measured. The line joins those that no other one beats in both; {}bars are the spread of time and error. Point at one, or step through them with the tab key, to see its "
                     "settings.</p>\n",
                     in.budgets.empty() ? "" : "dashed lines are budgets, rings what was chosen for them; ");
  out += plotBox(frontPlot(c, in.budgets));
  std::string table = "<table><thead><tr><th scope=\"col\">quality</th><th scope=\"col\" class=\"n\">frame, ms (spread)</th><th scope=\"col\" class=\"n\">rms</th><th scope=\"col\" class=\"n\">energy</th><th scope=\"col\" "
                      "class=\"n\">Butteraugli</th><th scope=\"col\">differs from the base in</th></tr></thead><tbody>\n";
  for (const FrontMark& m : marks) table += pointRow(c, m);
  out += fmt::format("<details><summary>As a table: {} qualities</summary>{}</details>\n</section>\n", marks.size(), scrollBox("Qualities by time", table + "</tbody></table>"));
  return out;
}

std::string pageBudgets(const PageInput& in) {
  if (in.budgets.empty()) return "";
  std::string out = "<section id=\"budgets\">\n<h2>Budgets</h2>\n<div class=\"cards\">\n";
  for (const BudgetResult& b : in.budgets) {
    out += fmt::format("<article class=\"card\"><h3>{}{}</h3>\n", escaped(budgetName(b)), b.met ? "" : " <span class=\"mark warn\">not met: the nearest</span>");
    out += fmt::format("<p class=\"big\">{} ms <span class=\"soft\">at</span> {}</p>\n", measured(b.best.ms) ? number(b.best.ms.median, 4) : "n/a", measured(b.best.error) ? percent(b.best.error.rms) : "n/a");
    out += fmt::format("<p class=\"soft\">{} ms; {} combination{} measured</p>\n", spreadText(b.best.ms), b.measured, b.measured == 1 ? "" : "s");
    out += "<ul class=\"settings\">";
    for (const std::string& s : b.best.settings) out += fmt::format("<li><code>{}</code></li>", escaped(s));
    if (b.best.settings.empty()) out += "<li>as the base quality</li>";
    out += "</ul>\n<h4>The next milliseconds</h4>\n";
    out += fmt::format("<p>{}</p>\n", escaped(nextText(b)));
    if (b.next) {
      out += "<ul class=\"settings\">";
      for (const std::string& s : b.next->settings) out += fmt::format("<li><code>{}</code></li>", escaped(s));
      if (b.next->settings.empty()) out += "<li>the base quality</li>";
      out += "</ul>\n";
    }
    out += "</article>\n";
  }
  return out + "</div>\n</section>\n";
}

}  // namespace burnish::cost
