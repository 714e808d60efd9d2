#include "cost/csv.h"

#include <fmt/format.h>

#include <cmath>

#include "cost/page_text.h"

namespace burnish::cost {
namespace {

constexpr std::string_view kErrors[] = {"exact", "exact_rest", "truth"};

std::string cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string cells(const Spread& s) {
  if (!measured(s)) return ",,,,";
  return fmt::format(",{},{},{},{}", cell(s.median), cell(s.low), cell(s.high), s.count);
}

std::string cells(const PictureError& e) {
  if (!measured(e)) return ",,,,,,,";
  return fmt::format(",{},{},{},{},{},{},{}", cell(e.rms), cell(e.rmsSpread), cell(e.psnr), cell(e.perceptual), cell(e.p999), cell(e.energy), e.skipped);
}

}  // namespace

std::string csvCell(std::string_view text) {
  std::string clean = cleanText(text);
  if (const std::size_t first = clean.find_first_not_of(' '); first != std::string::npos && std::string_view("=+-@|%").find(clean[first]) != std::string_view::npos) clean = fmt::format("'{}", clean);
  if (clean.find_first_of(",\"") == std::string::npos && (clean.empty() || (clean.front() != ' ' && clean.back() != ' '))) return clean;
  std::string out = "\"";
  for (const char c : clean) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string costCsv(const CostReport& cost) {
  std::string out = "term,kind,rung,in_force,exact_rung,dominated";
  for (const std::string_view time : {"pass", "frame", "pass_exact_rest"}) out += fmt::format(",{0}_median_ms,{0}_low_ms,{0}_high_ms,{0}_count", time);
  for (const std::string_view against : kErrors)
    out += fmt::format(",{0}_rms,{0}_rms_spread,{0}_psnr_db,{0}_butteraugli,{0}_p999,{0}_energy,{0}_skipped_pixels", against);
  out += ",note\r\n";
  for (const TermCost& term : cost.terms)
    for (const RungCost& rung : term.rungs) {
      out += fmt::format("{},{},{},{},{},{}", csvCell(term.name), term.choice ? "choice" : "term", csvCell(rung.name), rung.inForce ? 1 : 0, rung.name == term.exactRung ? 1 : 0, rung.dominated ? 1 : 0);
      out += cells(rung.passMs) + cells(rung.frameMs) + cells(rung.exactPassMs);
      out += cells(rung.exact) + cells(rung.exactRest) + cells(rung.truth);
      out += fmt::format(",{}\r\n", csvCell(rung.note));
    }
  return out;
}

}  // namespace burnish::cost
