#include "stability/reflected_disc.h"

#include <burnish/scene.h>

#include <map>
#include <random>

#include "gpu_scene/gpu_scene.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec4;

/// Direction and alpha in, radiance out.
Result<std::vector<vec4>> lookedUp(gl::Device& device, gl::ProgramCache& programs, const gpu_scene::GpuEnvironment& environment, const std::vector<vec4>& lookups) {
  auto program = programs.get({"lookup", "stability/cases.vert", "stability/lookup.frag", "", {"LAST_LEVEL " + std::to_string(environment.lastLevel)}});
  if (!program) return fail(program.error());
  const int width = int(lookups.size());
  auto input = gl::Texture::create(device, {GL_TEXTURE_2D, GL_RGBA32F, width, 1}, "lookups");
  auto output = gl::Texture::create(device, {GL_TEXTURE_2D, GL_RGBA32F, width, 1}, "results");
  if (!input || !output) return fail(input ? output.error() : input.error());
  input->upload(0, lookups.data());
  const gl::Attachment color(*output);
  const auto framebuffer = gl::Framebuffer::create(device, {&color, 1}, {}, "results");
  if (!framebuffer) return fail(framebuffer.error());
  const gl::VertexArray none = gl::VertexArray::create(device, {}, {}, 0, "none");
  framebuffer->bind();
  none.bind();
  (*program)->use();
  input->bind(0);
  environment.cube.bind(1);
  device.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  device.gl.Viewport(0, 0, width, 1);
  device.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  device.gl.UseProgram(0);
  std::vector<vec4> results(lookups.size());
  output->read(0, std::as_writable_bytes(std::span(results)));
  return results;
}

/// What a bilinear filter without seams makes of texels that are exact at their centres. In a cube's corner, where three texels meet, the fourth is the mean of the others.
class PerfectLevel {
 public:
  PerfectLevel(int size, const DiscProfile& profile) : size_(size), profile_(profile) {}
  double operator()(const dvec3& d) {
    const Texel in = texelAt(size_, d);
    const dvec3 a = d / std::abs(d[in.face / 2]);
    const double s[6] = {-a.z, a.z, a.x, a.x, a.x, -a.x}, t[6] = {-a.y, -a.y, a.z, -a.z, -a.y, -a.y};
    const double u = (s[in.face] + 1) / 2 * size_ - 0.5, v = (t[in.face] + 1) / 2 * size_ - 0.5;
    const int x = int(std::floor(u)), y = int(std::floor(v));
    double value[2][2], known = 0;
    int corners = 0;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        const bool corner = (x + i < 0 || x + i >= size_) && (y + j < 0 || y + j >= size_);
        value[j][i] = corner ? -1 : texel(acrossEdge(size_, in.face, x + i, y + j));
        if (corner) ++corners;
        else known += value[j][i];
      }
    if (corners == 1)
      for (auto& row : value)
        for (double& w : row)
          if (w < 0) w = known / 3;
    const double fx = u - x, fy = v - y;
    return (value[0][0] * (1 - fx) + value[0][1] * fx) * (1 - fy) + (value[1][0] * (1 - fx) + value[1][1] * fx) * fy;
  }

 private:
  double texel(const Texel& t) {
    const auto [found, made] = texels_.try_emplace(t.index(size_), 0.0);
    if (made) found->second = profile_(centreOf(size_, t.face, t.x, t.y));
    return found->second;
  }
  int size_;
  const DiscProfile& profile_;
  std::map<std::size_t, double> texels_;
};

}  // namespace

Result<std::vector<ReflectedLevel>> reflectedDisc(gl::Device& device, gl::ProgramCache& programs, const Disc& disc, int width, int count) {
  Scene scene;
  scene.environment.map = discPicture(width, disc);
  gpu_scene::GpuScene gpu(device);
  Report report;
  auto made = gpu.environment(scene, {.cube = true}, report);
  if (!made) return fail(made.error());
  const gpu_scene::GpuEnvironment& environment = **made;
  const int last = int(environment.lastLevel);
  const dvec3 side = glm::normalize(glm::cross(disc.centre, dvec3(0, 1, 0))), up = glm::cross(disc.centre, side);
  std::vector<ReflectedLevel> found;
  for (int k = 1; k <= last; ++k) {
    ReflectedLevel level{k, shading::f64::environmentRoughness(double(k), double(last))};
    const DiscProfile profile(disc, ReflectionLobe::BlinnPhong, level.roughness);
    // Out to four half-widths, where a lobe holds 1e-5 of its peak, or to the horizon.
    std::mt19937 random(7);
    std::vector<vec4> lookups;
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) {
      const double angle = std::min(4 * profile.halfWidth(), 1.6) * i / count, phi = double(random() % 4096) / 4096 * kCircle;
      lookups.emplace_back(glm::vec3(disc.centre * std::cos(angle) + (side * std::cos(phi) + up * std::sin(phi)) * std::sin(angle)), float(level.roughness * level.roughness));
      angles.push_back(angle);
    }
    const auto results = lookedUp(device, programs, environment, lookups);
    if (!results) return fail(results.error());
    PerfectLevel perfect(environment.cube.width >> k, profile);
    const double peak = profile.peak();
    const auto worst = [](double& most, double value) { return !(value <= most) && (most = value, true); };
    for (std::size_t i = 0; i < lookups.size(); ++i) {
      const dvec3 r = glm::normalize(dvec3(lookups[i]));
      const double truth = profile(r), there = perfect(r), value = double((*results)[i].x);
      worst(level.bilinear, std::abs(there - truth) / peak);
      worst(level.ours, std::abs(value - truth) / peak);
      if (worst(level.beyond, std::abs(value - there) / peak)) level.at = angles[i];
    }
    found.push_back(level);
  }
  return found;
}

}  // namespace burnish::stability
