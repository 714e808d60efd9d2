// Which terms a scene exercises, and which rungs and qualities nothing beats.
#include <algorithm>

#include "cost/front.h"
#include "cost/measure_bed.h"

using namespace burnish;
using namespace burnish::cost;
using namespace burnish::test;

namespace {

template <class T, class Change>
void edit(Table<T>& table, Change change) {
  std::vector<Id<T>> ids;
  table.each([&](Id<T> id, const T&) { ids.push_back(id); });
  for (const Id<T> id : ids) change(*table.edit(id));
}

bool listed(const TermsToMeasure& found, std::string_view name) {
  return std::any_of(found.terms.begin(), found.terms.end(), [&](const TermToMeasure& t) { return terms()[t.term].name == name; });
}
std::string idleReason(const TermsToMeasure& found, std::string_view name) {
  for (const auto& [term, why] : found.idle)
    if (term == name) return why;
  return {};
}

}  // namespace

TEST_CASE("measure: terms that nothing calls for are left out, each with a reason") {
  Scene plain = ball();
  Bed bed(plain);
  const TermsToMeasure lit = bed.found();
  for (const char* name : {"specular", "geometry", "normalization", "lobe", "fresnel", "diffuse", "environment-specular", "ambient", "occlusion", "path"}) {
    INFO(name);
    CHECK(listed(lit, name));
  }
  for (const char* name : {"reflection", "ambient-source", "anisotropy", "rough-diffuse", "shadow", "specular-occlusion", "direct-occlusion", "antialiasing", "bloom", "specular-antialiasing"}) {
    INFO(name);
    CHECK(!listed(lit, name));
    CHECK(idleReason(lit, name).size() > 10);
  }
  for (const Term& t : terms()) {
    INFO(t.name);
    const bool choice = t.name == "normal-storage" || t.name == "light-buffer";  // measured with the sizes and formats
    CHECK((listed(lit, t.name) || !idleReason(lit, t.name).empty()) == !choice);
  }
  for (const TermToMeasure& t : lit.terms) {
    const std::string name(terms()[t.term].name);
    INFO(name);
    CHECK(!t.calledBy.empty());
    CHECK(std::find(t.rungs.begin(), t.rungs.end(), t.exact) != t.rungs.end());
    CHECK(t.setting == (name == "normalization" ? "geometry=void" : ""));
    for (const std::size_t rung : t.rungs) CHECK(idleRungs(t.with({}, rung)).empty());
  }
  CHECK(bed.found({}, {"fresnel"}).terms.size() == 1);
}

TEST_CASE("measure: what the scene brings calls for its terms") {
  Scene scene = ball();
  edit(scene.lights, [](Light& l) { l.castsShadow = true; });
  edit(scene.materials, [](Material& m) {
    m.anisotropy = 0.5f, m.diffuseRoughness = 0.4f;
    m.conductorEta = vec3(0.2f), m.conductorK = vec3(3);
  });
  Bed bed(std::move(scene));
  const TermsToMeasure found = bed.found();
  for (const char* name : {"anisotropy", "rough-diffuse", "shadow"}) {
    INFO(name);
    CHECK(listed(found, name));
  }
  for (const TermToMeasure& t : found.terms)
    if (terms()[t.term].name == "fresnel") CHECK(terms()[t.term].rungs[t.exact].name == "conductor");
  // Lamps gone, surroundings stay.
  edit(bed.scene.lights, [](Light& l) { l.enabled = false; });
  const TermsToMeasure dark = bed.found();
  for (const char* name : {"normalization", "lobe", "shadow"}) {
    INFO(name);
    CHECK(!listed(dark, name));
  }
  CHECK(listed(dark, "fresnel"));
}

TEST_CASE("measure: dominated rungs") {
  const auto rung = [](double rms) {
    RungCost r;
    r.exact.rms = rms;
    return r;
  };
  std::vector<RungCost> rungs{rung(0.10), rung(0.05), rung(0.05), rung(0), rung(0.2)};
  const auto time = [](double ms) { return Spread{ms, ms * 0.98, ms * 1.02, 7}; };
  // 0 is as fast as 1 and worse: dominated. 2 is as exact as 1 and slower. 3 is slowest and exact. 4 was not timed.
  markDominated(rungs, {time(1), time(1.01), time(1.2), time(2), {}});
  CHECK(rungs[0].dominated);
  CHECK(!rungs[1].dominated);
  CHECK(rungs[2].dominated);
  CHECK(!rungs[3].dominated);
  CHECK(!rungs[4].dominated);
  // Within the spread of both nothing beats anything.
  std::vector<RungCost> equal{rung(0.05), rung(0.05)};
  markDominated(equal, {time(1), time(1.01)});
  CHECK(!equal[0].dominated);
  CHECK(!equal[1].dominated);
}

TEST_CASE("measure: the front holds what nothing beats") {
  std::vector<FrontPoint> front(4);
  const double ms[] = {3, 1, 2, 2.5}, rms[] = {0, 0.3, 0.1, 0.2};
  for (std::size_t i = 0; i < 4; ++i) front[i].ms = {ms[i], ms[i], ms[i], 3}, front[i].error.rms = rms[i];
  sortFront(front);
  CHECK(front[0].ms.median == 1);
  CHECK(front[3].ms.median == 3);
  std::vector<bool> dominated;
  for (const FrontPoint& p : front) dominated.push_back(p.dominated);
  CHECK(dominated == std::vector<bool>{false, false, true, false});
}
