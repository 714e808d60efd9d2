// Measuring the engine on this machine: the hard cases with their bounds, and what each guard of the shading text costs in energy.
#pragma once
#include <burnish/context.h>
#include <burnish/result.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace burnish {

/// One hard case on one backend: it holds when `value` is finite and at most `bound`. Bounds come from the double-precision oracle or from geometry.
struct StabilityCase {
  std::string id;       ///< "H12", as docs/hard_cases.md numbers them
  std::string what;     ///< one line, with the unit of value and bound
  std::string backend;  ///< "double", "float" (the shading text as C++), or the OpenGL backend's name
  double value = 0, bound = 0;
  bool pass = false;
  std::string note;     ///< where the value was found, or the error; may be empty
};

/// One guard (epsilon, clamp, saturate) of the shading text.
struct GuardRow {
  std::string name;             ///< as shaders/shading/constants.h declares it
  double value = 0;             ///< NaN where the guard is a clamp to [0, 1] or the like
  std::string reason;
  double worstEnergyLoss = 0;   ///< largest share of the reflected energy that it takes away, over rungs × roughness × angle; 0.01 is 1 %
  std::string where;            ///< where that is: rung, roughness, n·v; empty: it changes nothing there
  double worstEnergyGain = 0;   ///< likewise, what it adds
  int nonfiniteWithout = 0;     ///< cells of the same grid, and adversarial inputs, that are not finite without the guard
};

/// Called before each case with how many are done, of how many.
using MeasureProgress = std::function<void(int done, int total, std::string_view what)>;

/// The hard cases of the shading text as C++, in double and in float. No OpenGL. Some seconds.
BURNISH_API std::vector<StabilityCase> stabilityOnCpu(const MeasureProgress& progress = {});
/// The hard cases on the current context: the shading text as GLSL, and pictures through the renderer. `backend`: the name for the rows. Errors of OpenGL itself are rows that fail.
BURNISH_API std::vector<StabilityCase> stabilityOnGpu(const ProcAddress& getProcAddress, std::string_view backend, const MeasureProgress& progress = {});
/// The guard ledger: each guard taken out by itself, in double. No OpenGL. Some seconds.
BURNISH_API std::vector<GuardRow> guardLedger(const MeasureProgress& progress = {});

}  // namespace burnish
