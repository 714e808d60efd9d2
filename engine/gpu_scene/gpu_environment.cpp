// The environment: prefiltered cube and irradiance for lighting, the picture itself for the background.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "gpu_scene/gpu_scene.h"
#include "prefilter/environment.h"

namespace burnish::gpu_scene {
namespace {

constexpr float kLimit = 65000;  // of what half floats hold

// Finite, not negative, half-float safe RGB floats.
Image mended(const Environment& environment, Report& report) {
  const Image& in = environment.map;
  if (in.empty()) {
    Image out = makeImage(8, 4, 3, PixelType::F32);
    for (std::size_t i = 0; i < out.pixelCount() * 3; ++i) out.f32()[i] = std::clamp(std::isfinite(environment.color[int(i % 3)]) ? environment.color[int(i % 3)] : 0.0f, 0.0f, kLimit);
    return out;
  }
  Image out = makeImage(in.width, in.height, 3, PixelType::F32);
  std::size_t bad = 0;
  for (std::size_t i = 0; i < in.pixelCount(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = in.f32()[i * std::size_t(in.channels) + c];
      const float good = std::isfinite(v) ? std::clamp(v, 0.0f, kLimit) : 0.0f;
      bad += good != v;
      out.f32()[i * 3 + c] = good;
    }
  if (bad) report.warn("environment", fmt::format("{} values were not finite, negative or over {}: they were mended", bad, kLimit));
  return out;
}

int filterSize(const Environment& e) { return int(std::bit_floor(unsigned(std::clamp(e.filterSize, 16, 1024)))); }
double filterError(const Environment& e) { return std::isfinite(e.filterError) ? std::clamp(e.filterError, 1e-7, 0.1) : Environment{}.filterError; }

Result<gl::Texture> uploadCube(gl::Device& device, const prefilter::EnvironmentLight& light) {
  auto cube = gl::Texture::create(device, {.target = GL_TEXTURE_CUBE_MAP, .format = GL_RGBA16F, .width = light.levels[0].size, .height = light.levels[0].size, .levels = int(light.levels.size())},
                                  "environment cube");
  if (!cube) return cube;
  for (std::size_t k = 0; k < light.levels.size(); ++k) {
    const CubeLevel& level = light.levels[k];
    const std::size_t count = std::size_t(level.size) * std::size_t(level.size);
    std::vector<glm::vec4> face(count);
    for (int f = 0; f < 6; ++f) {
      const float* texel = level.texels.data() + 3 * std::size_t(f) * count;
      for (std::size_t i = 0; i < count; ++i, texel += 3) face[i] = glm::vec4(texel[0], texel[1], texel[2], 1);
      cube->upload(int(k), face.data(), f, GL_RGBA, GL_FLOAT);
    }
  }
  cube->setFilter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  return cube;
}

Result<gl::Texture> uploadPicture(gl::Device& device, const Image& picture) {
  auto sky = gl::Texture::create(device, {.format = GL_RGBA16F, .width = picture.width, .height = picture.height}, "environment picture");
  if (!sky) return sky;
  sky->upload(0, picture.data.data(), 0, GL_RGB, GL_FLOAT);
  sky->setFilter(GL_LINEAR, GL_LINEAR);
  sky->setWrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
  return sky;
}

}  // namespace

Result<const GpuEnvironment*> GpuScene::environment(const Scene& scene, EnvironmentWants wants, Report& report) {
  const Environment& e = scene.environment;
  // Colour and size take part, so that a change without a new revision is seen in the common cases.
  const std::uint64_t revision = e.revision * 1000003u + std::uint64_t(e.map.width) * 31u + std::uint64_t(e.map.height) + std::hash<float>{}(e.color.r) * 7u + std::hash<float>{}(e.color.g) * 11u +
                                 std::hash<float>{}(e.color.b) * 13u + std::uint64_t(e.filterSize) * 17u + std::hash<double>{}(e.filterError) * 19u + 1;
  const bool current = environment_ && environmentRevision_ == revision;
  if (current && (!wants.cube || environment_->cube) && (!wants.picture || environment_->sky)) return environment_.get();
  if (!e.map.empty() && (e.map.type != PixelType::F32 || e.map.channels < 3 || e.map.data.size() != e.map.byteSize()))
    return fail("environment", "the map is not a float picture with 3 or 4 channels", "load it with loadEnvironment");
  const Image picture = mended(e, report);
  auto filtered = prefilter::prefilterEnvironment(picture, e.map.empty() ? 16 : filterSize(e), filterError(e));
  if (!filtered) return fail(filtered.error());
  const prefilter::EnvironmentLight& light = *filtered;
  auto made = std::make_unique<GpuEnvironment>();
  if (wants.cube) {
    auto cube = uploadCube(device_, light);
    if (!cube) return fail(cube.error());
    made->cube = std::move(*cube);
  }
  if (wants.picture) {
    auto sky = uploadPicture(device_, picture);
    if (!sky) return fail(sky.error());
    made->sky = std::move(*sky);
  }
  made->irradiance = light.irradiance;
  made->meanLuminance = light.meanLuminance;
  made->lastLevel = float(light.levels.size() - 1);
  environment_ = std::move(made);
  environmentRevision_ = revision;
  return environment_.get();
}

}  // namespace burnish::gpu_scene
