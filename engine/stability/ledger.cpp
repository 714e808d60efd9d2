// The guard ledger. The shading text is compiled once more for each guard with that guard taken out, and the energy that the rungs reflect is compared over roughness × angle.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>

#include "gl/embedded_shaders.h"
#include "plan/rungs.h"
#include "prefilter/dfg.h"
#include "reference/energy.h"
#include "reference/quadrature.h"
#include "reference/shading.h"

// NOLINTBEGIN
#undef FN
#undef GUARDED
#define FN static
#define GUARDED(number, with, without) ((number) == Off ? (without) : (with))
namespace burnish::shading::ledger {
#include "reference/shading_functions.inl"
/// The shading text in double without guard number `Off` (0: with all of them).
template <int Off>
struct Text {
  using real = double;
  using vec2 = glm::dvec2;
  using vec3 = glm::dvec3;
  using vec4 = glm::dvec4;
#include "shading/all.h"
#include "shading/tonemap.h"
};
}  // namespace burnish::shading::ledger
// NOLINTEND

namespace burnish {
namespace {

using glm::dvec2;
using glm::dvec3;
using shading::Rungs;
using shading::ledger::Text;

constexpr int kGuards = 18;

/// What is measured: a number that is energy (reflected, or received), by name.
struct Cell {
  std::string where;
  dvec3 energy;
};

constexpr double kRoughness[] = {0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1};
constexpr double kCosines[] = {1e-4, 1e-3, 0.01, 0.1, 0.3, 0.7, 1};

std::vector<Rungs> measuredRungs() {
  std::vector<Rungs> all;
  const Rungs usual = plan::rungsOf(Quality{});
  for (int i = 0; i < prefilter::kDfgTables; ++i) all.push_back(prefilter::dfgRungs(i));
  for (int i = 0; i <= LOBE_STABLE; ++i) (all.emplace_back(usual)).lobe = i;
  for (int i = 0; i <= FRESNEL_CONDUCTOR; ++i) (all.emplace_back(usual)).fresnel = i;
  for (int i = 0; i <= DIFFUSE_OREN_NAYAR_ENERGY; ++i) (all.emplace_back(usual)).diffuse = i;
  (all.emplace_back(usual)).compensation = COMPENSATION_MULTIPLE_SCATTERING;
  return all;
}

/// The lobes' albedos by quadrature (a table's rounding would hide what a guard costs). All rungs that ask for one have the default lobe.
class Energies {
 public:
  const reference::LobeEnergy& of(const Rungs& k, double alpha) {
    auto& e = energies_[alpha];
    if (!e) e = std::make_unique<reference::LobeEnergy>(k, alpha, 128);
    return *e;
  }

 private:
  std::map<double, std::unique_ptr<reference::LobeEnergy>> energies_;
};

std::string nameOf(const Rungs& k) {
  const auto rung = [](std::size_t term, int i) { return terms()[term].rungs[std::size_t(i)].name; };
  if (k.specular != SPECULAR_MICROFACET) return std::string(rung(0, k.specular));
  return fmt::format("{}, {}, {}, {}, {}{}", rung(1, k.distribution), rung(2, k.geometry), rung(4, k.lobe), rung(5, k.fresnel), rung(6, k.diffuse), k.compensation ? ", compensated" : "");
}

// One cell: F0 0.04, 0.5 and 1 in the three channels. The roughness goes through the G-buffer's code, as in the pipeline; without the guard on it, it stays.
template <int Off>
dvec3 reflected(const Rungs& k, double roughness, double nov, Energies& energies) {
  using T = Text<Off>;
  const double alpha = T::decodeAlpha(T::encodeAlpha(T::alphaFromRoughness(roughness)));
  typename T::Surface m = T::makeSurface({0, 0, 1}, reference::directionAt(nov), dvec3(0.8), 1.0 / 3, alpha);
  m.f0 = {0.04, 0.5, 1};
  m.eta = {1.5, 1, 0.2};
  m.k = {0, 2, 20};
  const reference::LobeEnergy* table = needsAlbedoTable(k) ? &energies.of(k, alpha) : nullptr;
  if (table) {
    m.dfg = table->at(nov);
    m.dfgMean = table->mean();
  }
  const auto toward = [&](const dvec3& l) { return table ? table->at(l.z) : dvec2(0); };
  static const reference::Rules kRules(reference::Resolution{24, 16});
  const auto specular = [&](const dvec3& l) {
    dvec3 d, s;
    T::shadeParts(m, l, toward(l), k, d, s);
    return s;
  };
  dvec3 sum = shading::lobeFamily(k) == LOBE_FAMILY_PHONG ? reference::integrateMirror<dvec3>(nov, alpha, specular, kRules)
                                                         : reference::integrateHalf<dvec3>(nov, alpha, specular, kRules);
  sum += reference::integrateCosine<dvec3>(
      [&](const dvec3& l) {
        dvec3 d, s;
        T::shadeParts(m, l, toward(l), k, d, s);
        return d;
      },
      kRules);
  return sum;
}

template <int Off>
std::vector<Cell> cells(Energies& energies) {
  using T = Text<Off>;
  std::vector<Cell> all;
  for (const Rungs& k : measuredRungs())
    for (const double r : kRoughness)
      for (const double nov : kCosines) all.push_back({fmt::format("{} at roughness {:g}, n.v {:g}", nameOf(k), r, nov), reflected<Off>(k, r, nov, energies)});
  // Light received, and what occlusion lets through.
  for (const double d : {0.005, 0.01, 0.1, 10.0}) {
    const double d2 = std::max(d * d, GUARDED(4, 1e-4, 0.0));
    all.push_back({fmt::format("irradiance {:g} m from a light", d), dvec3(T::distanceAttenuation(d2, 1 / d2, 0, 0) * d * d)});
  }
  for (const double ao : {0.0, 0.01, 0.5, 1.0})
    for (const double nov : {0.0, 0.01, 0.5})
      all.push_back({fmt::format("specular occlusion, ao {:g}, n.v {:g}", ao, nov), dvec3(T::specularOcclusion(nov, ao, 0.01, SPECULAR_OCCLUSION_LAGARDE))});
  return all;
}

// Inputs that only a guard keeps finite: opposite and grazing directions, alpha and F0 at their ends, a zero normal.
template <int Off>
int nonfinite() {
  using T = Text<Off>;
  int count = 0;
  const dvec3 n(0, 0, 1);
  const dvec3 directions[] = {{0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0.6, 0, 0.8}, {-0.6, 0, -0.8}, {0, 0, -1}};
  for (const Rungs& k : measuredRungs())
    for (const dvec3& v : directions)
      for (const dvec3& l : directions)
        for (const double alpha : {0.0, 1e-200, 4e-4, 1.0}) {
          typename T::Surface m = T::makeSurface(n, v, dvec3(1), 1, alpha);
          m.f0 = {0, 0.5, 1};
          m.eta = {1, 0.5, 0};
          m.k = {0, 0, 1e300};
          m.dfg = m.dfgMean = {1, 0};
          const dvec3 c = T::shadeDirection(m, l, dvec2(1, 0), k);
          count += !(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
        }
  const dvec2 zero = T::octahedralEncode(dvec3(0));
  count += !std::isfinite(zero.x);
  count += !std::isfinite(T::specularOcclusion(0, 0, 1, SPECULAR_OCCLUSION_LAGARDE));
  for (const double u : {0.0, 1.0})
    for (int family = 0; family <= LOBE_FAMILY_PHONG; ++family) count += !std::isfinite(T::sampleLobe(u, 0.3, 0.1, family).x);
  for (const double big : {1e300, -1e300}) {
    const double values[] = {T::lobeExp2(big, 0, 10), T::lobePow(0, big), T::lobeStable(1, big), T::alphaFromPower(big), T::alphaAlong(big, big, 1, 1)};
    for (const double v : values) count += !std::isfinite(v);
  }
  for (const double x : {0.0, -1.0, 1e200}) {
    const dvec3 agx = T::tonemapAgx(dvec3(x)), aces = T::tonemapAces(dvec3(x));
    count += !std::isfinite(agx.x) + !std::isfinite(aces.x);
  }
  const double d2 = std::max(0.0, GUARDED(4, 1e-4, 0.0));
  count += !std::isfinite(T::distanceAttenuation(d2, 1 / d2, 0, 0));
  return count;
}

using Measured = std::pair<std::vector<Cell>, int>;
template <int Off>
Measured measured(Energies& energies) {
  return {cells<Off>(energies), nonfinite<Off>()};
}

template <int... I>
constexpr auto tableOf(std::integer_sequence<int, I...>) {
  return std::array<Measured (*)(Energies&), sizeof...(I)>{&measured<I>...};
}

/// The declarations of constants.h: a comment, then a line with GUARDED(number, ...).
struct Declaration {
  std::string name, reason;
  double value = std::nan("");
};
std::array<Declaration, kGuards + 1> declarations() {
  std::array<Declaration, kGuards + 1> found;
  std::string_view text;
  for (const gl::EmbeddedShader& s : gl::embeddedShaders())
    if (s.name == "shading/constants.h") text = s.text;
  std::string comment;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string line(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.starts_with("// ")) {
      if (!comment.empty()) comment += ' ';
      comment += line.substr(3);
      continue;
    }
    if (const std::size_t at = line.find("GUARDED("); at != std::string::npos) {
      const int number = std::atoi(line.c_str() + at + 8);
      if (number >= 1 && number <= kGuards) {
        Declaration& d = found[std::size_t(number)];
        const bool macro = line.starts_with("#define ");
        const std::size_t from = macro ? 8 : line.find(' ', 3) + 1;
        d.name = line.substr(from, line.find_first_of(" (", from) - from);
        d.reason = comment;
        if (macro) d.value = std::atof(line.c_str() + line.find("R(") + 2);
      }
    }
    if (line.empty()) comment.clear();
  }
  return found;
}

}  // namespace

std::vector<GuardRow> guardLedger(const MeasureProgress& progress) {
  constexpr auto kTable = tableOf(std::make_integer_sequence<int, kGuards + 1>());
  const auto declared = declarations();
  Energies energies;
  if (progress) progress(0, kGuards + 1, "with every guard");
  const Measured with = kTable[0](energies);
  std::vector<GuardRow> rows;
  for (int guard = 1; guard <= kGuards; ++guard) {
    const Declaration& d = declared[std::size_t(guard)];
    if (progress) progress(guard, kGuards + 1, d.name);
    const Measured without = kTable[std::size_t(guard)](energies);
    GuardRow row{d.name, d.value, d.reason, 0, {}, 0, without.second};
    for (std::size_t i = 0; i < with.first.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const double free = without.first[i].energy[c], guarded = with.first[i].energy[c];
        if (!std::isfinite(free)) {
          ++row.nonfiniteWithout;
          break;
        }
        row.worstEnergyGain = std::max(row.worstEnergyGain, (guarded - free) / std::max(guarded, 1e-6));
        if (const double loss = (free - guarded) / std::max(free, 1e-6); loss > row.worstEnergyLoss + 1e-12) {
          row.worstEnergyLoss = loss;
          row.where = fmt::format("{} (F0 {})", with.first[i].where, c == 0 ? "0.04" : c == 1 ? "0.5" : "1");
        }
      }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace burnish
