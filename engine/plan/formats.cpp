#include "plan/formats.h"

#include <algorithm>
#include <utility>

namespace burnish::plan {

int bytesOf(std::string_view format) {
  constexpr std::pair<std::string_view, int> kBytes[] = {{"R8", 1},       {"RG8", 2},      {"RGBA8", 4},  {"R11F_G11F_B10F", 4}, {"R16", 2},   {"RG16", 4},  {"RGBA16", 8},
                                                         {"R16F", 2},     {"RG16F", 4},    {"RGBA16F", 8}, {"R32F", 4},          {"RG32F", 8}, {"RGBA32F", 16}, {"R32UI", 4},
                                                         {"DEPTH_COMPONENT16", 2}, {"DEPTH_COMPONENT32F", 4}};
  const auto* found = std::find_if(std::begin(kBytes), std::end(kBytes), [&](const auto& f) { return f.first == format; });
  return found == std::end(kBytes) ? 0 : found->second;
}

}  // namespace burnish::plan
