// What the cube filter costs and errs by, and the usual way beside it: the tables of docs/prefilter_gpu.md.
#include <bit>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "cube_filter.h"
#include "gpu_scene/layout.h"
#include "temporary_folder.h"

using namespace burnish;
using namespace burnish::test;

// The usual way, for comparison: directions drawn from the lobe, each looked up in a mip level as coarse as its share of the sphere (Křivánek and Colbert 2008, "Real-time Shading with Filtered
// Importance Sampling"; with the bias of one level of GPU Gems 3, chapter 20).
TEST_CASE("cost of filtered importance sampling", "[.cost]") {
  Filter f;
  const int size = 256;
  const Picture shown = mixed(size);
  gl::Texture source = cubeTexture(f, size, 0);
  for (int face = 0; face < 6; ++face) source.upload(0, shown.cube.texels.data() + 3 * std::size_t(face) * faceTexels(size), face, GL_RGB, GL_FLOAT);
  source.generateMips();
  source.setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  const Points points(readBack(source, 0));
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / "prefilter");
  std::ofstream(folder.path / "prefilter/sampled.frag") << R"(
#include "prefilter/cube.glsl"
layout(binding = UNIT_CUBE_FILTER) uniform samplerCube source;
layout(location = 0) uniform ivec3 target;
layout(std140, binding = BINDING_CUBE_FILTER) uniform Samples { vec4 samples[1024]; };
layout(location = 0) out vec4 outLight;
void main() {
  vec3 r = texelDirection(target.x, target.y), t = normalize(abs(r.y) < 0.9 ? cross(r, vec3(0.0, 1.0, 0.0)) : cross(r, vec3(1.0, 0.0, 0.0))), b = cross(r, t), sum = vec3(0.0);
  for (int i = 0; i < target.z; ++i) sum += textureLod(source, t * samples[i].x + b * samples[i].y + r * samples[i].z, samples[i].w).rgb;
  outLight = vec4(rounded(sum / float(target.z)), 1.0);
}
)";
  gl::ProgramCache programs(*f.device, gl::ShaderLibrary(folder.path));
  auto program = programs.get({"sampled", "post/screen.vert", "prefilter/sampled.frag", {}, {}});
  if (!program) FAIL(program.error().message());
  const gl::VertexArray none = gl::VertexArray::create(*f.device, {}, {}, 0, "none");
  f.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  const gl::Texture target = cubeTexture(f, size, 6);
  for (const int count : {64, 256, 1024})
    for (int k = 1; k < target.levels; ++k) {
      const prefilter::Lobe lobe = prefilter::Lobe::of(ReflectionLobe::BlinnPhong, roughnessOf(k, target.levels));
      // The lobe's integral up to x, tabulated in the square root of x.
      constexpr int kSteps = 20'000;
      std::vector<double> integral(kSteps + 1);
      for (int i = 0; i < kSteps; ++i) integral[std::size_t(i) + 1] = integral[std::size_t(i)] + lobe(std::pow((i + 0.5) / kSteps, 2)) * 2 * (i + 0.5) / kSteps / kSteps;
      std::vector<glm::vec4> samples;
      for (int i = 0; i < count; ++i) {
        const auto at = std::lower_bound(integral.begin(), integral.end(), (i + 0.5) / count * integral.back());
        const double x = std::pow(double(at - integral.begin()) / kSteps, 2), sine = std::sqrt(x * (2 - x)), azimuth = i * 2.39996322972865332;
        const double density = std::max(lobe(x), 1e-6) / (2 * kPi * integral.back()), texel = 4 * kPi / 6 / size / size;
        samples.emplace_back(sine * std::cos(azimuth), sine * std::sin(azimuth), 1 - x, std::fmax(0.5 * std::log2(1 / (count * density * texel)) + 1, 0.0));
      }
      samples.resize(1024);
      auto buffer = gl::Buffer::create(*f.device, gl::BufferUse::Static, std::span<const glm::vec4>(samples), "samples");
      REQUIRE(buffer);
      buffer->bindBase(GL_UNIFORM_BUFFER, BINDING_CUBE_FILTER);
      source.bind(UNIT_CUBE_FILTER);
      none.bind();
      (*program)->use();
      double ms = 0;
      for (int run = 0; run < 2; ++run) {
        const double start = prefilter::cpuMilliseconds();
        for (int face = 0; face < 6; ++face) {
          const gl::Attachment color(target, k, face);
          auto framebuffer = gl::Framebuffer::create(*f.device, {&color, 1}, {}, "sampled");
          REQUIRE(framebuffer);
          framebuffer->bind();
          f.gl.Viewport(0, 0, size >> k, size >> k);
          f.gl.ProgramUniform3i((*program)->id(), 0, face, size >> k, count);
          f.gl.DrawArrays(GL_TRIANGLES, 0, 3);
          f.gl.Finish();
        }
        ms = prefilter::cpuMilliseconds() - start;
      }
      f.gl.UseProgram(0);
      WARN("importance sampling, " << rowOf(ReflectionLobe::BlinnPhong, k, target.levels, size >> k, count, ms, errorOf(readBack(target, k), points, ReflectionLobe::BlinnPhong, roughnessOf(k, target.levels), 20), shown));
    }
}

TEST_CASE("cost of the cube filter by effort", "[.cost]") {
  Filter f;
  const char* wanted = std::getenv("BURNISH_CUBE_SIZE");
  const int size = wanted ? std::atoi(wanted) : 256;
  const Picture shown = mixed(size);
  const gl::Texture source = uploaded(f, shown.cube);
  const Points points(readBack(source, 0));
  const gl::Texture target = cubeTexture(f, size, std::countr_zero(unsigned(size)) - 2);
  for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx})
    for (const double fineness : {0.75, 1.0, 1.5, 2.0}) {
      CubeFilterOptions options;
      options.lobe = lobe;
      options.effort.fineness = fineness;
      options.effort.far *= std::pow(1.5 / fineness, 6);
      CubeFilter filter(*f.device, f.programs, options);
      const std::vector<double> ms = timed(f, filter, source, target);
      WARN(fmt::format("{} fineness {}: grids and irradiance {:.1f} CPU ms, level 0 {:.1f}, all {:.1f}, {} slices", named(lobe), fineness, ms[0], ms[1], std::accumulate(ms.begin(), ms.end(), 0.0), filter.slices()));
      for (int k = 1; k < target.levels; ++k) {
        const CubeLevel level = readBack(target, k);
        WARN(rowOf(lobe, k, target.levels, level.size, filter.pointsOf(k), ms[std::size_t(k) + 1], errorOf(level, points, lobe, roughnessOf(k, target.levels), 20), shown));
      }
    }
  // Other numbers of levels have other roughnesses, and so other places between two grids.
  for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
    double rms = 0, worst = 0;
    for (int levels = 2; levels <= 9; ++levels) {
      const gl::Texture few = cubeTexture(f, size, levels);
      CubeFilterOptions options;
      options.lobe = lobe;
      CubeFilter filter(*f.device, f.programs, options);
      REQUIRE(filter.filter(source, few));
      for (int k = 1; k < levels; ++k) {
        const LevelError e = errorOf(readBack(few, k), points, lobe, roughnessOf(k, levels), 10);
        for (int c = 0; c < 3; ++c) rms = std::fmax(rms, e.rms[c]), worst = std::fmax(worst, e.worst[c]);
      }
    }
    WARN(named(lobe) << ", 2 to 9 levels: rms " << rms << ", at most " << worst << " of the level's largest value");
  }
}
