#include "doctor_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "messages.h"

namespace cli {
namespace {

void row(std::string_view name, const std::string& value) { fmt::print("  {:<16} {}\n", name, value); }

/// Something that drivers may have or lack, and what the engine does either way.
struct Feature {
  const char* name;
  const char* id;  ///< in JSON
  bool burnish::Capabilities::*has;
  const char* with;
  const char* without;
};
constexpr Feature kFeatures[] = {
    {"anisotropic filtering", "anisotropic", &burnish::Capabilities::anisotropic, "textures stay sharp at grazing angles", "textures blur at grazing angles"},
    {"program binaries", "program_binary", &burnish::Capabilities::programBinary, "a program cache (RendererOptions::programCache) saves linking at the next start", "every start links all programs"},
    {"parallel compile", "parallel_compile", &burnish::Capabilities::parallelCompile, "warmUp() compiles programs side by side", "warmUp() compiles one program after another"},
    {"timer queries", "timer_queries", &burnish::Capabilities::timerQueries, "times of passes", "no times of passes but with --profile"},
    {"debug output", "debug_output", &burnish::Capabilities::debugOutput, "errors come with the driver's own words", "errors come as numbers"},
    {"draw parameters", "draw_parameters", &burnish::Capabilities::drawParameters, "not used", "not used"},
};

/// The pass times that queries give, against those between glFinish calls.
std::string queriesJudged(const TrialFrame& t) {
  if (!t.queryMs) return "none arrived: use --profile";
  const std::string both = fmt::format("{:.2f} ms by queries, {:.2f} ms finished pass by pass", *t.queryMs, t.finishedMs);
  return both + (*t.queryMs < 0.5 * t.finishedMs || *t.queryMs > 2 * t.finishedMs ? ": queries mislead here, use --profile" : "");
}

void printTrial(const TrialFrame& t) {
  if (!t.error.empty()) return row("trial frame", "FAILS: " + shown(t.error));
  row("trial frame", fmt::format("{:.2f} ms at 320x180; {} programs linked in {:.0f} ms", t.frameMs, t.programs, t.linkMs));
  row("pass times", queriesJudged(t));
  if (t.nonfinitePixels) row("", fmt::format("FAILS: {} pixels are not finite", t.nonfinitePixels));
  for (const std::string& e : t.glErrors) row("", "FAILS: " + shown(e));
}

std::string idsOf(const std::vector<burnish::StabilityCase>& cases, bool failing) {
  std::vector<std::string> ids;
  for (const auto& c : cases)
    if ((!failing || !c.pass) && std::find(ids.begin(), ids.end(), c.id) == ids.end()) ids.push_back(c.id);
  return listed(ids);
}

void printCases(const BackendReport& report) {
  if (!report.casesRun) return row("hard cases", "left out");
  const auto failed = std::count_if(report.cases.begin(), report.cases.end(), [](const auto& c) { return !c.pass; });
  row("hard cases", fmt::format("{} of {} hold{}", report.cases.size() - std::size_t(failed), report.cases.size(), failed ? ", fails: " + idsOf(report.cases, true) : ""));
  for (const auto& c : report.cases) {
    if (c.pass) continue;
    const std::string value = std::isfinite(c.value) ? fmt::format("{:.4g}", c.value) : std::string("no number");
    fmt::print("    {:<4} {}\n         {} of {:.4g}{}\n", c.id, c.what, value, c.bound, c.note.empty() ? "" : ": " + shown(c.note));
  }
}

}  // namespace

std::size_t BackendReport::failed() const {
  const bool trialFailed = usable && (!trial.error.empty() || trial.nonfinitePixels > 0 || !trial.glErrors.empty());
  return std::size_t(std::count_if(cases.begin(), cases.end(), [](const auto& c) { return !c.pass; })) + (trialFailed ? 1 : 0);
}

void print(const MachineReport& m) { fmt::print("burnish " BURNISH_VERSION "; {}; {}, {} threads\n", shown(m.system), shown(m.processor), m.threads); }

void print(const BackendReport& report, bool extensions) {
  fmt::print("{}\n", report.name);
  if (!report.usable) return row("not available", shown(report.error));
  const burnish::Capabilities& c = report.capabilities;
  row("renderer", shown(c.renderer) + (c.software ? " (software: it draws on the CPU)" : ""));
  row("version", shown(c.version) + ", " + shown(c.vendor));
  for (const Feature& f : kFeatures) row(f.name, fmt::format("{}: {}", c.*f.has ? "yes" : "no", c.*f.has ? f.with : f.without));
  row("largest texture", fmt::format("{} pixels; {} texture units; largest point {:g} pixels", c.maxTextureSize, c.maxTextureUnits, c.maxPointSize));
  row("largest block", fmt::format("uniforms {} bytes (aligned to {}), storage {} bytes, texture buffers {} texels", c.maxUniformBlockBytes, c.uniformAlignment, c.maxStorageBlockBytes, c.maxTextureBufferTexels));
  printTrial(report.trial);
  printCases(report);
  row("extensions", std::to_string(c.extensions.size()));
  if (extensions)
    for (const std::string& name : c.extensions) fmt::print("    {}\n", shown(name));
}

void printRemedies(const std::vector<BackendReport>& reports, bool quick) {
  std::vector<std::string> good;
  for (const BackendReport& r : reports)
    if (r.usable && r.failed() == 0) good.push_back(r.name);
  bool said = false;
  for (const BackendReport& r : reports) {
    if (!r.usable || r.failed() == 0) continue;
    said = true;
    fmt::print("{}: update the driver{}; if it stays, report this page with the table of: burnish stability --backend {} -o stability.json\n", r.name,
               good.empty() ? "" : fmt::format(", or use --backend {}, which holds all that was run", listed(good)), r.name);
  }
  if (!said && !good.empty()) fmt::print("nothing is wrong with {}{}\n", listed(good), quick ? " (the slow hard cases were left out)" : "");
}

Json toJson(const MachineReport& machine, const std::vector<BackendReport>& reports) {
  Json out;
  out["schema_version"] = 1;
  out["program"] = "burnish " BURNISH_VERSION;
  out["system"] = machine.system;
  out["processor"] = machine.processor;
  out["threads"] = machine.threads;
  out["backends"] = Json::array();
  for (const BackendReport& r : reports) {
    Json b{{"backend", r.name}, {"usable", r.usable}, {"error", r.error}};
    if (r.usable) {
      const burnish::Capabilities& c = r.capabilities;
      b["vendor"] = c.vendor, b["renderer"] = c.renderer, b["version"] = c.version, b["software"] = c.software;
      for (const Feature& f : kFeatures) b["features"][f.id] = c.*f.has;
      b["limits"] = {{"texture_size", c.maxTextureSize},          {"texture_units", c.maxTextureUnits},          {"uniform_block_bytes", c.maxUniformBlockBytes}, {"uniform_alignment", c.uniformAlignment},
                     {"storage_block_bytes", c.maxStorageBlockBytes}, {"texture_buffer_texels", c.maxTextureBufferTexels}, {"point_size", c.maxPointSize}};
      b["trial"] = {{"error", r.trial.error}, {"programs", r.trial.programs}, {"link_ms", r.trial.linkMs}, {"frame_ms", r.trial.frameMs}, {"query_ms", r.trial.queryMs ? Json(*r.trial.queryMs) : Json()},
                    {"finished_ms", r.trial.finishedMs}, {"nonfinite_pixels", r.trial.nonfinitePixels}, {"gl_errors", r.trial.glErrors}};
      b["cases"] = Json::array();
      for (const auto& k : r.cases) b["cases"].push_back({{"id", k.id}, {"case", k.what}, {"value", k.value}, {"bound", k.bound}, {"pass", k.pass}, {"note", k.note}});
      b["extensions"] = c.extensions;
    }
    b["failed"] = r.failed();
    out["backends"].push_back(std::move(b));
  }
  return out;
}

}  // namespace cli
