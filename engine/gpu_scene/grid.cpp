#include "gpu_scene/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "gpu_scene/frame.h"
#include "gpu_scene/grid_planes.h"
#include "interface/limits.h"
#include "plan/plan.h"
#include "reference/shading.h"
#include "scene/grid.h"

namespace burnish::gpu_scene {
namespace {

static_assert(GRID_MAP_SIZE == AmbientGrid::kDistanceSize);
constexpr float kFullest = 32768;     // of what half floats hold
constexpr double kSteepest = 30000;   // likewise: a wall less than 1/30000 m away

glm::uvec2 packed(const glm::dvec4& plane) {
  const glm::vec4 p(glm::clamp(plane, glm::dvec4(-kSteepest), glm::dvec4(kSteepest)));
  return {glm::packHalf2x16({p.x, p.y}), glm::packHalf2x16({p.z, p.w})};
}

/// A point's planes with a border, as the square's neighbours across its edges lie (shading/normals.h).
void addTile(const std::vector<glm::dvec4>& planes, std::vector<glm::uvec2>& out) {
  constexpr int kLast = GRID_MAP_SIZE - 1;
  for (int v = -1; v <= GRID_MAP_SIZE; ++v)
    for (int u = -1; u <= GRID_MAP_SIZE; ++u) {
      int x = u, y = v;
      if (x < 0 || x > kLast) x = x < 0 ? 0 : kLast, y = kLast - y;
      if (y < 0 || y > kLast) y = y < 0 ? 0 : kLast, x = kLast - x;
      out.push_back(packed(planes[std::size_t(std::clamp(y, 0, kLast) * GRID_MAP_SIZE + std::clamp(x, 0, kLast))]));
    }
}

}  // namespace

float lightScale(const AmbientGrid& grid) {
  float largest = 0;
  for (const AmbientGrid::Point& p : grid.points)
    for (const glm::vec3& c : p.irradiance)
      for (int i = 0; i < 3; ++i)
        if (p.valid && std::isfinite(c[i])) largest = std::max(largest, std::abs(c[i]));
  return largest > 0 ? std::exp2(std::ceil(std::log2(largest / kFullest))) : 1;
}

std::vector<std::uint32_t> packedLight(const AmbientGrid::Point& point, float scale) {
  float values[2 * 4 * GRID_LIGHT_TEXELS] = {};
  for (std::size_t k = 0; k < 9; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = point.irradiance[k][glm::length_t(c)] / scale;
      values[3 * k + c] = std::isfinite(v) ? v : 0.0f;
    }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < std::size(values); i += 2) out.push_back(glm::packHalf2x16({values[i], values[i + 1]}));
  return out;
}

Result<GpuGrid> uploadGrid(gl::Device& device, const AmbientGrid& grid, Report& report) {
  GpuGrid made;
  made.scale = lightScale(grid);
  const double limit = shading::f64::distanceLimit(grid.spacing);
  std::vector<std::uint32_t> light;
  std::vector<glm::uvec2> planes;
  std::size_t blind = 0;
  for (const AmbientGrid::Point& p : grid.points) {
    const std::vector<std::uint32_t> words = packedLight(p, made.scale);
    light.insert(light.end(), words.begin(), words.end());
    addTile(planesOf(p, limit), planes);
    const glm::vec3& mean = p.irradiance[0];
    const float luminance = 0.2126f * mean.r + 0.7152f * mean.g + 0.0722f * mean.b;
    if (p.valid && std::isfinite(luminance)) made.luminance = std::max(made.luminance, luminance);
    blind += p.valid && p.distances.size() != std::size_t(GRID_MAP_SIZE * GRID_MAP_SIZE);
  }
  if (blind) report.warn("ambient lattice", fmt::format("{} of {} points have no map of distances: they shine through walls", blind, grid.points.size()));
  auto lights = gl::TextureBuffer::create(device, GL_RGBA32UI, gl::BufferUse::Static, light.size() * sizeof light[0], light.data(), "ambient lattice, light");
  if (!lights) return fail(lights.error());
  auto maps = gl::TextureBuffer::create(device, GL_RG32UI, gl::BufferUse::Static, planes.size() * sizeof planes[0], planes.data(), "ambient lattice, planes");
  if (!maps) return fail(maps.error());
  made.light = std::move(*lights);
  made.planes = std::move(*maps);
  return made;
}

Result<const GpuGrid*> GpuScene::grid(const Scene& scene, Report& report) {
  const AmbientGrid* g = scene::usableGrid(scene, nullptr);
  if (!g) return fail("ambient lattice", "it is not usable", "report this as a fault of the engine");
  // Its counts take part, so that a change without a new revision is seen in the common cases.
  const std::uint64_t revision = scene.probes.revision * 1000003u + std::uint64_t(g->counts.x) * 4099u + std::uint64_t(g->counts.y) * 31u + std::uint64_t(g->counts.z) + 1;
  if (grid_ && gridRevision_ == revision) return grid_.get();
  grid_.reset();  // the old one goes first: memory may be short
  auto made = uploadGrid(device_, *g, report);
  if (!made) return fail(made.error());
  grid_ = std::make_unique<GpuGrid>(std::move(*made));
  gridRevision_ = revision;
  return grid_.get();
}

Result<void> uploadGridData(FrameContext& c) {
  const AmbientGrid& g = *c.scene.probes.grid;
  const double least = std::min({g.spacing.x, g.spacing.y, g.spacing.z});
  GridData d{};
  const glm::dvec3 origin = g.origin - c.view.eye;
  for (int i = 0; i < 3; ++i) {
    d.toLattice[i] = glm::vec4(glm::vec3(g.axes[i] / g.spacing[i]), float(-glm::dot(g.axes[i], origin) / g.spacing[i]));
    d.step[i] = glm::vec4(glm::vec3(g.axes[i] * g.spacing[i]), 0);
    d.margin[i] = float(std::min(g.spacing[i] / std::max(g.margin, 1e-12), 1e12));
  }
  d.step[0].w = float(shading::f64::gridAim(least));
  d.step[1].w = float(shading::f64::gridBias(least));
  d.step[2].w = float(1 / shading::f64::gridDepth(least));
  d.last = glm::vec4(glm::vec3(g.counts - 1), c.grid->scale * c.preExposure);
  const std::span<const std::byte> bytes = std::as_bytes(std::span(&d, 1));
  if (!c.buffers.grid) {
    auto made = gl::Buffer::create(c.device, gl::BufferUse::Stream, bytes.size(), nullptr, "lattice data");
    if (!made) return fail(made.error());
    c.buffers.grid = std::move(*made);
  }
  return c.buffers.grid.write(bytes);
}

void bindGrid(FrameContext& c) {
  if (!plan::reads(c.plan, "ambient lattice")) return;
  c.buffers.grid.bindBase(GL_UNIFORM_BUFFER, BINDING_GRID);
  c.grid->light.bind(UNIT_GRID_LIGHT);
  c.grid->planes.bind(UNIT_GRID_PLANES);
}

}  // namespace burnish::gpu_scene
