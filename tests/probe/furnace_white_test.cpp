// H29 of docs/hard_cases.md: a white furnace from end to end. White surroundings are captured and prefiltered, and light balls through a probe's box and the quantised G-buffer: each pixel shows the
// directional albedo of its rungs, by quadrature in double.
#include <map>

#include "plan/rungs.h"
#include "probe/probes.h"
#include "reference/oracle.h"

using namespace burnish;
using namespace burnish::test;
namespace f64 = burnish::shading::f64;

namespace {

constexpr float kWhite = 700;  // cd/m²
constexpr int kCell = 32;      // pixels a ball
constexpr double kBound = 0.02;
constexpr std::uint32_t kRings = 96, kColumns = 160;

struct Paint {
  double substance, albedo;
};
const std::vector<Paint> kPaints = {{0, 1}, {1 / 3.0, 1}, {0.4, 1}, {1, 1}, {0, 0.5}, {1 / 3.0, 0.5}, {0.4, 0.2}, {0.7, 0.5}, {1, 0.5}, {1 / 3.0, 0.05}};
const std::vector<double> kRoughness = {0.05, 0.2, 0.4, 0.6, 0.8, 1};

/// The half of a ball of radius 1 that faces +z, and a little more.
Mesh halfBall() {
  Mesh m;
  for (std::uint32_t r = 0; r <= kRings + 2; ++r)
    for (std::uint32_t c = 0; c <= kColumns; ++c) {
      const double t = kPi / 2 * r / kRings, p = 2 * kPi * c / kColumns;
      m.positions.emplace_back(vec3(dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t))));
    }
  m.normals = m.positions;
  for (std::uint32_t r = 0; r < kRings + 2; ++r)
    for (std::uint32_t c = 0; c < kColumns; ++c) {
      const std::uint32_t a = r * (kColumns + 1) + c, b = a + kColumns + 1;
      m.indices.insert(m.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  return m;
}
/// By how much a chord of the mesh lies inside the ball.
const double kSagitta = 2 - std::cos(kPi / 4 / kRings) - std::cos(kPi / kColumns);

/// What a unit of light from everywhere shows at n·v, by the rungs in force: lobes and diffuse light by quadrature; where the surroundings' rung is no integral of the lobe, its formula.
double albedoAt(const Paint& paint, double roughness, double nov, const Quality& q, const shading::Rungs& rungs, const reference::LobeEnergy* energy) {
  reference::OracleSurface s;
  s.v = reference::directionAt(std::max(nov, 1e-4));
  s.albedo = dvec3(paint.albedo);
  s.substance = paint.substance;
  s.alpha = roughness * roughness;
  const reference::DirectionalAlbedo sum = reference::directionalAlbedo(s, rungs, {40, 32}, energy);
  if (q.environmentSpecular == EnvironmentSpecular::Dfg || q.environmentSpecular == EnvironmentSpecular::Sampled) return sum.specular.x + sum.diffuse.x;
  const double f0 = f64::substanceF0(paint.substance, dvec3(paint.albedo)).x, weight = std::pow(1 - nov, 5);
  CHECK(q.environmentSpecular == EnvironmentSpecular::Schlick);
  return f0 + (1 - f0) * weight + sum.diffuse.x;
}

ProbeSet capturedWhite(vec3 low, vec3 high) {
  Scene white;
  white.environment.color = vec3(kWhite);
  ProbeSet places;
  // Off the middle of the box: lookups are re-aimed.
  places.reflections.push_back(probeIn(low, high, dvec3(low) * 0.7 + dvec3(high) * 0.3));
  Observatory o(std::move(white));
  BakeOptions options;
  options.size = 32;
  options.bounces = 1;
  Bake bake;
  bake.run(o, places, options);
  return bake.set;
}

struct Result29 {
  double worst = 0, unity = 0;  // relative errors, of the albedo and of 1 where all comes back
  std::size_t pixels = 0, off = 0;  // off: by more than 2 %
  std::string where;
};

Result29 furnace(const ProbeSet& probes, const Quality& q, bool unity) {
  const int columns = int(kPaints.size()), rows = int(kRoughness.size());
  Scene scene;
  scene.environment.color = vec3(kWhite / 10);  // what gets past the box shows
  const Id<Mesh> ball = scene.meshes.add(halfBall());
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      Material m;
      m.albedo = vec3(float(kPaints[std::size_t(column)].albedo));
      m.substance = float(kPaints[std::size_t(column)].substance);
      m.roughness = float(kRoughness[std::size_t(row)]);
      Instance i;
      i.mesh = ball;
      i.material = scene.materials.add(m);
      i.node = addNode(scene, translation({2.0 * column + 1, 2.0 * row + 1, 0}));
      scene.instances.add(i);
    }
  scene.probes = probes;
  View view = lookAt({double(columns), double(rows), 5}, {double(columns), double(rows), 0});
  view.orthographic = true;
  view.height = float(2 * rows);
  view.far = 10;
  Stage stage;
  const Picture p = stage.linear(scene, view, {kCell * columns, kCell * rows}, q);
  const shading::Rungs rungs = plan::rungsOf(q);
  Result29 result;
  for (int row = 0; row < rows; ++row) {
    const double roughness = kRoughness[std::size_t(row)];
    const reference::LobeEnergy energy(rungs, roughness * roughness, 96);
    for (int column = 0; column < columns; ++column) {
      constexpr int kNodes = 33;
      std::array<double, kNodes> table;  // over the root of n·v
      for (int i = 0; i < kNodes; ++i) table[std::size_t(i)] = albedoAt(kPaints[std::size_t(column)], roughness, std::pow(double(i) / (kNodes - 1), 2), q, rungs, &energy);
      const auto at = [&](double nov) {
        const double x = std::sqrt(std::max(nov, 0.0)) * (kNodes - 1);
        const int i = std::min(int(x), kNodes - 2);
        return glm::mix(table[std::size_t(i)], table[std::size_t(i + 1)], x - i);
      };
      for (int y = 0; y < kCell; ++y)
        for (int x = 0; x < kCell; ++x) {
          const double u = (2.0 * x + 1) / kCell - 1, v = (2.0 * y + 1) / kCell - 1, r2 = u * u + v * v;
          // The normal of a chord is that of the ball up to a sagitta farther out.
          const double outer = r2 * (1 + 2 * kSagitta);
          if (outer >= 1) continue;
          const double low = at(std::sqrt(1 - outer)), high = at(std::sqrt(1 - r2)), shown = p.at(column * kCell + x, (rows - 1 - row) * kCell + y).x / double(kWhite);
          const double error = shown < std::min(low, high) ? shown / std::min(low, high) - 1 : shown > std::max(low, high) ? shown / std::max(low, high) - 1 : 0;
          ++result.pixels;
          result.off += std::abs(error) > kBound;
          if (std::abs(error) > std::abs(result.worst)) {
            result.worst = error;
            result.where = fmt::format("substance {:.2f}, albedo {}, roughness {}, n.v {:.3f}", kPaints[std::size_t(column)].substance, kPaints[std::size_t(column)].albedo, roughness, std::sqrt(1 - r2));
          }
          const double substance = kPaints[std::size_t(column)].substance;
          if (unity && kPaints[std::size_t(column)].albedo == 1 && (substance <= 0.4 || substance == 1) && std::abs(shown - 1) > std::abs(result.unity)) result.unity = shown - 1;
        }
    }
  }
  return result;
}

void check(const char* name, const Quality& q, bool unity = false, double sampling = 0) {
  const vec3 low(-1, -2, -3), high(2 * float(kPaints.size()) + 2, 2 * float(kRoughness.size()) + 1, 4);
  const Result29 r = furnace(capturedWhite(low, high), q, unity);
  std::cout << fmt::format("  white furnace, {}: {} pixels within {:+.2f} % of their albedo ({}), {} by more than 2 %{}\n", name, r.pixels, 100 * r.worst, r.where, r.off, unity ? fmt::format(", white ones within {:+.2f} % of 1", 100 * r.unity) : "");
  CHECK(r.pixels > 40000);
  CHECK(std::abs(r.worst) < kBound + sampling);
  CHECK(std::abs(r.unity) < kBound);
  CHECK(double(r.off) <= (sampling > 0 ? 0.005 : 0) * double(r.pixels));
}

}  // namespace

TEST_CASE("white furnace: through capture, filter, box and G-buffer, the default preset", "[h29]") { check("default", Quality{}); }

TEST_CASE("white furnace: with compensation and coupled diffuse nothing is lost", "[h29]") {
  Quality q;
  q.compensation = Compensation::MultipleScattering;
  q.diffuse = Diffuse::Coupled;
  check("compensated", q, true);
}

TEST_CASE("white furnace: the seed preset", "[h29][sweep]") {
  Quality q;
  REQUIRE(setPreset(q, "seed"));
  check("seed", q);
}

TEST_CASE("white furnace: the exact preset", "[h29][sweep]") {
  Quality q;
  REQUIRE(setPreset(q, "exact"));
  // The lobe is summed over 256 samples. Toward grazing, where some of them fall below the horizon, their number is off by a standard error of 1/sqrt(256) of its spread: held at that here.
  check("exact", q, false, 1 / 16.0 - kBound);
}
