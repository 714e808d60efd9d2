#include "text.h"

#include <burnish/quality.h>

#include <cfloat>
#include <regex>

namespace burnish::test {

std::string Row::glsl() const {
  const std::string number = std::regex_replace(text.glsl, std::regex("\\brung\\b"), std::to_string(rung));
  return std::regex_replace(number, std::regex("\\brungs\\b"), stability::glslOf(rungs));
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all = [] {
    std::vector<Row> made;
    for (const auto add : {addConversions, addLobes, addFresnel, addDiffuse, addSpecular, addSurroundings, addSampling}) add(made);
    return made;
  }();
  return all;
}

std::string rungName(std::string_view term, int rung) {
  for (const Term& t : terms())
    if (t.name == term) return std::string(term) + "=" + std::string(t.rungs[std::size_t(rung)].name);
  return std::string(term) + "=?";
}

Scale absolute() {
  return {"", [](const Row&, const Case&, const glm::dvec4&, int) { return 1.0; }};
}
Scale relative() {
  return {" of the value", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(std::abs(exact[k]), 1e-30); }};
}
Scale ulp() {
  return {" ulp", [](const Row&, const Case&, const glm::dvec4& exact, int k) { return std::max(std::abs(exact[k]), double(FLT_MIN)) * 0x1p-23; }};
}

std::function<Ranges(const Row&, const Case&)> within(double lo, double hi) {
  return [=](const Row&, const Case&) { return Ranges{{{lo, hi}, {lo, hi}, {lo, hi}, {lo, hi}}}; };
}
std::function<Ranges(const Row&, const Case&)> ranges(Range x, Range y, Range z, Range w) {
  return [=](const Row&, const Case&) { return Ranges{{x, y, z, w}}; };
}

}  // namespace burnish::test
