// Runs the tables of hard cases.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <set>

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

template <class Case>
void append(std::vector<Case>& all, std::vector<Case> more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}
template <class Case>
std::vector<Case> chosen(std::vector<Case> all, const StabilityOptions& options) {
  std::erase_if(all, [&](const Case& c) {
    if (!options.cases.empty() && std::find(options.cases.begin(), options.cases.end(), c.id) == options.cases.end()) return true;
    if constexpr (requires { c.slow; }) return options.quick && c.slow;
    return false;
  });
  return all;
}
std::vector<stability::TextCase> allText() {
  auto all = stability::textCases();
  append(all, stability::modelTextCases());
  append(all, stability::probeTextCases());
  return all;
}
std::vector<stability::OracleCase> allOracle() {
  auto all = stability::oracleCases();
  append(all, stability::filterOracleCases());
  return all;
}
std::vector<stability::PictureCase> allPictures() {
  auto all = stability::pictureCases();
  append(all, stability::placePictureCases());
  append(all, stability::bakePictureCases());
  append(all, stability::filterPictureCases());
  append(all, stability::screenPictureCases());
  append(all, stability::surfacePictureCases());
  return all;
}

/// All variants of a text case on the GPU; the worst one counts.
StabilityCase onGpu(stability::ShaderCases& evaluator, const stability::TextCase& c, std::string_view backend) {
  Finding worst;
  bool first = true;
  for (const stability::TextVariant& v : c.variants) {
    auto results = evaluator.evaluate(c.inputs, v.glsl);
    if (!results) return failedRow(c.id, c.what, backend, c.bound, results.error());
    const std::vector<glm::dvec4> values(results->begin(), results->end());
    keepWorst(worst, c.judge(c.inputs, values), v.name, first);
    first = false;
  }
  return rowOf(c.id, c.what, std::string(backend), c.bound, worst);
}

}  // namespace

std::vector<std::string> stabilityIds() {
  std::set<int> numbers;
  const auto add = [&](const auto& cases) {
    for (const auto& c : cases) numbers.insert(std::atoi(c.id.c_str() + 1));
  };
  add(allText());
  add(allOracle());
  add(allPictures());
  std::vector<std::string> ids;
  for (const int n : numbers) ids.push_back(fmt::format("H{}", n));
  return ids;
}

std::vector<StabilityCase> stabilityOnCpu(const StabilityOptions& options) {
  const auto text = chosen(allText(), options);
  const auto oracle = chosen(allOracle(), options);
  Steps steps{options.progress, int(text.size() + oracle.size())};
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

std::vector<StabilityCase> stabilityOnGpu(const ProcAddress& getProcAddress, std::string_view backend, const StabilityOptions& options) {
  const auto text = chosen(allText(), options);
  const auto pictures = chosen(allPictures(), options);
  Steps steps{options.progress, int(text.size() + pictures.size())};
  std::vector<StabilityCase> rows;
  auto device = gl::Device::create(getProcAddress, false);
  RendererOptions rendering;
  rendering.debugOutput = true;
  rendering.linkOnDemand = true;
  rendering.shaderOverride = options.shaderOverride;
  auto renderer = Renderer::create(getProcAddress, rendering);
  if (!device || !renderer) {
    rows.push_back(failedRow("H28", "a renderer can be made", backend, 0, device ? renderer.error() : device.error()));
    return rows;
  }
  {
    stability::ShaderCases evaluator(**device, options.shaderOverride);
    for (const stability::TextCase& c : text) {
      steps.next(c.what);
      rows.push_back(onGpu(evaluator, c, backend));
    }
  }
  gl::ProgramCache programs(**device, gl::ShaderLibrary(options.shaderOverride));
  stability::Studio studio{getProcAddress, **device, programs, **renderer};
  for (const stability::PictureCase& c : pictures) {
    steps.next(c.what);
    auto found = c.measure(studio);
    rows.push_back(found ? rowOf(c.id, c.what, std::string(backend), c.bound, *found) : failedRow(c.id, c.what, backend, c.bound, found.error()));
  }
  return rows;
}

}  // namespace burnish
