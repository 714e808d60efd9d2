#include "cost/terms.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "cost/front.h"
#include "plan/rungs.h"
#include "plan/situation.h"

namespace burnish::cost {
namespace {

using Effects = std::span<const std::string_view>;
constexpr std::string_view kLights[] = {"directional_lights", "local_lights"};
constexpr std::string_view kSurroundings[] = {"environment_lighting", "reflection_probes"};
constexpr std::string_view kAmbient[] = {"environment_lighting", "reflection_probes", "ambient_grid"};
constexpr std::string_view kAnyLight[] = {"directional_lights", "local_lights", "environment_lighting", "reflection_probes", "ambient_grid"};
constexpr std::string_view kOccluded[] = {"baked_occlusion", "screen_occlusion"};
constexpr std::string_view kAnisotropy[] = {"anisotropy"}, kRough[] = {"rough_diffuse"}, kShadows[] = {"shadows"}, kGeometry[] = {"geometry"}, kProbes[] = {"reflection_probes"}, kGrid[] = {"ambient_grid"};

/// When a term counts: one effect of `calls` is on, and one of `beside`, in the plan of the base quality with `rung` in force (empty: as it is).
struct Row {
  std::string_view term, rung;
  Effects calls, beside;
  std::string_view idle;       ///< why it does not
  std::string_view exact = {}; ///< the exact rung where it is not the last
};
// exact: V-cavities are another model of the surface, no better one than Smith's; ambient occlusion on highlights is no light transport, it is kept for the preset `seed`. The preset `exact` has neither.
constexpr Row kRows[] = {
    {"specular", "", kAnyLight, {}, "no light reaches anything in view"},
    {"distribution", "", kAnyLight, {}, "no light reaches anything in view"},
    {"geometry", "", kAnyLight, {}, "no light reaches anything in view", "smith"},
    {"normalization", "", kLights, {}, "no light source reaches anything in view"},
    {"lobe", "", kLights, {}, "no light source reaches anything in view"},
    {"fresnel", "", kAnyLight, {}, "no light reaches anything in view"},
    {"diffuse", "", kAnyLight, {}, "no light reaches anything in view"},
    {"compensation", "", kAnyLight, {}, "no light reaches anything in view"},
    {"environment-specular", "dfg", kSurroundings, {}, "there are no surroundings and no probes"},
    {"ambient", "sh-l2", kAmbient, {}, "there are no surroundings and no probes"},
    {"ambient-source", "grid", kGrid, {}, "the scene has no ambient lattice in view"},
    {"reflection", "box", kProbes, {}, "no reflection probe lights anything in view"},
    {"occlusion", "screen-4", kOccluded, {}, "there is no ambient light that it takes from"},
    {"specular-occlusion", "lagarde", kSurroundings, kOccluded, "the base quality has no ambient occlusion here"},
    {"direct-occlusion", "specular", kLights, kOccluded, "the base quality has no ambient occlusion here", "none"},
    {"anisotropy", "tangents", kAnisotropy, {}, "nothing in view is brushed"},
    {"rough-diffuse", "oren-nayar", kRough, {}, "nothing in view has a diffuse roughness of its own"},
    {"path", "", kGeometry, {}, "nothing is in view"},
    {"shadow", "pcf", kShadows, {}, "no light in view casts shadows"},
    {"antialiasing", "", {}, {}, "pictures are compared through pixel centres, where it has no part"},
    {"bloom", "", {}, {}, "pictures are compared as light, before the lens scatters it"},
    {"specular-antialiasing", "", {}, {}, "it aims at the mean over a pixel, and pictures are compared through pixel centres"},
};

std::size_t termNamed(std::string_view name) {
  return std::size_t(std::find_if(terms().begin(), terms().end(), [&](const Term& t) { return t.name == name; }) - terms().begin());
}
std::size_t rungNamed(std::size_t term, std::string_view name) {
  const auto rungs = terms()[term].rungs;
  return std::size_t(std::find_if(rungs.begin(), rungs.end(), [&](const Rung& r) { return r.name == name; }) - rungs.begin());
}

/// The first of the effects that is on; nullptr where none is.
const EffectPlan* firstOn(const FramePlan& plan, Effects effects) {
  for (const EffectPlan& e : plan.effects)
    if (e.on && std::find(effects.begin(), effects.end(), e.name) != effects.end()) return &e;
  return nullptr;
}

/// The first material in view that names a conductor; nullptr where none does.
const Material* namedConductor(const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality) {
  scene::Derived derived;
  derived.update(scene);
  Report report;
  plan::Seen seen;
  plan::look(scene, derived, view, size, quality, report, seen);
  for (const scene::VisibleInstance& visible : seen.instances) {
    const Material* material = scene.materials.get(visible.instance->material);
    if (material && glm::any(glm::greaterThan(material->conductorK, glm::vec3(0)))) return material;
  }
  return nullptr;
}

/// Why a rung of an exercised term does not apply; empty where it does.
std::string notApplying(std::string_view term, std::string_view rung, const FramePlan& plan, bool conductor) {
  if (term == "fresnel" && rung == "conductor" && !conductor) return "nothing in view is a named conductor";
  if (term == "specular" && rung == "ward-anisotropic" && !plan.on("anisotropy")) return "nothing in view is brushed: it is ward";
  if (term == "ambient" && rung == "box" && !plan.on("reflection_probes")) return "no reflection probe lights anything in view: it is sh-l2";
  return {};
}

bool programsDiffer(const FramePlan& a, const PassPlan& x, const FramePlan& b, const PassPlan& y) {
  if (x.programs != y.programs || x.reads != y.reads || x.writes != y.writes) return true;
  const auto definition = [](const FramePlan& plan, const std::string& name) { return std::find_if(plan.programs.begin(), plan.programs.end(), [&](const ProgramPlan& p) { return p.name == name; }); };
  for (const std::string& name : x.programs) {
    const auto p = definition(a, name), q = definition(b, name);
    if ((p == a.programs.end()) != (q == b.programs.end()) || (p != a.programs.end() && !(*p == *q))) return true;
  }
  const auto target = [](const FramePlan& plan, const std::string& name) { return plan.target(name); };
  return std::any_of(x.writes.begin(), x.writes.end(), [&](const std::string& name) {
    const TargetPlan *p = target(a, name), *q = target(b, name);
    return (p == nullptr) != (q == nullptr) || (p && (p->format != q->format || p->width != q->width || p->height != q->height));
  });
}

}  // namespace

Quality TermToMeasure::with(Quality q, std::size_t rung) const {
  const std::string_view name = terms()[term].name;
  if (name == "distribution" || name == "geometry" || name == "normalization") q.specular = Specular::Microfacet;
  if (name == "normalization") q.geometry = Geometry::Void, q.distribution = Distribution::BlinnPhong;
  if (name == "lobe" && (plan::familyOf(q) == int(Distribution::Beckmann) || plan::familyOf(q) == int(Distribution::Ggx))) {
    q.specular = Specular::Microfacet;
    q.distribution = Distribution::BlinnPhong;
  }
  setRung(q, term, rung);
  return q;
}

TermsToMeasure termsToMeasure(const Scene& scene, const View& view, glm::ivec2 size, const Quality& base, const std::function<FramePlan(const Quality&)>& planOf, const std::vector<std::string>& only) {
  TermsToMeasure found;
  for (const Row& row : kRows) {
    if (!only.empty() && std::find(only.begin(), only.end(), row.term) == only.end()) continue;
    TermToMeasure t;
    t.term = termNamed(row.term);
    Quality asked = base;
    if (!row.rung.empty()) setRung(asked, t.term, rungNamed(t.term, row.rung));
    const FramePlan plan = planOf(asked);
    const EffectPlan* caller = firstOn(plan, row.calls);
    if (!caller || (!row.beside.empty() && !firstOn(plan, row.beside))) {
      found.idle.emplace_back(row.term, row.idle);
      continue;
    }
    t.calledBy = fmt::format("{}: {}", caller->name, caller->reason);
    const bool conductor = row.term == "fresnel" && namedConductor(scene, view, size, base);
    for (std::size_t r = 0; r < terms()[t.term].rungs.size(); ++r) {
      Quality with = base;
      setRung(with, t.term, r);
      const std::string why = notApplying(row.term, terms()[t.term].rungs[r].name, planOf(with), conductor);
      if (why.empty()) t.rungs.push_back(r);
      else t.leftOut.emplace_back(terms()[t.term].rungs[r].name, why);
    }
    t.exact = row.exact.empty() ? t.rungs.back() : rungNamed(t.term, row.exact);
    t.setting = fmt::format("{}", fmt::join(settingsOf(t.with(base, rungOf(base, t.term)), base), ", "));
    found.terms.push_back(std::move(t));
  }
  return found;
}

std::vector<std::string> changedPasses(const FramePlan& a, const FramePlan& b) {
  std::vector<std::string> names;
  for (const PassPlan& pass : a.passes) {
    const PassPlan* other = b.pass(pass.name);
    if (!other || programsDiffer(a, pass, b, *other)) names.push_back(pass.name);
  }
  for (const PassPlan& pass : b.passes)
    if (!a.pass(pass.name)) names.push_back(pass.name);
  return names;
}

std::string missingLight(const Scene& scene, const FramePlan& plan) {
  std::vector<std::string> parts;
  if (!plan.on("reflection_probes") && !plan.on("ambient_grid")) parts.emplace_back("light that bounces between surfaces, and what hides the surroundings from them (there are no probes)");
  else parts.emplace_back("what probes cannot tell of bounced light between their places");
  if (plan.on("emissive")) parts.emplace_back("light of emissive surfaces on others");
  if (plan.on("glass") || plan.on("alpha_blend")) parts.emplace_back("light through transparent surfaces");
  bool sized = false;
  scene.lights.each([&](Id<Light>, const Light& l) { sized = sized || l.sourceRadius > 0 || l.angularDiameter > 0; });
  if (sized && plan.on("shadows")) parts.emplace_back("the shape of lamps in highlights and shadows");
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace burnish::cost
