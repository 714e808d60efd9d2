// The name that someone may have meant.
#pragma once
#include <span>
#include <string>
#include <string_view>

namespace burnish::core {

/// " (did you mean 'x'?)" where a name is within a third of the typed letters (two for short ones); else empty. The fewest edits win (Levenshtein 1966), the first of equals.
std::string didYouMean(std::string_view typed, std::span<const std::string_view> names);

}  // namespace burnish::core
