// LobeTable: the DFG tables in float.
#include <algorithm>
#include <cmath>

#include "pathtrace/bsdf.h"

namespace burnish::pathtrace {

namespace f32 = shading::f32;

LobeTable::LobeTable(const shading::Rungs& rungs) : rungs_(rungs), table_(prefilter::dfgTable(prefilter::dfgIndex(rungs))) {}

LobeTable::Row LobeTable::row(float alpha) const {
  const float y = std::clamp(f32::dfgRow(alpha), 0.0f, 1.0f) * float(table_.height - 1);
  const int top = std::min(int(y), table_.height - 1), next = std::min(top + 1, table_.height - 1);
  const std::size_t width = std::size_t(table_.width);
  return {std::size_t(top) * width, std::size_t(next) * width, y - float(top), table_.scale / 65535 * f32::dfgScale(f32::powerFromAlpha(alpha), rungs_)};
}

glm::vec2 LobeTable::column(const Row& row, std::size_t x) const { return glm::mix(texel(row.top + x), texel(row.next + x), row.share); }

glm::vec2 LobeTable::at(const Row& row, float cosine) const {
  const float x = std::clamp(f32::dfgColumn(cosine), 0.0f, 1.0f) * float(table_.width - 3);
  const std::size_t left = std::size_t(x), right = std::min(left + 1, std::size_t(table_.width - 3));
  return glm::mix(column(row, left), column(row, right), x - float(left)) * row.scale;
}

glm::vec2 LobeTable::mean(const Row& row) const { return column(row, std::size_t(table_.width - 1)) * row.scale; }

}  // namespace burnish::pathtrace
