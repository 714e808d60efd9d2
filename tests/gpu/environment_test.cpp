// A light's reflection as the renderer samples it: its own cube, its own mapping from roughness to level, GL's seamless bilinear filter (H27 of docs/hard_cases.md).
#include <burnish/scene.h>

#include <map>

#include "gl/program.h"
#include "gl_fixture.h"
#include "gpu_scene/gpu_scene.h"
#include "prefilter/disc.h"

using namespace burnish;
using namespace burnish::test;
using glm::dvec3;
using glm::vec4;

namespace {

/// As lighting/shade.glsl looks the surroundings up: direction + alpha in, radiance out.
constexpr gl::EmbeddedShader kLookup = {"test/environment_lookup.frag",
                                        "#include \"shading/bridge.h\"\n#include \"shading/all.h\"\n"
                                        "layout(binding = 0) uniform sampler2D lookups;\nlayout(binding = 1) uniform samplerCube environmentCube;\nlayout(location = 0) out vec4 result;\n"
                                        "void main() {\n  vec4 q = texelFetch(lookups, ivec2(gl_FragCoord.xy), 0);\n"
                                        "  result = textureLod(environmentCube, q.xyz, environmentLevel(sqrt(q.w), LAST_LEVEL));\n}\n"};

std::vector<vec4> lookedUp(GlFixture& f, const gpu_scene::GpuEnvironment& environment, const std::vector<vec4>& lookups) {
  std::vector<gl::EmbeddedShader> shaders(gl::embeddedShaders().begin(), gl::embeddedShaders().end());
  shaders.push_back(kLookup);
  gl::ProgramCache programs(*f.device, gl::ShaderLibrary({}, shaders));
  auto program = programs.get({"lookup", "stability/cases.vert", "test/environment_lookup.frag", "", {"LAST_LEVEL " + std::to_string(environment.lastLevel)}});
  if (!program) FAIL(program.error().message());
  const int width = int(lookups.size());
  auto input = gl::Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA32F, width, 1}, "lookups").value();
  auto output = gl::Texture::create(*f.device, {GL_TEXTURE_2D, GL_RGBA32F, width, 1}, "results").value();
  input.upload(0, lookups.data());
  const gl::Attachment color(output);
  const auto framebuffer = gl::Framebuffer::create(*f.device, {&color, 1}, {}, "results").value();
  const gl::VertexArray none = gl::VertexArray::create(*f.device, {}, {}, 0, "none");
  framebuffer.bind();
  none.bind();
  (*program)->use();
  input.bind(0);
  environment.cube.bind(1);
  f.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  f.gl.Viewport(0, 0, width, 1);
  f.gl.DrawArrays(GL_TRIANGLES, 0, 3);
  f.gl.UseProgram(0);
  std::vector<vec4> results(lookups.size());
  output.read(0, std::as_writable_bytes(std::span(results)));
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

/// A lat-long picture of the disc, each texel its radiance times the share that 16² points find covered.
Image discPicture(int width, const Disc& disc) {
  Image image = makeImage(width, width / 2, 3, PixelType::F32);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto direction = [&](double i, double j) {
        const double longitude = ((x + i) / width - 0.5) * kCircle, polar = (y + j) / image.height * kCircle / 2;
        return dvec3(std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude));
      };
      int inside = 0;
      if (glm::length(direction(0.5, 0.5) - disc.centre) < disc.radius + kCircle / width)
        for (int k = 0; k < 256; ++k) inside += disc.holds(direction((k % 16 + 0.5) / 16, (k / 16 + 0.5) / 16));
      for (int c = 0; c < 3; ++c) image.f32()[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3 + std::size_t(c)] = float(disc.radiance * inside / 256);
    }
  return image;
}

}  // namespace

TEST_CASE("a disc of 0.53 degrees reflected through GL has the analytic light's profile (H27)") {
  GlFixture f;
  // In the middle of a face; across the edge of +X and -Z; in a corner.
  for (const dvec3& centre : {dvec3(0.1, 0.2, 1), dvec3(1, 0.3, -0.99), dvec3(-1, 0.985, -0.99)}) {
    Disc disc;
    disc.centre = glm::normalize(centre);
    Scene scene;
    scene.environment.map = discPicture(2048, disc);
    gpu_scene::GpuScene gpu(*f.device);
    Report report;
    auto made = gpu.environment(scene, {.cube = true}, report);
    if (!made) FAIL(made.error().message());
    const gpu_scene::GpuEnvironment& environment = **made;
    const int last = int(environment.lastLevel);
    REQUIRE(environment.cube.levels == last + 1);
    const dvec3 side = glm::normalize(glm::cross(disc.centre, dvec3(0, 1, 0))), up = glm::cross(disc.centre, side);
    for (int k = 1; k <= last; ++k) {
      const double roughness = shading::f64::environmentRoughness(double(k), double(last));
      const DiscProfile profile(disc, ReflectionLobe::BlinnPhong, roughness);
      // Out to four half-widths, where a lobe holds 1e-5 of its peak, or to the horizon.
      std::mt19937 random(7);
      std::vector<vec4> lookups;
      std::vector<double> angles;
      for (int i = 0; i < 1024; ++i) {
        const double angle = std::min(4 * profile.halfWidth(), 1.6) * i / 1024, phi = double(random() % 4096) / 4096 * kCircle;
        lookups.emplace_back(glm::vec3(disc.centre * std::cos(angle) + (side * std::cos(phi) + up * std::sin(phi)) * std::sin(angle)), float(roughness * roughness));
        angles.push_back(angle);
      }
      const std::vector<vec4> results = lookedUp(f, environment, lookups);
      PerfectLevel perfect(environment.cube.width >> k, profile);
      const double peak = profile.peak();
      double bilinear = 0, ours = 0, beyond = 0, at = 0;
      for (std::size_t i = 0; i < lookups.size(); ++i) {
        const dvec3 r = glm::normalize(dvec3(lookups[i]));
        const double truth = profile(r), there = perfect(r), value = double(results[i].x);
        bilinear = std::max(bilinear, std::abs(there - truth) / peak);
        ours = std::max(ours, std::abs(value - truth) / peak);
        if (const double off = std::abs(value - there) / peak; off > beyond) beyond = off, at = angles[i];
      }
      WARN("disc at (" << centre.x << ", " << centre.y << ", " << centre.z << "), level " << k << ", r " << roughness << ": off by " << 100 * ours << " % of the peak, a perfect level by " << 100 * bilinear
                       << " %; from that at most " << 100 * beyond << " %, at " << at / kCircle * 360 << " degrees");
      CHECK(ours < bilinear + 5e-3);
      CHECK(beyond < 5e-3);
    }
  }
}
