// The effects: one row each, in the order in which they are judged. The list is all that there is: a row that is taken off (PlanOptions::removed) is as if it had never been written.
#pragma once
#include "plan/situation.h"

namespace burnish::plan {

struct Verdict {
  bool on = false;
  std::string reason;  ///< why it is on, or what would call for it
  int objects = 0;     ///< EffectPlan::objects
};
struct EffectRow {
  EffectInfo info;
  /// Looks at the situation and at the effects judged before it.
  Verdict (*judge)(const Situation&);
  /// It reads the light buffer, or adds to what is in it: there must be one while the effect is on. False: lighting may write what the display takes straight into the target.
  bool needsLightBuffer = true;
};
std::span<const EffectRow> effectRows();

/// On when the scene calls in view; off it says who would call: something out of view, or `otherwise`.
Verdict sceneCalls(const Situation& s, Call call, std::string_view otherwise);
/// Turns a verdict off where a setting does not want it.
Verdict provided(Verdict verdict, bool wanted, std::string_view unwanted);
/// Fills Situation::effects.
void judgeEffects(Situation& s);

}  // namespace burnish::plan
