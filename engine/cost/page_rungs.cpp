#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

std::string ofError(const PictureError& e, const std::string& text) { return measured(e) ? text : "n/a"; }

std::string withSpread(const PictureError& e) { return ofError(e, percent(e.rms) + (e.rmsSpread > 0 ? " ± " + percent(e.rmsSpread, 2) : "")); }

/// "12.34" over the spread in small: the column stays narrow.
std::string timeCell(const Spread& s) {
  if (!measured(s)) return "n/a";
  return s.count > 1 ? fmt::format("{}<br><span class=\"range\">{}–{}</span>", number(s.median, 4), number(s.low, 4), number(s.high, 4)) : number(s.median, 4);
}

std::string marks(const TermCost& t, const RungCost& r) {
  std::string out;
  if (r.inForce) out += " <span class=\"mark base\">base</span>";
  if (r.name == t.exactRung) out += " <span class=\"mark exact\">exact</span>";
  if (r.dominated) out += " <span class=\"mark\">dominated</span>";
  return out;
}

/// Columns that no rung of the term has are left out.
struct Columns {
  bool pass, frame, exactPass, exactRest, truth;
  explicit Columns(const TermCost& t) {
    const auto any = [&](const auto& is) { return std::any_of(t.rungs.begin(), t.rungs.end(), is); };
    pass = any([](const RungCost& r) { return measured(r.passMs); });
    frame = any([](const RungCost& r) { return measured(r.frameMs); });
    exactPass = any([](const RungCost& r) { return measured(r.exactPassMs); });
    exactRest = any([](const RungCost& r) { return measured(r.exactRest); });
    truth = any([](const RungCost& r) { return measured(r.truth); });
  }
  [[nodiscard]] int count() const { return 6 + pass + frame + exactPass + 2 * exactRest + 3 * truth; }
};

std::string head(const Columns& c) {
  const int times = c.pass + c.frame + c.exactPass;
  std::string groups = "<tr><td></td>", names = "<tr><th scope=\"col\">rung</th>";
  const auto column = [&](bool is, std::string_view name) {
    if (is) names += fmt::format("<th scope=\"col\" class=\"n\">{}</th>", name);
  };
  if (times > 0) groups += fmt::format("<th scope=\"colgroup\" colspan=\"{}\">time, ms</th>", times);
  column(c.pass, "passes"), column(c.frame, "frame"), column(c.exactPass, "passes, rest exact");
  groups += fmt::format("<th scope=\"colgroup\" colspan=\"{}\">error against exact</th>", c.exactRest ? 7 : 5);
  column(true, "rms"), column(true, "PSNR, dB"), column(true, "Butter&shy;augli"), column(true, "99.9 %"), column(true, "energy");
  column(c.exactRest, "rms, rest exact"), column(c.exactRest, "energy, rest exact");
  if (c.truth) groups += "<th scope=\"colgroup\" colspan=\"3\">against ground truth</th>";
  column(c.truth, "rms"), column(c.truth, "Butter&shy;augli"), column(c.truth, "energy");
  return "<thead>" + groups + "</tr>" + names + "</tr></thead>";
}

}  // namespace

std::string rungTable(const PageInput&, const TermCost& term) {
  const Columns c(term);
  std::string out = "<table class=\"rungs\">" + head(c) + "<tbody>\n";
  for (const RungCost& r : term.rungs) {
    out += fmt::format("<tr{}><th scope=\"row\">{}{}</th>", r.inForce ? " class=\"base\"" : r.dominated ? " class=\"lesser\"" : "", escaped(r.name), marks(term, r));
    const auto cell = [&](bool is, const std::string& text) {
      if (is) out += "<td>" + text + "</td>";
    };
    cell(c.pass, timeCell(r.passMs)), cell(c.frame, timeCell(r.frameMs)), cell(c.exactPass, timeCell(r.exactPassMs));
    const PictureError& e = r.exact;
    cell(true, withSpread(e)), cell(true, ofError(e, number(e.psnr))), cell(true, ofError(e, number(e.perceptual))), cell(true, ofError(e, percent(e.p999))), cell(true, ofError(e, signedPercent(e.energy)));
    cell(c.exactRest, withSpread(r.exactRest)), cell(c.exactRest, ofError(r.exactRest, signedPercent(r.exactRest.energy)));
    cell(c.truth, withSpread(r.truth)), cell(c.truth, ofError(r.truth, number(r.truth.perceptual))), cell(c.truth, ofError(r.truth, signedPercent(r.truth.energy)));
    out += "</tr>\n";
    if (!r.note.empty()) out += fmt::format("<tr class=\"note\"><td colspan=\"{}\">{}: {}</td></tr>\n", c.count(), escaped(r.name), escaped(r.note));
  }
  return out + "</tbody></table>";
}

std::string rungPictures(const PageInput& in, const TermCost& term) {
  std::string out = colourBar(in);
  const std::string exactName = "exact: " + term.exactRung;
  for (const RungCost& r : term.rungs) {
    if (!in.pictures.has(r.picture)) continue;
    const std::string figures = measured(r.exact) ? fmt::format("rms {}, energy {}", percent(r.exact.rms), signedPercent(r.exact.energy)) : "";
    out += fmt::format("<div class=\"triptych\"><h4>{}{} <span class=\"soft\">{}</span></h4>\n", escaped(r.name), marks(term, r), figures);
    if (r.name == term.exactRung) {
      out += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n</div>\n", in.pictures.show(r.picture, r.name), escaped(r.name));
      continue;
    }
    out += fmt::format("<figure>{}<figcaption>{} (click to flip)</figcaption></figure>\n", flipBox(in, r.picture, r.name, term.exactPicture, exactName), escaped(r.name));
    out += fmt::format("<figure class=\"middle\">{}<figcaption>{}</figcaption></figure>\n", in.pictures.show(term.exactPicture, exactName), escaped(exactName));
    out += fmt::format("<figure>{}<figcaption>difference</figcaption></figure>\n</div>\n", in.pictures.show(r.difference, "difference of " + r.name + " and exact"));
  }
  return out;
}

}  // namespace burnish::cost
