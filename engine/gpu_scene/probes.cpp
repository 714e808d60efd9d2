#include "gpu_scene/probes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu_scene/frame.h"
#include "interface/limits.h"
#include "plan/plan.h"
#include "reference/shading.h"

namespace burnish::gpu_scene {
namespace {

static_assert(MAX_TILE_PROBES == PROBES_BLENDED);

constexpr float kFullest = 32768;  // of what half floats hold

bool good(float v) { return std::isfinite(v) && v >= 0; }

/// Largest texel, and how many are not finite or negative.
std::pair<float, std::size_t> survey(const ReflectionProbe& probe) {
  float largest = 0;
  std::size_t bad = 0;
  for (const CubeLevel& level : probe.radiance.levels)
    for (const float v : level.texels) {
      if (good(v)) largest = std::max(largest, v);
      bad += !good(v);
    }
  return {largest, bad};
}

glm::vec4 row(glm::dvec3 axis, glm::dvec3 center) { return {glm::vec3(axis), float(-glm::dot(axis, center))}; }

void fillRecord(const ReflectionProbe& p, const scene::SeenProbe& seen, float preExposure, glm::vec4* out) {
  const glm::dvec3 half = glm::max(p.halfSize, glm::dvec3(0)), fade = glm::clamp(p.fade, glm::dvec3(0), half);
  for (int i = 0; i < 3; ++i) out[i] = row(p.axes[i], seen.center);
  out[3] = glm::vec4(glm::vec3(half), float(std::max(p.margin, 0.0)));
  out[4] = glm::vec4(glm::vec3(fade), float(seen.layer));
  out[5] = glm::vec4(glm::vec3(glm::transpose(p.axes) * (seen.capture - seen.center)), 0);
  for (std::size_t k = 0; k < 9; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = p.irradiance[k][c] * double(preExposure);
      out[6 + k][glm::length_t(c)] = std::isfinite(v) ? float(std::clamp(v, -1e30, 1e30)) : 0.0f;
    }
}

}  // namespace

Result<GpuProbes> uploadProbeCubes(gl::Device& device, const ProbeSet& probes, const std::vector<std::uint32_t>& usable, Report& report) {
  GpuProbes made;
  float largest = 0;
  for (const std::uint32_t i : usable) {
    const auto [most, bad] = survey(probes.reflections[i]);
    largest = std::max(largest, most);
    if (bad) report.warn(fmt::format("reflection probe '{}'", probes.reflections[i].name), fmt::format("{} values are not finite or negative: they are black", bad));
  }
  if (largest > 0) made.scale = std::exp2(std::ceil(std::log2(largest / kFullest)));
  const std::vector<CubeLevel>& first = probes.reflections[usable[0]].radiance.levels;
  auto cubes = gl::Texture::create(device, {.target = GL_TEXTURE_CUBE_MAP_ARRAY, .format = GL_RGBA16F, .width = first[0].size, .height = first[0].size, .layers = 6 * int(usable.size()), .levels = int(first.size())}, "probe cubes");
  if (!cubes) return fail(cubes.error());
  std::vector<float> face;
  for (std::size_t i = 0; i < usable.size(); ++i)
    for (std::size_t k = 0; k < first.size(); ++k) {
      const CubeLevel& level = probes.reflections[usable[i]].radiance.levels[k];
      const std::size_t count = 3 * std::size_t(level.size) * std::size_t(level.size);
      face.resize(count);
      for (std::size_t f = 0; f < 6; ++f) {
        std::transform(level.texels.begin() + std::ptrdiff_t(f * count), level.texels.begin() + std::ptrdiff_t((f + 1) * count), face.begin(), [&](float v) { return good(v) ? v / made.scale : 0.0f; });
        cubes->upload(int(k), face.data(), int(6 * i + f), GL_RGB, GL_FLOAT);
      }
    }
  cubes->setFilter(first.size() > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR, GL_LINEAR);
  made.cubes = std::move(*cubes);
  made.lastLevel = float(first.size() - 1);
  return made;
}

Result<const GpuProbes*> GpuScene::probes(const Scene& scene, Report& report) {
  const std::vector<std::uint32_t> usable = scene::usableProbes(scene.probes, nullptr);
  if (usable.empty()) return fail("reflection probes", "none is usable", "report this as a fault of the engine");
  const Cubemap& first = scene.probes.reflections[usable[0]].radiance;
  // Number and size take part: layers are counted by them.
  const std::uint64_t revision = scene.probes.revision * 1000003u + std::uint64_t(usable.size()) * 4099u + std::uint64_t(first.levels[0].size) * 31u + std::uint64_t(first.levels.size()) + 1;
  if (probes_ && probesRevision_ == revision) return probes_.get();
  probes_.reset();  // the old cubes go first: memory may be short
  auto made = uploadProbeCubes(device_, scene.probes, usable, report);
  if (!made) return fail(made.error());
  probes_ = std::make_unique<GpuProbes>(std::move(*made));
  probesRevision_ = revision;
  return probes_.get();
}

Result<void> uploadProbeRecords(FrameContext& c) {
  std::vector<glm::vec4> texels(PROBE_TEXELS * std::max<std::size_t>(c.probes.size(), 1), glm::vec4(0));
  for (std::size_t i = 0; i < c.probes.size(); ++i) fillRecord(c.scene.probes.reflections[c.probes[i].index], c.probes[i], c.preExposure, &texels[PROBE_TEXELS * i]);
  gl::TextureBuffer& records = c.buffers.probes;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(texels));
  if (!records) {
    auto made = gl::TextureBuffer::create(c.device, GL_RGBA32F, gl::BufferUse::Stream, bytes.size(), nullptr, "probe records");
    if (!made) return fail(made.error());
    records = std::move(*made);
  }
  return records.write(bytes);
}

void bindProbes(FrameContext& c) {
  c.buffers.probes.bind(UNIT_PROBES);
  if (!c.probeLight) return;
  c.probeLight->cubes.bind(UNIT_PROBE_CUBES);
  c.device.gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

}  // namespace burnish::gpu_scene
