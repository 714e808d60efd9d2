#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

const RungCost* inForce(const TermCost& t) {
  const auto found = std::find_if(t.rungs.begin(), t.rungs.end(), [](const RungCost& r) { return r.inForce; });
  return found == t.rungs.end() ? nullptr : &*found;
}
const RungCost* exactOf(const TermCost& t) {
  const auto found = std::find_if(t.rungs.begin(), t.rungs.end(), [&](const RungCost& r) { return r.name == t.exactRung; });
  return found == t.rungs.end() ? nullptr : &*found;
}

std::string closingCost(const RungCost* base, const RungCost* exact) {
  if (!base || !exact || base == exact) return base && base == exact ? "is exact" : "n/a";
  const bool pass = measured(base->passMs) && measured(exact->passMs);
  const Spread &b = pass ? base->passMs : base->frameMs, &e = pass ? exact->passMs : exact->frameMs;
  if (!measured(b) || !measured(e)) return "n/a";
  const double ms = e.median - b.median;
  return fmt::format("{}{} ms", ms > 0 ? "+" : "", number(ms));
}

/// Each term in a line: what is in force, and what exactness would cost.
std::string overview(const PageInput& in, bool choices) {
  std::string table = fmt::format("<table><thead><tr><th scope=\"col\">{}</th><th scope=\"col\">in force</th><th scope=\"col\" class=\"n\">its error against exact</th><th scope=\"col\" class=\"n\">exact costs</th><th "
                                  "scope=\"col\">exact</th><th scope=\"col\">called for by</th></tr></thead><tbody>\n",
                                  choices ? "choice" : "term");
  for (std::size_t i = 0; i < in.cost.terms.size(); ++i) {
    const TermCost& t = in.cost.terms[i];
    if (t.choice != choices) continue;
    const RungCost *base = inForce(t), *exact = exactOf(t);
    table += fmt::format("<tr><th scope=\"row\"><a href=\"#{}-section\">{}</a></th><td class=\"t\">{}{}</td><td>{}</td><td>{}</td><td class=\"t\">{}</td><td class=\"t soft\">{}</td></tr>\n", in.ladders[i].name, escaped(t.name),
                         base ? escaped(base->name) : "n/a", base && base->dominated ? " <span class=\"mark\">dominated</span>" : "", base && measured(base->exact) ? percent(base->exact.rms) : "n/a",
                         closingCost(base, exact), escaped(t.exactRung), escaped(t.calledBy));
  }
  return scrollBox(choices ? "Choices" : "Terms", table + "</tbody></table>");
}

std::string termSection(const PageInput& in, std::size_t i) {
  const TermCost& t = in.cost.terms[i];
  std::string out = fmt::format("<article class=\"term\" id=\"{}-section\">\n<h3>{} <span class=\"what\">{}</span></h3>\n", in.ladders[i].name, escaped(t.name), escaped(t.what));
  if (!t.calledBy.empty()) out += fmt::format("<p class=\"soft\">Called for by {}.</p>\n", escaped(t.calledBy));
  out += plotBox(in.ladders[i]);
  out += fmt::format("<details><summary>All figures of {}</summary>{}</details>\n", escaped(t.name), scrollBox("Figures of " + t.name, rungTable(in, t)));
  const bool any = std::any_of(t.rungs.begin(), t.rungs.end(), [&](const RungCost& r) { return in.pictures.has(r.picture); });
  if (any) out += fmt::format("<details class=\"pictures\"><summary>Pictures of {}</summary>{}</details>\n", escaped(t.name), rungPictures(in, t));
  return out + "</article>\n";
}

}  // namespace

std::string pageTerms(const PageInput& in, bool choices) {
  const std::string id = choices ? "choices" : "terms";
  std::string out = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n", id, choices ? "Choices: sizes, formats, layouts" : "Terms, rung by rung");
  if (std::none_of(in.cost.terms.begin(), in.cost.terms.end(), [&](const TermCost& t) { return t.choice == choices; })) return out + "<p class=\"soft\">None was measured.</p>\n</section>\n";
  out += fmt::format("<p>{} A rung is dominated where another one is no slower and no less exact, and better in one by more than the spread.</p>\n",
                     choices ? "What is no term of the lighting equation, measured the same way: errors count against the finest setting."
                             : "Every rung of each term that the scene calls for, the rest held as in the base quality and as in the preset exact; errors count against the term's exact rung.");
  out += overview(in, choices);
  out += "<p class=\"tools\"><button type=\"button\" class=\"openall\" hidden>Open all pictures and tables</button></p>\n";
  for (std::size_t i = 0; i < in.cost.terms.size(); ++i)
    if (in.cost.terms[i].choice == choices) out += termSection(in, i);
  return out + "</section>\n";
}

}  // namespace burnish::cost
