// SVG to PNG through the program rsvg-convert (librsvg).
#pragma once
#include <burnish/result.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::cost {

/// The drawing at twice its size. Runs the program for at most `seconds`, then ends it. Errors: there is no such program, it failed, it took too long.
Result<std::vector<std::byte>> rasterized(std::string_view svg, const std::string& program = "rsvg-convert", double seconds = 20);

}  // namespace burnish::cost
