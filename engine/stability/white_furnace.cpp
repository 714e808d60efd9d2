#include "stability/white_furnace.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "plan/rungs.h"
#include "reference/oracle.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

namespace f64 = shading::f64;
using glm::dvec3;
using glm::vec3;

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kRings = 96, kColumns = 160;

/// What a unit of light from everywhere shows at n·v, by the rungs in force: lobes and diffuse light by quadrature; where the surroundings' rung is no integral of the lobe, Schlick's formula.
double albedoAt(const FurnacePaint& paint, double roughness, double nov, const Quality& q, const shading::Rungs& rungs, const reference::LobeEnergy* energy) {
  reference::OracleSurface s;
  s.v = reference::directionAt(std::max(nov, 1e-4));
  s.albedo = dvec3(paint.albedo);
  s.substance = paint.substance;
  s.alpha = roughness * roughness;
  const reference::DirectionalAlbedo sum = reference::directionalAlbedo(s, rungs, {40, 32}, energy);
  if (q.environmentSpecular == EnvironmentSpecular::Dfg || q.environmentSpecular == EnvironmentSpecular::Sampled) return sum.specular.x + sum.diffuse.x;
  const double f0 = f64::substanceF0(paint.substance, dvec3(paint.albedo)).x;
  return f0 + (1 - f0) * std::pow(1 - nov, 5) + sum.diffuse.x;
}

/// albedoAt over the root of n·v.
class AlbedoTable {
 public:
  AlbedoTable(const FurnacePaint& paint, double roughness, const Quality& q, const shading::Rungs& rungs, const reference::LobeEnergy* energy) {
    for (int i = 0; i < kNodes; ++i) table_[std::size_t(i)] = albedoAt(paint, roughness, std::pow(double(i) / (kNodes - 1), 2), q, rungs, energy);
  }
  [[nodiscard]] double at(double nov) const {
    const double x = std::sqrt(std::max(nov, 0.0)) * (kNodes - 1);
    const int i = std::min(int(x), kNodes - 2);
    return glm::mix(table_[std::size_t(i)], table_[std::size_t(i + 1)], x - i);
  }

 private:
  static constexpr int kNodes = 33;
  std::array<double, kNodes> table_{};
};

}  // namespace

Result<FurnaceFound> whiteFurnace(const DrawLinear& draw, const FurnaceRow& row, const Quality& quality, const std::function<void(Scene&)>& light) {
  const int columns = int(row.paints.size()), rows = int(row.roughness.size());
  Scene scene;
  const Id<Mesh> ball = scene.meshes.add(halfBall(kRings, kColumns));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      Material m;
      m.albedo = vec3(float(row.paints[std::size_t(c)].albedo));
      m.substance = float(row.paints[std::size_t(c)].substance);
      m.roughness = float(row.roughness[std::size_t(r)]);
      Node node;
      node.local = translation({2.0 * c + 1, 2.0 * r + 1, 0});
      Instance i;
      i.mesh = ball;
      i.material = scene.materials.add(m);
      i.node = scene.nodes.add(node);
      scene.instances.add(i);
    }
  light(scene);
  View view = lookAt({double(columns), double(rows), 5}, {double(columns), double(rows), 0});
  view.orthographic = true;
  view.height = float(2 * rows);
  view.far = 10;
  auto image = draw(scene, view, {row.cell * columns, row.cell * rows}, quality);
  if (!image) return fail(image.error());
  const Picture p{std::move(*image), 0};
  const shading::Rungs rungs = plan::rungsOf(quality);
  // By how much a chord of the mesh lies inside the ball: its normal is that of the ball up to that much farther out.
  const double sagitta = 2 - std::cos(kPi / 4 / kRings) - std::cos(kPi / kColumns);
  FurnaceFound found;
  for (int r = 0; r < rows; ++r) {
    const double roughness = row.roughness[std::size_t(r)];
    std::optional<reference::LobeEnergy> energy;
    if (needsAlbedoTable(rungs)) energy.emplace(rungs, roughness * roughness, 96);
    for (int c = 0; c < columns; ++c) {
      const FurnacePaint& paint = row.paints[std::size_t(c)];
      const AlbedoTable table(paint, roughness, quality, rungs, energy ? &*energy : nullptr);
      for (int y = 0; y < row.cell; ++y)
        for (int x = 0; x < row.cell; ++x) {
          const double u = (2.0 * x + 1) / row.cell - 1, v = (2.0 * y + 1) / row.cell - 1, r2 = u * u + v * v, outer = r2 * (1 + 2 * sagitta);
          if (outer >= 1) continue;
          const double low = table.at(std::sqrt(1 - outer)), high = table.at(std::sqrt(1 - r2)), shown = p.at(c * row.cell + x, (rows - 1 - r) * row.cell + y).x / row.white;
          const double least = std::min(low, high), most = std::max(low, high), error = shown < least ? shown / least - 1 : !(shown <= most) ? shown / most - 1 : 0;
          ++found.pixels;
          found.off += !(std::abs(error) <= 0.02);
          if (!(std::abs(error) <= std::abs(found.worst))) {
            found.worst = error;
            found.where = fmt::format("substance {:.2f}, albedo {}, roughness {}, n.v {:.3f}", paint.substance, paint.albedo, roughness, std::sqrt(1 - r2));
          }
          if (paint.albedo == 1 && (paint.substance <= 0.4 || paint.substance == 1) && !(std::abs(shown - 1) <= std::abs(found.unity))) found.unity = shown - 1;
        }
    }
  }
  return found;
}

}  // namespace burnish::stability
