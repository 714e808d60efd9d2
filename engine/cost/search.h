// Which choices are worth measuring next.
#pragma once
#include <random>
#include <set>

#include "cost/model.h"

namespace burnish::cost {

/// What is wanted: a frame of at most `ratio` of the base's with the least error; or, where ratio is 0, the fastest whose error is at most `error`.
struct Goal {
  double ratio = 0, error = 0;
};

/// What decides between choices: lower is better, and below kUnfit it meets the goal.
inline constexpr double kUnfit = 1e6;
[[nodiscard]] double scoreOf(const Goal& goal, double error, double ratio);

/// How the unknown counts: Bold takes what is expected, Careful counts what is not known against a choice, Hopeful for it.
enum class Manner : std::uint8_t { Bold, Careful, Hopeful };

struct Proposal {
  Choice choice;
  Predicted predicted;
  double score = 0;
};
/// The best choices that the model knows of and that are not among `known`, best first: descents by single changes from `starts` and from changed copies of them, every choice on the way looked at.
std::vector<Proposal> propose(const Model& model, const Factors& factors, const std::vector<Choice>& starts, const Goal& goal, const std::set<Choice>& known, Manner manner, std::mt19937& random);
/// Those that differ from `center` in one factor, or in two where both are among the `most` that alone promise most; likewise sorted.
std::vector<Proposal> neighbours(const Model& model, const Factors& factors, const Choice& center, const Goal& goal, const std::set<Choice>& known, std::size_t most);

}  // namespace burnish::cost
