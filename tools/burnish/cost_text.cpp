#include "cost_text.h"

#include <fmt/format.h>

#include <cmath>

#include "messages.h"

namespace cli {
namespace {

using burnish::CostReport;
using burnish::FrontPoint;
using burnish::PictureError;
using burnish::RungCost;
using burnish::Spread;
using burnish::TermCost;

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:.2f}", 100 * share) : "-"; }
std::string ms(const Spread& s) { return s.count > 0 ? fmt::format("{:.2f}", s.median) : "-"; }
std::string range(const Spread& s) { return s.count > 0 ? fmt::format("{:.2f}..{:.2f}", s.low, s.high) : "-"; }
std::string decibels(double psnr) { return std::isfinite(psnr) ? fmt::format("{:.1f}", psnr) : "equal"; }

void printRung(const RungCost& r, bool truth) {
  fmt::print("  {}{:<22} {:>9} {:>9} {:>16} {:>8} {:>8} {:>8} {:>7} {:>6.2f} {:>8} {:>8}{}{}\n", r.inForce ? '*' : ' ', shown(r.name), ms(r.passMs), ms(r.frameMs), range(r.frameMs), percent(r.exact.rms),
             r.exactRestKnown ? percent(r.exactRest.rms) : "-", truth ? percent(r.truth.rms) : "-", decibels(r.exact.psnr), r.exact.perceptual, percent(r.exact.p999), fmt::format("{:+.2f}", 100 * r.exact.energy),
             r.dominated ? "  dominated" : "", r.note.empty() ? "" : "  (" + shown(r.note) + ")");
}

void printTerm(const TermCost& term, bool truth) {
  fmt::print("\n{}: {}\n  {}{}\n", shown(term.name), shown(term.what), shown(term.calledBy), term.setting.empty() ? "" : "; measured with " + shown(term.setting));
  fmt::print("   {:<22} {:>9} {:>9} {:>16} {:>8} {:>8} {:>8} {:>7} {:>6} {:>8} {:>8}\n", "against " + shown(term.exactRung), "pass ms", "frame ms", "a repeat", "rms %", "exact %", "truth %", "psnr", "butter", "p999 %",
             "energy %");
  for (const RungCost& r : term.rungs) printRung(r, truth);
}

void printFront(const CostReport& cost) {
  fmt::print("\nWhole qualities, errors against {}\n  {:>9} {:>16} {:>9} {:>7} {:>8}\n", cost.against == "exact" ? "the preset exact" : "ground truth", "frame ms", "a repeat", "rms %", "psnr", "energy %");
  for (const FrontPoint& p : cost.front)
    if (!p.dominated || p.quality == cost.base.quality || p.quality == cost.exact.quality)
      fmt::print("  {:>9} {:>16} {:>9} {:>7} {:>8}  {}{}\n", ms(p.ms), range(p.ms), percent(p.error.rms), decibels(p.error.psnr), fmt::format("{:+.2f}", 100 * p.error.energy),
                 p.settings.empty() ? "the base quality" : p.quality == cost.exact.quality ? "the preset exact" : listed(p.settings), p.dominated ? "  dominated" : "");
}

void printContributors(const CostReport& cost) {
  if (cost.contributors.empty()) return;
  fmt::print("\nOf the base quality's {} % (the reference's noise makes {} % of it uncertain), each of these alone would take off\n", percent(cost.base.error.rms), percent(cost.base.error.rmsSpread));
  for (const auto& [name, share] : cost.contributors) fmt::print("  {:>8}  {}\n", fmt::format("{:+.2f}", 100 * share), shown(name));
}

}  // namespace

void printCost(const CostReport& cost) {
  fmt::print("{} at {}x{}, {}, on {} ({}); milliseconds are {}\n", shown(cost.scene), cost.size.x, cost.size.y, shown(cost.camera), shown(cost.machine.renderer), shown(cost.cpu), cost.clock);
  for (const TermCost& term : cost.terms) printTerm(term, cost.against == "ground truth");
  if (!cost.idle.empty()) {
    fmt::print("\nNot measured\n");
    for (const auto& [name, why] : cost.idle) fmt::print("  {:<24} {}\n", shown(name), shown(why));
  }
  printFront(cost);
  printContributors(cost);
}

}  // namespace cli
