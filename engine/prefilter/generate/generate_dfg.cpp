// Build step: tabulates one DFG into a C++ file. Usage: generate_dfg INDEX OUT.cpp
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "prefilter/dfg.h"
#include "reference/energy.h"

using namespace burnish;

int main(int argc, char** argv) {
  const int index = argc == 3 ? std::atoi(argv[1]) : -1;
  if (index < 0 || index >= prefilter::kDfgTables) return std::fputs("usage: generate_dfg INDEX OUT.cpp\n", stderr), 2;
  const shading::Rungs rungs = prefilter::dfgRungs(index);
  // V-cavities bend their lobe sharply where the smaller cosine begins to mask: three times the columns.
  const bool sharp = rungs.specular == SPECULAR_MICROFACET && rungs.geometry == GEOMETRY_V_CAVITY;
  const int columns = sharp ? 384 : 128, width = columns + 2, height = 160;
  std::vector<glm::dvec2> table;
  for (int j = 0; j < height; ++j) {
    const double alpha = prefilter::alphaOfRow(j / double(height - 1));
    for (int i = 0; i < columns; ++i) table.push_back(reference::lobeAlbedo(rungs, prefilter::cosineOfColumn(i / double(columns - 1)), alpha));
    table.insert(table.end(), 2, reference::lobeAlbedoMean(rungs, alpha));
  }
  double scale = 1;
  for (const glm::dvec2& e : table) scale = std::max({scale, e.x, e.y});
  std::ofstream out(argv[2]);
  out << "#include \"prefilter/dfg.h\"\n\nnamespace burnish::prefilter {\nnamespace {\nconstexpr std::uint16_t kTexels[] = {";
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (i % std::size_t(width) == 0) out << '\n';
    for (int k = 0; k < 2; ++k) out << std::lround(std::clamp(table[i][k] / scale, 0.0, 1.0) * 65535) << ',';
  }
  out << "\n};\n}  // namespace\nextern const DfgTable kDfg" << index << ";\nconst DfgTable kDfg" << index << "{" << width << ", " << height << ", float(" << scale << "), kTexels};\n}  // namespace burnish::prefilter\n";
  out.close();
  return out ? 0 : 1;
}
