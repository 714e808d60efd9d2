#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

struct Explained {
  const char* word;
  const char* meaning;
};
constexpr Explained kGlossary[] = {
    {"relative rms", "Root mean square of the linear difference over the root mean square of what it counts against. 0 is equal; the noise of a path-traced picture is taken off."},
    {"energy", "Sum of the picture over the sum of what it counts against, less 1. Above 0 the picture is too bright in all, below 0 too dark: light was added or lost."},
    {"PSNR", "Peak signal to noise ratio of the two as developed for a display, in decibels. More is better; from about 40 dB on a difference is hard to see."},
    {"Butteraugli", "A model of what people see (libjxl), its 3-norm over the developed pictures. At 1 a difference is just seen; under it, it is not."},
    {"99.9th percentile", "One pixel in a thousand differs by more than this share of its value plus the mean. It finds small, strong faults that an average hides."},
    {"base", "The quality that the report started from; every rung is put into it alone. The rest exact: put into the preset exact instead."},
    {"exact", "The top rung of a term that applies here; the preset exact has it for every term. Ground truth is path traced with the same materials, lights and camera."},
    {"spread", "Times are medians; measured again, a median lies between the two figures 19 times in 20. Errors against ground truth have the standard error of its noise."},
    {"dominated", "Another one is no slower and no less exact, and better in one by more than the spread. There is no reason to choose it on this machine and scene."},
    {"front", "The qualities that none other dominates: to the left is faster, below is more exact. What a budget buys lies on it."},
};

/// Median and largest of (high - low) / median over what was timed.
std::string timeSpread(const CostReport& cost) {
  std::vector<double> spreads;
  for (const TermCost& t : cost.terms)
    for (const RungCost& r : t.rungs)
      for (const Spread* s : {&r.passMs, &r.frameMs, &r.exactPassMs})
        if (measured(*s) && s->count > 1 && s->median > 0 && std::isfinite(s->high - s->low)) spreads.push_back((s->high - s->low) / s->median);
  if (spreads.empty()) return "No figure was timed more than once.";
  std::sort(spreads.begin(), spreads.end());
  return fmt::format("{} times were measured; from low to high their spread is {} of the median in the middle case and {} at most.", spreads.size(), percent(spreads[spreads.size() / 2]), percent(spreads.back()));
}

std::string pixels(const CostReport& cost) {
  long long skipped = cost.base.error.skipped, uncertain = cost.base.error.uncertain;
  for (const TermCost& t : cost.terms)
    for (const RungCost& r : t.rungs)
      for (const PictureError* e : {&r.exact, &r.exactRest, &r.truth}) skipped = std::max(skipped, e->skipped), uncertain = std::max(uncertain, e->uncertain);
  std::string text = skipped > 0 ? fmt::format("Up to {} pixels of a picture were not finite and do not count.", skipped) : "All pixels were finite.";
  if (uncertain > 0) text += fmt::format(" Up to {} pixels, where the noise of ground truth is over its value and mean together, are left out of rms and energy.", uncertain);
  return text;
}

std::string list(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string out = "<dl class=\"words\">\n";
  for (const auto& [name, text] : rows) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escaped(name), escaped(text));
  return out + "</dl>\n";
}

}  // namespace

std::string pageTail(const PageInput& in) {
  const CostReport& c = in.cost;
  std::string out = "<section id=\"idle\">\n<h2>Not exercised</h2>\n";
  out += c.idle.empty() ? "<p class=\"soft\">The report names no term that the scene leaves idle.</p>\n" : "<p>What this scene does not call for costs nothing here and has no ladder.</p>\n" + list(c.idle);
  out += "</section>\n<section id=\"sure\">\n<h2>How sure the figures are</h2>\n";
  out += fmt::format("<p>{}</p>\n<p>{}</p>\n", timeSpread(c), pixels(c));
  if (c.referenceSamples > 0)
    out += fmt::format("<p>Ground truth has {} paths a pixel; the rms of its noise over the picture's is {}. It is taken off the errors; what it leaves uncertain stands behind each ±.</p>\n", c.referenceSamples, percent(c.referenceNoise));
  out += "</section>\n";
  if (!c.warnings.empty()) {
    out += "<section id=\"warnings\">\n<h2>Warnings</h2>\n<ul class=\"warnings\">\n";
    for (const std::string& w : c.warnings) out += fmt::format("<li>{}</li>\n", escaped(w));
    out += "</ul>\n</section>\n";
  }
  out += "<section id=\"glossary\">\n<h2>Glossary</h2>\n<dl class=\"words\">\n";
  for (const Explained& e : kGlossary) out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", e.word, e.meaning);
  return out + "</dl>\n</section>\n<footer>Made by burnish cost. cost.json and cost.csv beside this page have the same figures; plots/ has the drawings as SVG and PNG.</footer>\n";
}

}  // namespace burnish::cost
