// The hard cases of surroundings on the GPU: cubes filtered there, a light's reflection, bad texels, light that places bring.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "gl/host_state.h"
#include "gpu_scene/cube_filter.h"
#include "stability/cases.h"
#include "stability/reflected_disc.h"
#include "stability/rooms.h"
#include "stability/scenes.h"
#include "stability/two_rooms.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

Result<gl::Texture> cubeTexture(gl::Device& device, int size, int levels) {
  return gl::Texture::create(device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = size, .height = size, .levels = levels}, "filtered");
}
CubeLevel readBack(const gl::Texture& texture, int level) {
  const int size = texture.width >> level;
  CubeLevel cube{size, 0, std::vector<float>(18 * std::size_t(size) * std::size_t(size))};
  texture.read(level, std::as_writable_bytes(std::span(cube.texels)), GL_RGB, GL_FLOAT);
  return cube;
}

/// Filters radiance(direction) on the GPU into `levels` levels and hands out the first as stored and all as filtered.
template <class F>
Result<std::vector<CubeLevel>> filtered(Studio& studio, int size, int levels, CubeLevel& source, const F& radiance) {
  gl::setDefaults(studio.device);
  source = {size, 0, {}};
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const dvec3 c = radiance(centreOf(size, face, x, y));
        for (int k = 0; k < 3; ++k) source.texels.push_back(float(c[k]));
      }
  auto from = cubeTexture(studio.device, size, 1), to = cubeTexture(studio.device, size, levels);
  if (!from || !to) return fail(from ? to.error() : from.error());
  for (int face = 0; face < 6; ++face) from->upload(0, source.texels.data() + 3 * std::size_t(face * size * size), face, GL_RGB, GL_FLOAT);
  source = readBack(*from, 0);
  gpu_scene::CubeFilter filter(studio.device, studio.programs);
  if (auto done = filter.filter(*from, *to); !done) return fail(done.error());
  std::vector<CubeLevel> all;
  for (int k = 0; k < levels; ++k) {
    all.push_back(readBack(*to, k));
    all.back().roughness = shading::f64::environmentRoughness(double(k), double(levels - 1));
  }
  return all;
}

Result<Finding> seams(Studio& studio) {
  CubeLevel source;
  const auto levels = filtered(studio, 64, 4, source, [](const dvec3& d) { return 1.0 + 0.9 * d; });
  if (!levels) return fail(levels.error());
  Finding worst;
  for (const CubeLevel& level : *levels) worst.worse(std::abs(seamRatio(level) - 1), fmt::format("level of {} x {}", level.size, level.size));
  return worst;
}

/// A sun beside an edge, another in a corner, and a smooth sky.
dvec3 sunny(const dvec3& d) {
  const auto sun = [&](const dvec3& at) { return glm::dot(d, glm::normalize(at)) > std::cos(0.04) ? 6e4 : 1.0; };
  return {1 + 0.5 * d.x + 0.3 * d.y * d.z, sun({1, 0.21, 0.995}), sun({-1, 1, 1})};
}
// H8: level 0 is the source, bit by bit.
Result<Finding> untouched(Studio& studio) {
  CubeLevel source;
  const auto levels = filtered(studio, 32, 3, source, sunny);
  if (!levels) return fail(levels.error());
  Finding differ;
  for (std::size_t i = 0; i < source.texels.size(); ++i) differ.value += (*levels)[0].texels[i] != source.texels[i];
  return differ;
}
// Half floats round by 2e-4; lobes that the horizon cuts off while they are high have a kink there, which a sun that stands on it shows (docs/prefilter_gpu.md).
Result<Finding> summed(Studio& studio) {
  CubeLevel source;
  const auto levels = filtered(studio, 32, 3, source, sunny);
  if (!levels) return fail(levels.error());
  Finding worst;
  for (std::size_t k = 1; k < levels->size(); ++k) {
    const CubeLevel& level = (*levels)[k];
    dvec3 square(0), of(0);
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < level.size; ++y)
        for (int x = 0; x < level.size; ++x) {
          const dvec3 r = centreOf(level.size, face, x, y);
          dvec3 sum(0);
          double total = 0;
          for (int f = 0; f < 6; ++f)
            for (int j = 0; j < 32; ++j)
              for (int i = 0; i < 32; ++i) {
                const double c = glm::dot(r, centreOf(32, f, i, j));
                if (c <= 0) continue;
                const double w = texelSolidAngle(32, i, j) * c * std::pow((1 + c) / 2, std::pow(level.roughness, -4) - 1);
                const float* t = source.texels.data() + 3 * Texel{f, i, j}.index(32);
                sum += dvec3(t[0], t[1], t[2]) * w;
                total += w;
              }
          const dvec3 truth = sum / total, e = [&] {
            const float* t = level.texels.data() + 3 * Texel{face, x, y}.index(level.size);
            return dvec3(t[0], t[1], t[2]) - truth;
          }();
          square += e * e, of += truth * truth;
        }
    for (int c = 0; c < 3; ++c) worst.worse(std::sqrt(square[c] / of[c]), fmt::format("roughness {:.2f}", level.roughness));
  }
  return worst;
}

// H27: beyond what bilinear samples of a perfect level miss.
Result<Finding> reflection(Studio& studio) {
  gl::setDefaults(studio.device);
  Disc disc;
  disc.centre = glm::normalize(dvec3(1, 0.3, -0.99));  // across the edge of +X and -Z
  const auto levels = reflectedDisc(studio.device, studio.programs, disc, 2048, 256);
  if (!levels) return fail(levels.error());
  Finding worst;
  for (const ReflectedLevel& level : *levels) worst.worse(level.beyond, fmt::format("level {}, roughness {:.2f}", level.level, level.roughness));
  return worst;
}

Material shiny() {
  Material m;
  m.albedo = vec3(0.6f);
  m.substance = 0.7f;
  m.roughness = 0.3f;
  return m;
}
// H9 in the renderer: one bad texel in the surroundings' picture.
Result<Finding> badSky(Studio& studio) {
  Finding bad;
  for (const float value : {1e5f, 65504.0f, 1e30f, kInfinity, kNan, -1.0f}) {
    Scene scene;
    place(scene, sphere(32, 64), shiny());
    scene.environment.map = makeImage(64, 32, 3, PixelType::F32);
    for (std::size_t i = 0; i < std::size_t(64 * 32 * 3); ++i) scene.environment.map.f32()[i] = 1;
    for (std::size_t c = 0; c < 3; ++c) scene.environment.map.f32()[(9 * 64 + 40) * 3 + c] = value;
    for (const Path path : {Path::Deferred, Path::Forward}) {
      Quality q;
      q.path = path;
      const auto p = draw(studio, scene, lookAt({0, 0.5, 4}, {0, 0, 0}, {0, 1, 0}, 0.7f), {64, 48}, {}, q);
      if (!p) return fail(p.error());
      // The rest of the sky must be what it is: 1, but for the picture's own filter around the texel.
      const bool dark = !(p->at(1, 1).y > 0.5);
      if ((p->nonfinite || dark) && bad.value == 0) bad.where = fmt::format("a texel of {:g}", value);
      bad.value += double(p->nonfinite) + dark;
    }
  }
  return bad;
}

// H17: what captured places and lattices bring.
Result<Finding> badPlaces(Studio& studio) {
  Finding bad;
  const auto add = [&](const Scene& scene, const std::string& where) -> Result<void> {
    for (const Path path : {Path::Deferred, Path::Forward}) {
      Quality q;
      q.path = path;
      const auto p = draw(studio, scene, lookAt({0, 0, 1.4}, {0, 0, 0}, {0, 1, 0}, 1.0f), {64, 48}, {}, q);
      if (!p) return fail(p.error());
      if (p->nonfinite && bad.value == 0) bad.where = where;
      bad.value += double(p->nonfinite);
    }
    return {};
  };
  for (const float value : {kNan, kInfinity, -kInfinity, 1e38f}) {
    for (const bool cube : {true, false}) {
      Scene scene;
      place(scene, sphere(32, 64), shiny(), glm::dmat4(glm::dmat3(0.5)));
      ReflectionProbe p = boxed(constantProbe(dvec3(1)), dvec3(0), dvec3(2));
      if (cube) p.radiance.levels[0].texels[100] = p.radiance.levels.back().texels[40] = value;
      else p.irradiance[2][1] = double(value);
      setProbes(scene, {std::move(p)});
      if (auto good = add(scene, fmt::format("{:g} in a place's {}", value, cube ? "cube" : "harmonics")); !good) return fail(good.error());
    }
    Scene scene;
    place(scene, sphere(32, 64), shiny(), glm::dmat4(glm::dmat3(0.5)));
    AmbientGrid grid = gridIn(dvec3(-1), dvec3(1), glm::ivec3(3), 0.01);
    fillGrid(grid, roomOf(dvec3(-1), dvec3(1), 0.1), [](const dvec3&) { return std::array<dvec3, 9>{dvec3(1)}; });
    grid.points[13].irradiance[0].x = grid.points[14].irradiance[4].y = value;
    grid.points[12].distances[7].x = value;
    scene.probes.grid = std::move(grid);
    ++scene.probes.revision;
    if (auto good = add(scene, fmt::format("{:g} in a lattice", value)); !good) return fail(good.error());
  }
  return bad;
}

}  // namespace

std::vector<PictureCase> filterPictureCases() {
  return {{"H7", "steps across the edges of levels filtered on the GPU over those inside faces: off 1", 0.02, seams},
          {"H8", "level of roughness 0, filtered on the GPU: values that are not the source's", 0, untouched},
          {"H8", "levels up to roughness 1, filtered on the GPU, suns by an edge and in a corner, against the sum in double: rms", 4e-3, summed},
          {"H9", "surroundings with a texel of 1e5, 65504, 1e30, infinity, NaN, -1: pixels that are not finite, or a sky gone dark", 0, badSky, true},
          {"H17", "NaN and infinity in the light of captured places and lattices: pixels that are not finite", 0, badPlaces, true},
          {"H27", "a disc of 0.53 degrees reflected through GL: beyond the bilinear error of a perfect level, share of the peak", 5e-3, reflection, true}};
}

}  // namespace burnish::stability
