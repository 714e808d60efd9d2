#include "cost/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cost/page_text.h"

namespace burnish::cost {
namespace {

using Json = nlohmann::ordered_json;

Json figure(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json spread(const Spread& s) {
  if (!measured(s)) return {};
  return {{"median", figure(s.median)}, {"low", figure(s.low)}, {"high", figure(s.high)}, {"count", s.count}};
}

Json error(const PictureError& e) {
  if (!measured(e)) return {};
  return {{"rms", figure(e.rms)},   {"rms_spread", figure(e.rmsSpread)}, {"psnr", figure(e.psnr)},  {"perceptual", figure(e.perceptual)},
          {"p999", figure(e.p999)}, {"energy", figure(e.energy)},        {"skipped", e.skipped},  {"uncertain", e.uncertain}};
}

Json texts(const std::vector<std::string>& list) {
  Json out = Json::array();
  for (const std::string& text : list) out.push_back(cleanText(text));
  return out;
}

Json rungsOf(const Quality& quality) {
  Json out = Json::object();
  for (std::size_t t = 0; t < terms().size(); ++t) out[std::string(terms()[t].name)] = terms()[t].rungs[rungOf(quality, t)].name;
  return out;
}

Json point(const FrontPoint& p) {
  return {{"settings", texts(p.settings)},
          {"ms", measured(p.ms) ? figure(p.ms.median) : Json()},
          {"spread", spread(p.ms)},
          {"error", error(p.error)},
          {"dominated", p.dominated},
          {"rungs", rungsOf(p.quality)}};
}

Json rung(const RungCost& r, const char* clock) {
  return {{"rung", cleanText(r.name)},
          {"in_force", r.inForce},
          {clock, measured(r.passMs) ? figure(r.passMs.median) : Json()},
          {"spread", spread(r.passMs)},
          {"frame_ms", spread(r.frameMs)},
          {"exact_rest_ms", spread(r.exactPassMs)},
          {"error", error(r.exact)},
          {"error_exact_rest", error(r.exactRest)},
          {"error_truth", error(r.truth)},
          {"dominated", r.dominated},
          {"note", cleanText(r.note)}};
}

Json termJson(const TermCost& t, const char* clock) {
  Json rungs = Json::array();
  for (const RungCost& r : t.rungs) rungs.push_back(rung(r, clock));
  return {{"term", cleanText(t.name)}, {"what", cleanText(t.what)}, {"called_by", cleanText(t.calledBy)}, {"choice", t.choice}, {"exact_rung", cleanText(t.exactRung)}, {"rungs", rungs}};
}

Json budget(const BudgetResult& b) {
  return {{"ms", b.ms > 0 ? figure(b.ms) : Json()},
          {"target_error", b.targetError > 0 ? figure(b.targetError) : Json()},
          {"met", b.met},
          {"best", point(b.best)},
          {"next", b.next ? point(*b.next) : Json()},
          {"measured", b.measured}};
}

Json machine(const CostReport& cost) {
  return {{"cpu", cleanText(cost.cpu)},
          {"backend", cleanText(cost.backend)},
          {"vendor", cleanText(cost.machine.vendor)},
          {"renderer", cleanText(cost.machine.renderer)},
          {"version", cleanText(cost.machine.version)},
          {"software", cost.machine.software}};
}

}  // namespace

std::string costJson(const CostReport& cost, const std::vector<BudgetResult>& budgets) {
  const char* clock = cost.clock.find("GPU") != std::string::npos ? "gpu_ms" : "cpu_ms";
  Json termList = Json::array(), front = Json::array(), budgetList = Json::array(), contributors = Json::array(), idle = Json::array();
  for (const TermCost& t : cost.terms) termList.push_back(termJson(t, clock));
  for (const FrontPoint& p : cost.front) {
    front.push_back(point(p));
    const std::string_view preset = presetOf(cost, p);
    front.back()["preset"] = preset.empty() ? Json() : Json(std::string(preset));
  }
  for (const BudgetResult& b : budgets) budgetList.push_back(budget(b));
  for (const auto& [name, gain] : cost.contributors) contributors.push_back({{"name", cleanText(name)}, {"rms", figure(gain)}});
  for (const auto& [name, reason] : cost.idle) idle.push_back({{"term", cleanText(name)}, {"reason", cleanText(reason)}});
  const Json document = {{"schema_version", 1},
                         {"scene", cleanText(cost.scene)},
                         {"camera", cleanText(cost.camera)},
                         {"command", cleanText(cost.command)},
                         {"size", {cost.size.x, cost.size.y}},
                         {"clock", cleanText(cost.clock)},
                         {"against", cleanText(cost.against)},
                         {"reference", {{"samples", cost.referenceSamples}, {"noise", figure(cost.referenceNoise)}}},
                         {"seconds", figure(cost.seconds)},
                         {"difference_scale", figure(cost.differenceScale)},
                         {"machine", machine(cost)},
                         {"base", point(cost.base)},
                         {"exact", point(cost.exact)},
                         {"contributors", contributors},
                         {"front", front},
                         {"budgets", budgetList},
                         {"terms", termList},
                         {"idle", idle},
                         {"warnings", texts(cost.warnings)}};
  return document.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace burnish::cost
