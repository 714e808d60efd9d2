#include <fmt/format.h>

#include <cmath>

#include "cost/page.h"
#include "cost/page_text.h"

namespace burnish::cost {
namespace {

std::string fact(std::string_view name, const std::string& value) {
  return value.empty() ? "" : fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
}

std::string truthText(const CostReport& cost) {
  std::string text = cost.against;
  if (cost.referenceSamples > 0) text += fmt::format(", {} paths a pixel, noise {}", cost.referenceSamples, percent(cost.referenceNoise));
  return text;
}

}  // namespace

std::string pageHead(const PageInput& in) {
  const CostReport& c = in.cost;
  std::string out = "<a class=\"skip\" href=\"#main\">To the figures</a>\n<nav aria-label=\"Sections\"><div class=\"wide\">\n";
  out += fmt::format("<a href=\"#base\">{}</a><a href=\"#front\">Front</a>{}{}{}<a href=\"#sure\">Spread</a><a href=\"#glossary\">Glossary</a>\n", c.against == "ground truth" ? "Against truth" : "Against exact",
                     in.budgets.empty() ? "" : "<a href=\"#budgets\">Budgets</a>", "<a href=\"#terms\">Terms</a>", "<a href=\"#choices\">Choices</a>");
  out += "<button type=\"button\" id=\"theme\" hidden>Dark</button></div></nav>\n";
  out += fmt::format("<header class=\"wide\">\n<p class=\"eyebrow\">What accuracy costs</p>\n<h1>{}</h1>\n<dl class=\"facts\">\n", escaped(c.scene.empty() ? "scene" : c.scene));
  const std::string driver = c.machine.renderer + (c.machine.version.empty() ? "" : ", " + c.machine.version);
  out += fact("camera", c.camera) + fact("size", fmt::format("{} × {} pixels", c.size.x, c.size.y)) + fact("clock", c.clock) + fact("errors count against", truthText(c));
  out += fact("processor", c.cpu) + fact("driver", driver) + fact("backend", c.backend) + fact("measured in", duration(c.seconds));
  out += "</dl>\n";
  if (!c.command.empty())
    out += fmt::format("<div class=\"command\"><code id=\"command\" tabindex=\"0\" aria-label=\"Command that makes this report again\">{}</code><button type=\"button\" id=\"copy\" hidden>Copy</button></div>\n", escaped(c.command));
  if (!c.warnings.empty()) out += fmt::format("<p class=\"caution\"><a href=\"#warnings\">{} warning{}</a></p>\n", c.warnings.size(), c.warnings.size() == 1 ? "" : "s");
  return out + "</header>\n";
}

std::string baseName(const CostReport& cost) {
  const std::string_view preset = presetOf(cost, cost.base);
  return preset.empty() ? "base" : std::string(preset);
}

std::string plotBox(const Plot& plot) {
  return fmt::format("<div class=\"plotbox\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">{}</div>\n", escaped(plot.title), plot.drawing.inlined(plot.name, plot.title, plot.about));
}

std::string scrollBox(std::string_view label, std::string_view table) { return fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">{}</div>\n", escaped(label), table); }

std::string flipBox(const PageInput& in, const Image& first, std::string_view firstName, const Image& second, std::string_view secondName) {
  if (!in.pictures.has(first) || !in.pictures.has(second)) return in.pictures.show(first, firstName);
  return fmt::format(
      "<label class=\"flip\"><input type=\"checkbox\" aria-label=\"Show {1} in place of {0}\"><span class=\"one\">{2}</span><span class=\"two\">{3}</span><span class=\"tag one\">{0}</span><span class=\"tag "
      "two\">{1}</span></label>",
      escaped(firstName), escaped(secondName), in.pictures.show(first, firstName), in.pictures.show(second, secondName));
}

std::string colourBar(const PageInput& in) {
  constexpr int kSteps = 64;
  constexpr double kWidth = 300, kLeft = 18;
  std::string bar;
  for (int i = 0; i < kSteps; ++i) {
    const double root = (i + 0.5) / kSteps;
    const auto c = differenceColour(root * root);
    bar += fmt::format("<rect x=\"{:.2f}\" y=\"2\" width=\"{:.2f}\" height=\"12\" fill=\"#{:02x}{:02x}{:02x}\"/>", kLeft + kWidth * i / kSteps, kWidth / kSteps + 0.3, c[0], c[1], c[2]);
  }
  const double white = in.pictures.white();
  std::string text;
  for (int i = 0; i <= 4; ++i) {
    const double x = kLeft + kWidth * i / 4;
    text += fmt::format("<line x1=\"{0:.1f}\" y1=\"14\" x2=\"{0:.1f}\" y2=\"18\" class=\"axis\"/><text x=\"{0:.1f}\" y=\"30\" text-anchor=\"middle\" class=\"small\">{1}</text>", x, percent(white * i * i / 16));
  }
  return fmt::format("<div class=\"scale\"><svg class=\"plot bar-scale\" viewBox=\"0 0 352 34\" width=\"352\" height=\"34\" shape-rendering=\"crispEdges\" role=\"img\" aria-label=\"Colours of differences, from 0 to {0} of white\">{1}{2}</svg>"
                     "<span>difference, share of the exposure's white; square-root scale, the same in all pictures</span></div>\n",
                     percent(white), bar, text);
}

}  // namespace burnish::cost
