// Runs the tables of hard cases.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "stability/cases.h"

namespace burnish {
namespace {

using stability::Finding;

StabilityCase rowOf(std::string id, std::string what, std::string backend, double bound, const Finding& found) {
  return {std::move(id), std::move(what), std::move(backend), found.value, bound, std::isfinite(found.value) && found.value <= bound, found.where};
}
StabilityCase failedRow(std::string id, std::string what, std::string_view backend, double bound, const Error& error) {
  return {std::move(id), std::move(what), std::string(backend), std::nan(""), bound, false, error.message()};
}

/// The worst finding of the variants; what is not finite is worse than anything.
void keepWorst(Finding& worst, Finding found, const std::string& variant, bool first) {
  if (!first && !(found.value > worst.value) && std::isfinite(found.value)) return;
  if (!first && !std::isfinite(worst.value)) return;
  if (!variant.empty()) found.where = found.where.empty() ? variant : variant + ", " + found.where;
  worst = std::move(found);
}

struct Steps {
  const MeasureProgress& progress;
  int total, done = 0;
  void next(std::string_view what) {
    if (progress) progress(done, total, what);
    ++done;
  }
};

}  // namespace

std::vector<StabilityCase> stabilityOnCpu(const MeasureProgress& progress) {
  const auto text = stability::textCases();
  const auto oracle = stability::oracleCases();
  Steps steps{progress, int(text.size() + oracle.size())};
  std::vector<StabilityCase> rows;
  for (const stability::TextCase& c : text) {
    steps.next(c.what);
    Finding exact, single;
    bool first = true;
    for (const stability::TextVariant& v : c.variants) {
      std::vector<glm::dvec4> inDouble, inFloat;
      for (const stability::ShaderCase& input : c.inputs) {
        inDouble.push_back(v.inDouble(input));
        inFloat.emplace_back(v.inFloat(input));
      }
      keepWorst(exact, c.judge(c.inputs, inDouble), v.name, first);
      keepWorst(single, c.judge(c.inputs, inFloat), v.name, first);
      first = false;
    }
    rows.push_back(rowOf(c.id, c.what, "double", c.bound, exact));
    rows.push_back(rowOf(c.id, c.what, "float", c.bound, single));
  }
  for (const stability::OracleCase& c : oracle) {
    steps.next(c.what);
    rows.push_back(rowOf(c.id, c.what, "double", c.bound, c.measure()));
  }
  return rows;
}

std::vector<StabilityCase> stabilityOnGpu(const ProcAddress& getProcAddress, std::string_view backend, const MeasureProgress& progress) {
  const auto text = stability::textCases();
  const auto pictures = stability::pictureCases();
  Steps steps{progress, int(text.size() + pictures.size())};
  std::vector<StabilityCase> rows;
  auto device = gl::Device::create(getProcAddress, false);
  RendererOptions options;
  options.debugOutput = true;
  auto renderer = Renderer::create(getProcAddress, options);
  if (!device || !renderer) {
    rows.push_back(failedRow("H28", "a renderer can be made", backend, 0, device ? renderer.error() : device.error()));
    return rows;
  }
  {
    stability::ShaderCases evaluator(**device);
    for (const stability::TextCase& c : text) {
      steps.next(c.what);
      Finding worst;
      std::optional<Error> error;
      bool first = true;
      for (const stability::TextVariant& v : c.variants) {
        auto results = evaluator.evaluate(c.inputs, v.glsl);
        if (!results) {
          error = results.error();
          break;
        }
        const std::vector<glm::dvec4> values(results->begin(), results->end());
        keepWorst(worst, c.judge(c.inputs, values), v.name, first);
        first = false;
      }
      rows.push_back(error ? failedRow(c.id, c.what, backend, c.bound, *error) : rowOf(c.id, c.what, std::string(backend), c.bound, worst));
    }
  }
  for (const stability::PictureCase& c : pictures) {
    steps.next(c.what);
    auto found = c.measure(getProcAddress, **renderer);
    rows.push_back(found ? rowOf(c.id, c.what, std::string(backend), c.bound, *found) : failedRow(c.id, c.what, backend, c.bound, found.error()));
  }
  return rows;
}

}  // namespace burnish
