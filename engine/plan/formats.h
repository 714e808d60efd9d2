// Bytes of a texel of the formats that targets have; gl/formats.h has the same numbers for GL's enums (a test compares them).
#pragma once
#include <string_view>

namespace burnish::plan {
/// `format`: GL's name without the prefix, as TargetPlan has it. 0: unknown.
int bytesOf(std::string_view format);
}  // namespace burnish::plan
