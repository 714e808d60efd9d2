// Build step: tabulates the DFG of each geometry rung into a C++ file. Usage: generate_dfg OUT.cpp
#include <cmath>
#include <cstdio>
#include <fstream>

#include "prefilter/dfg.h"

using namespace burnish;

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: generate_dfg OUT.cpp\n", stderr), 2;
  std::ofstream out(argv[1]);
  out << "#include \"prefilter/dfg.h\"\n\nnamespace burnish::prefilter {\nnamespace {\n";
  const char* names[] = {"kVoid", "kKelemen"};
  for (Geometry g : {Geometry::Void, Geometry::Kelemen}) {
    out << "constexpr std::uint16_t " << names[int(g)] << "[] = {\n";
    for (int j = 0; j < prefilter::kDfgSize; ++j) {
      for (int i = 0; i < prefilter::kDfgSize; ++i) {
        const glm::dvec2 e = prefilter::integrateDfg(g, i / double(prefilter::kDfgSize - 1), j / double(prefilter::kDfgSize - 1));
        for (int k = 0; k < 2; ++k) out << std::lround(std::fmin(std::fmax(e[k], 0.0), 1.0) * 65535) << ',';
      }
      out << '\n';
    }
    out << "};\n";
  }
  out << "}  // namespace\nstd::span<const std::uint16_t> dfgTable(Geometry g) { return g == Geometry::Void ? std::span(kVoid) : std::span(kKelemen); }\n}  // namespace burnish::prefilter\n";
  out.close();
  return out ? 0 : 1;
}
