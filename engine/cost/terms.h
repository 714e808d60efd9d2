// Which terms a scene exercises in a view, with which rungs, and beside what they count.
#pragma once
#include <burnish/plan.h>

#include <functional>
#include <string>
#include <vector>

namespace burnish::cost {

/// One term to be measured.
struct TermToMeasure {
  std::size_t term = 0;            ///< index into terms()
  std::string calledBy;            ///< what in the scene exercises it
  std::vector<std::size_t> rungs;  ///< that apply, in the order of the enum
  std::size_t exact = 0;           ///< the rung that errors count against, one of `rungs`
  std::string setting;             ///< what of the rest is changed so that the term counts; may be empty
  std::vector<std::pair<std::string, std::string>> leftOut;  ///< rungs that do not apply, with the reason

  /// `quality` with that rung in force, and what of the rest must change so that the term counts.
  [[nodiscard]] Quality with(Quality quality, std::size_t rung) const;
};
struct TermsToMeasure {
  std::vector<TermToMeasure> terms;
  std::vector<std::pair<std::string, std::string>> idle;  ///< terms that are not measured, with the reason
};
/// `planOf`: the frame plan of a quality in this view. `only`: names of terms; empty: all.
TermsToMeasure termsToMeasure(const Scene& scene, const View& view, glm::ivec2 size, const Quality& base, const std::function<FramePlan(const Quality&)>& planOf, const std::vector<std::string>& only);

/// Names of the passes that are not the same in two plans: in one alone, or with other programs, definitions, inputs or targets.
std::vector<std::string> changedPasses(const FramePlan& a, const FramePlan& b);

/// What light the plan's renderer has no term for, for people: "light that bounces off surfaces (no probes)", ...
std::string missingLight(const Scene& scene, const FramePlan& plan);

}  // namespace burnish::cost
