// One expression of the shading text, evaluated in GLSL, in float and in double, and the table of such expressions: what rungs_test.cpp compares and
// adversarial_test.cpp bounds.
#pragma once
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "stability/case_text.h"
#include "stability/shader_cases.h"

namespace burnish::test {

using Case = stability::ShaderCase;
using Random = std::mt19937;

/// `glsl` may name `rungs` and `rung`; the functions take them.
struct Text {
  using Function = glm::dvec4 (*)(const Case&, const shading::Rungs& rungs, int rung);
  const char* glsl;
  Function inFloat, inDouble;
};

#define TEXT_IN(precision, ...)                                                                            \
  [](const Case& in, [[maybe_unused]] const shading::Rungs& rungs, [[maybe_unused]] int rung) {            \
    using namespace burnish::shading::precision;                                                           \
    [[maybe_unused]] const vec4 a(in[0]), b(in[1]), c(in[2]), d(in[3]), e(in[4]), f(in[5]);                \
    return glm::dvec4(__VA_ARGS__);                                                                        \
  }
/// The expression of a, b, c, d, e, f (vec4), rungs and rung, in all three. No swizzles, numbers as R(0.5): see shading/bridge.h.
#define TEXT(...) \
  Text { #__VA_ARGS__, TEXT_IN(f32, __VA_ARGS__), TEXT_IN(f64, __VA_ARGS__) }

/// What a function accepts. `ordinary`: where its result is well conditioned and the pipeline works; `adverse`: all that its header allows, with what is apt to break it.
struct Domain {
  std::string name;
  std::function<Case(Random&)> ordinary, adverse;
};

struct Range {
  double lo = 0, hi = 0;
};
using Ranges = std::array<Range, 4>;

struct Row;
/// By what an error in one of the four outputs is divided.
struct Scale {
  const char* unit;
  std::function<double(const Row&, const Case&, const glm::dvec4& exact, int output)> of;
};

/// Of errors, in the scale's unit. Drivers approximate pow, exp2, log2, sin, cos and acos: float in C++ may be held to less.
struct Bound {
  double glsl, inFloat;
  Bound(double both) : glsl(both), inFloat(both) {}  // NOLINT(google-explicit-constructor): a number in the table
  Bound(double onGpu, double onCpu) : glsl(onGpu), inFloat(onCpu) {}
};

struct Row {
  std::string name;
  std::vector<std::string> covers;  ///< "fresnel=schlick": rungs of terms() that fail without this row
  const Domain* domain;
  Text text;
  shading::Rungs rungs;
  int rung;
  Scale scale;
  Bound bound;  ///< against double on ordinary cases: three to six times what Mesa 22.3 and libm measure, unless a reason is named
  std::function<Ranges(const Row&, const Case&)> ranges;  ///< proven from the formula, on adverse cases
  [[nodiscard]] std::string glsl() const;
};

/// Every function and rung.
const std::vector<Row>& rows();

// The parts of the table.
void addConversions(std::vector<Row>& rows);
void addLobes(std::vector<Row>& rows);
void addFresnel(std::vector<Row>& rows);
void addDiffuse(std::vector<Row>& rows);
void addSpecular(std::vector<Row>& rows);
void addSurroundings(std::vector<Row>& rows);
void addSampling(std::vector<Row>& rows);

/// "fresnel=schlick" by numbers.
std::string rungName(std::string_view term, int rung);

// Scales.
Scale absolute();
Scale relative();  ///< to the exact value
Scale ulp();       ///< 2^-23 of the exact value

// Ranges that no input moves.
std::function<Ranges(const Row&, const Case&)> within(double lo, double hi);
std::function<Ranges(const Row&, const Case&)> ranges(Range x, Range y = {}, Range z = {}, Range w = {});

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace burnish::test
