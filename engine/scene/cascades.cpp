// Cascades of a directional light: how distances are split, and maps that stay where they are while the eye moves a little.
#include <algorithm>
#include <cmath>

#include "scene/shadows.h"

namespace burnish::scene {
namespace {

// Distances are counted in half octaves, so that splits stay while things move a little.
constexpr int kFirstBin = -40, kBins = 160;
int binOf(double distance) { return std::clamp(int(std::floor(2 * std::log2(std::max(distance, 1e-6)))) - kFirstBin, 0, kBins - 1); }
double edgeOf(int bin) { return std::exp2((bin + kFirstBin) * 0.5); }

// Six octaves before the end of a run of distances there is little left to see: those nearer share a cascade with what follows.
constexpr int kLongestRun = 12;

}  // namespace

// Equal ratios of far to near in each range keep a texel's size on the screen the same (the logarithmic scheme of Zhang, Sun, Xu and Lun 2006, "Parallel-Split Shadow Maps for Large-scale Virtual
// Environments", eq. 2), over those distances alone at which there is something (after Lauritzen, Salvi and Lefohn 2011, "Sample Distribution Shadow Maps", with boxes for pixels).
std::vector<glm::dvec2> splitDistances(std::vector<glm::dvec2> distances, double near, double most, int count) {
  std::array<bool, kBins> used{};
  for (const glm::dvec2& d : distances) {
    const double from = std::max(d.x, near), to = std::min(d.y, most);
    if (!(to >= from)) continue;
    for (int b = binOf(from); b <= binOf(to); ++b) used[std::size_t(b)] = true;
  }
  std::vector<int> bins;
  for (int b = kBins - 1, run = 0; b >= 0; --b) {
    run = used[std::size_t(b)] ? run + 1 : 0;
    if (run > 0 && run <= kLongestRun) bins.push_back(b);
  }
  if (bins.empty()) return {};
  std::reverse(bins.begin(), bins.end());
  std::vector<glm::dvec2> ranges;
  const int total = int(bins.size()), parts = std::min(count, total);
  for (int k = 0; k < parts; ++k) {
    const int first = bins[std::size_t(k * total / parts)], last = bins[std::size_t((k + 1) * total / parts - 1)];
    ranges.emplace_back(std::max(edgeOf(first), near), std::min(edgeOf(last + 1), std::max(most, near)));
  }
  // What was nearer than the longest run.
  ranges.front().x = near;
  return ranges;
}

// Each face of the box is cut to the four sides of the view (Sutherland and Hodgman 1974, "Reentrant polygon clipping"); an eye inside the box sees from the near plane on.
glm::dvec2 distancesOf(const ViewFrame& f, glm::dvec3 center, glm::dvec3 extent) {
  const glm::dvec3 middle = glm::transpose(f.axes) * center;  // right, up, back
  if (glm::all(glm::lessThanEqual(glm::abs(center), extent))) return {f.near, -middle.z + glm::dot(glm::abs(f.axes[2]), extent)};
  glm::dvec2 range(1e30, -1e30);
  for (int face = 0; face < 6; ++face) {
    const int a = face / 2, b = (a + 1) % 3, c = (a + 2) % 3;
    std::vector<glm::dvec3> polygon, cut;
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
      glm::dvec3 p(0);
      p[a] = face % 2 ? extent[a] : -extent[a];
      p[b] = corner.x * extent[b];
      p[c] = corner.y * extent[c];
      polygon.push_back(middle + glm::transpose(f.axes) * p);
    }
    for (int side = 0; side < 4; ++side) {
      const int axis = side / 2;
      const double sign = side % 2 ? 1 : -1, tangent = axis ? f.tanY : f.tanX;
      const auto inside = [&](const glm::dvec3& p) { return (f.orthographic ? tangent : -p.z * tangent) - sign * p[axis]; };
      cut.clear();
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double d = inside(p), e = inside(q);
        if (d >= 0) cut.push_back(p);
        if ((d >= 0) != (e >= 0)) cut.push_back(p + (q - p) * (d / (d - e)));
      }
      std::swap(polygon, cut);
    }
    for (const glm::dvec3& p : polygon) range = {std::min(range.x, -p.z), std::max(range.y, -p.z)};
  }
  return range;
}

glm::dvec2 boundSlice(const ViewFrame& f, glm::dvec2 range) {
  const double k2 = f.tanX * f.tanX + f.tanY * f.tanY, n = range.x, e = range.y;
  if (f.orthographic) return {(n + e) * 0.5, std::sqrt(k2 + (e - n) * (e - n) * 0.25)};
  // The sphere through the corners of both ends, unless the far end's own is larger.
  const double c = std::min((n + e) * 0.5 * (1 + k2), e);
  return {c, std::sqrt((e - c) * (e - c) + k2 * e * e)};
}

glm::dmat3 sunAxes(glm::dvec3 toLight) {
  const glm::dvec3 side = std::abs(toLight.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(side, toLight));
  return {right, glm::cross(toLight, right), toLight};
}

// The sphere's size does not depend on where the view looks, and its centre moves in steps of whole texels (Valient 2008, "Stable Rendering of Cascaded Shadow Maps"). A step is an eighth of the
// map's half side here, which the map is wider for: an eye that moves less than that leaves the map as it is.
Cascade placeCascade(const ViewFrame& frame, const glm::dmat3& axes, glm::dvec2 range, int resolution, int reach) {
  const glm::dvec2 sphere = boundSlice(frame, range);
  const double spare = 1 - 1.0 / 16 - 2.0 * reach / resolution;
  Cascade c;
  c.radius = sphere.y / std::max(spare, 0.25);
  const double texel = 2 * c.radius / resolution, step = std::max(1.0, std::floor(resolution / 16.0)) * texel;
  const glm::dvec3 at = glm::transpose(axes) * (frame.eye - frame.axes[2] * sphere.x);
  c.center = axes * (glm::floor(at / step + 0.5) * step);
  c.near = c.far = c.radius;
  return c;
}

}  // namespace burnish::scene
