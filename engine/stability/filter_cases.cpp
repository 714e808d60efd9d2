// The hard cases of filtering surroundings, and of lattices, on the CPU.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <random>

#include "prefilter/filter.h"
#include "stability/cases.h"
#include "stability/disc.h"
#include "stability/two_rooms.h"

namespace burnish::stability {
namespace {

using glm::dvec3;

constexpr ReflectionLobe kLobes[] = {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx};
std::string named(ReflectionLobe lobe) { return lobe == ReflectionLobe::Ggx ? "GGX" : "Blinn-Phong"; }

template <class F>
CubeLevel painted(int size, const F& radiance) {
  CubeLevel level{size, 0, {}};
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const dvec3 c = radiance(centreOf(size, face, x, y));
        for (int k = 0; k < 3; ++k) level.texels.push_back(float(c[k]));
      }
  return level;
}

// H7: a lobe makes a smaller slope of a slope, the same everywhere.
Finding seams() {
  const CubeLevel source = painted(64, [](const dvec3& d) { return 1.0 + 0.9 * d; });
  Finding worst;
  for (const ReflectionLobe lobe : kLobes) {
    const auto cube = prefilterCubemap(source, {.lobe = lobe, .size = 64});
    if (!cube) return {std::nan(""), cube.error().message()};
    for (const CubeLevel& level : cube->levels) worst.worse(std::abs(seamRatio(level) - 1), fmt::format("{}, level of {} x {}", named(lobe), level.size, level.size));
  }
  return worst;
}

CubeLevel noise(int size) {
  std::mt19937 random(8);
  return painted(size, [&](const dvec3&) { return dvec3(double(random() % 100), double(random() % 10), 1); });
}
// H8 at roughness 0.
Finding untouched() {
  const CubeLevel source = noise(32);
  Finding differ;
  for (const ReflectionLobe lobe : kLobes) {
    const auto cube = prefilterCubemap(source, {.lobe = lobe, .size = 32});
    if (!cube) return {std::nan(""), cube.error().message()};
    for (std::size_t i = 0; i < source.texels.size(); ++i) differ.value += cube->levels[0].texels[i] != source.texels[i];
  }
  return differ;
}
// At 1/255 Blinn-Phong's lobe is narrower than a texel: its own light alone.
Finding nearest() {
  const CubeLevel source = noise(32);
  const auto from = prefilter::makeSource(source, 1);
  const prefilter::LevelSpec spec{32, 1 / 255.0};
  const auto levels = prefilter::filterLevels(*from, {&spec, 1}, {});
  Finding worst;
  for (std::size_t i = 0; i < source.texels.size(); ++i) worst.worse(std::abs(double(levels[0].texels[i]) - double(source.texels[i])) / 99, {});
  return worst;
}

/// The largest rms error of a level against sums in double over every texel of the source.
Finding against(const CubeLevel& source, const std::string& name) {
  Finding worst;
  for (const ReflectionLobe lobe : kLobes) {
    const auto cube = prefilterCubemap(source, {.lobe = lobe, .size = source.size, .levels = 5});
    if (!cube) return {std::nan(""), cube.error().message()};
    const auto check = checkPrefilter(source, *cube, {.samples = 24});
    if (!check) return {std::nan(""), check.error().message()};
    for (const PrefilterCheck::Level& level : check->levels) worst.worse(level.rms, fmt::format("{}{}, roughness {:.2f}", name, named(lobe), level.roughness));
  }
  return worst;
}
// H9: a texel far over the rest keeps its energy and leaves the rest alone.
Finding brightTexels() {
  Finding worst;
  for (const double value : {1e5, 65504.0, 1e30}) {
    CubeLevel source = painted(32, [](const dvec3&) { return dvec3(1); });
    for (std::size_t c = 0; c < 3; ++c) source.texels[3 * Texel{4, 17, 9}.index(32) + c] = float(value);
    const Finding found = against(source, fmt::format("{:g}, ", value));
    worst.worse(found.value, found.where);
  }
  return worst;
}
Finding badTexels() {
  Finding taken;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0f}) {
    CubeLevel source = painted(16, [](const dvec3&) { return dvec3(1); });
    source.texels[3 * Texel{4, 7, 9}.index(16) + 1] = bad;
    const auto cube = prefilterCubemap(source, {.size = 16});
    const bool named = !cube && cube.error().message().find("column 7") != std::string::npos && cube.error().message().find("row 9") != std::string::npos;
    if (!named && taken.value++ == 0) taken.where = cube ? fmt::format("{} is filtered", bad) : cube.error().message();
  }
  return taken;
}

// H10: what de-ringing keeps: the mean over the sphere.
Finding keptMean() {
  const dvec3 sun = glm::normalize(dvec3(0.4, 0.8, -0.3));
  const CubeLevel source = painted(32, [&](const dvec3& d) { return dvec3(glm::dot(d, sun) > std::cos(0.08) ? 100 : 0.001); });
  const auto plain = irradianceSh(source), quiet = irradianceSh(source, true);
  if (!plain || !quiet) return {std::nan(""), "no harmonics"};
  Finding off{std::abs((*quiet)[0][0] / (*plain)[0][0] - 1), {}};
  if (!((*quiet)[2][0] != (*plain)[2][0])) return {std::nan(""), "nothing was taken off the bands"};
  return off;
}

// H27: texels of a disc of 0.53 degrees are lights of their own; every texel of every level holds the sum of their analytic highlights.
Finding discLevels() {
  Disc disc;
  disc.centre = glm::normalize(dvec3(1, 0.3, -0.97));  // beside the edge of +X and -Z
  const CubeLevel source = discCube(128, disc);
  Finding worst;
  for (const ReflectionLobe lobe : kLobes) {
    const auto cube = prefilterCubemap(source, {.lobe = lobe, .size = 128});
    if (!cube) return {std::nan(""), cube.error().message()};
    for (std::size_t k = 1; k < cube->levels.size(); ++k) {
      const CubeLevel& level = cube->levels[k];
      std::vector<DiscProfile> lights;
      for (int face = 0; face < 6; ++face)
        for (int y = 0; y < 128; ++y)
          for (int x = 0; x < 128; ++x) {
            const float light = source.texels[3 * Texel{face, x, y}.index(128)];
            if (!(light > 0)) continue;
            Disc one{centreOf(128, face, x, y), 1e-4, 0};
            one.radiance = double(light) * texelSolidAngle(128, x, y) / one.solidAngle();
            lights.emplace_back(one, lobe, level.roughness);
          }
      const double peak = DiscProfile(disc, lobe, level.roughness).peak();
      for (int face = 0; face < 6; ++face)
        for (int y = 0; y < level.size; ++y)
          for (int x = 0; x < level.size; ++x) {
            double truth = 0;
            for (const DiscProfile& light : lights) truth += light.ofPoint(centreOf(level.size, face, x, y));
            worst.worse(std::abs(double(level.texels[3 * Texel{face, x, y}.index(level.size)]) - truth) / peak, fmt::format("{}, roughness {:.2f}", named(lobe), level.roughness));
          }
    }
  }
  return worst;
}

// H11: what the lattice says of the dark room's surfaces, by the shading text in double.
struct Leaks {
  double mean = 0, worst = 0;
};
Leaks leaks() {
  Leaks found;
  int which = 0, count = 0;
  for (const double thickness : {0.02, 0.2})
    for (const double offset : {0.0, 0.13}) {
      const TwoRooms rooms{which++ % 3, thickness, glm::dmat3(1)};
      const AmbientGrid grid = latticeOver(rooms, offset, 0);
      const GridSampler sampler(grid);
      onSurfaces(rooms, thickness, 24, [&](const dvec3& p, const dvec3& n) {
        const GridLight l = sampler.at(p, n);
        found.mean += l.light.x * l.share;
        if (!(l.light.x * l.share <= found.worst)) found.worst = l.light.x * l.share;
        ++count;
      });
    }
  found.mean /= count;
  return found;
}

}  // namespace

std::vector<OracleCase> filterOracleCases() {
  return {{"H7", "steps across the edges of prefiltered levels over those inside faces: off 1", 0.02, seams},
          {"H8", "prefiltered level of roughness 0: values that are not the source's", 0, untouched},
          {"H8", "level of roughness 1/255: off the source's texels, share of the largest", 1e-5, nearest},
          {"H8", "levels up to roughness 1 of noise against the sum in double over every texel: rms", 1e-4, [] { return against(noise(32), {}); }},
          {"H9", "one texel of 1e5, 65504 and 1e30 in a sky of 1, prefiltered, against the sum in double: rms", 1e-4, brightTexels},
          {"H9", "a texel that is NaN, infinite or negative: filtered, or not named by column and row", 0, badTexels},
          {"H10", "harmonics of one bright direction, de-ringed: mean over the sphere off what it was, share", 1e-12, keptMean},
          {"H11", "wall of 2 and 20 cm between a lit and a dark room under one lattice: leak, mean of the dark walls, share of the lit", 1e-3, [] { return Finding{leaks().mean, {}}; }, true},
          {"H11", "the same: the brightest place of the dark walls", 0.01, [] { return Finding{leaks().worst, {}}; }, true},
          {"H27", "a disc of 0.53 degrees in prefiltered levels against the analytic light's highlight: share of the peak", 1e-3, discLevels}};
}

}  // namespace burnish::stability
