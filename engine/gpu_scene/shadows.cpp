#include "gpu_scene/shadows.h"

#include <algorithm>

#include "gpu_scene/frame.h"

namespace burnish::gpu_scene {
namespace {

float layerOf(const scene::ShadowSet& set, int map) { return map < 0 ? -1.0f : float(set.maps[std::size_t(map)].layer); }

void fillSun(const scene::ShadowSet& set, const scene::SunShadow& sun, glm::dvec3 eye, int resolution, vec4* out) {
  for (int i = 0; i < 3; ++i) out[i] = vec4(glm::vec3(sun.axes[i]), 0);
  out[0].w = float(sun.tangent);
  out[3].x = float(sun.cascades.size());
  for (std::size_t k = 0; k < MAX_CASCADES; ++k) {
    vec4 *place = out + 4 + 2 * k, *depth = place + 1;
    *place = vec4(0, 2, 2, -1);  // nothing is inside
    *depth = vec4(0);
    if (k >= sun.cascades.size()) continue;
    const scene::Cascade& c = sun.cascades[k];
    const glm::dvec3 at = glm::transpose(sun.axes) * (eye - c.center);
    const double range = c.near + c.far;
    *place = vec4(float(1 / c.radius), float(at.x / c.radius), float(at.y / c.radius), layerOf(set, c.map));
    *depth = vec4(float(1 / range), float((at.z + c.far) / range), float(2 * c.radius / resolution), float(range));
  }
}

}  // namespace

Result<void> uploadShadows(FrameContext& c) {
  ShadowBindings& b = c.buffers.shadows;
  if (!b.data) {
    auto made = gl::Buffer::create(c.device, gl::BufferUse::Stream, sizeof(ShadowData), nullptr, "shadow data");
    if (!made) return fail(made.error());
    b.data = std::move(*made);
    b.compared = gl::Sampler::create(c.device, {.compare = true}, "shadows, compared");
    b.depths = gl::Sampler::create(c.device, {.minFilter = GL_NEAREST, .magFilter = GL_NEAREST}, "shadows, depths");
  }
  const scene::ShadowSet& set = *c.shadows;
  const int resolution = c.targets.texture("shadow_maps")->width;
  ShadowData d{};
  d.params = vec4(float(resolution), 1 / float(resolution), float(set.locals.size()), float(LIGHT_TEXELS * (c.lights.local.size() + 1)));
  for (std::size_t i = 0; i < MAX_SHADOW_SUNS; ++i) fillSun(set, i < set.suns.size() ? set.suns[i] : scene::SunShadow{}, c.view.eye, resolution, d.suns + SUN_SHADOW_VECTORS * i);
  return b.data.write(std::as_bytes(std::span(&d, 1)));
}

void bindShadows(FrameContext& c) {
  const gl::Texture* maps = c.targets.texture("shadow_maps");
  if (!maps || !c.shadows) return;
  const ShadowBindings& b = c.buffers.shadows;
  b.data.bindBase(GL_UNIFORM_BUFFER, BINDING_SHADOW);
  maps->bind(UNIT_SHADOW);
  b.compared.bind(UNIT_SHADOW);
  if (c.quality.shadow != Shadow::Pcss) return;
  maps->bind(UNIT_SHADOW_DEPTH);
  b.depths.bind(UNIT_SHADOW_DEPTH);
}

std::vector<glm::vec4> shadowRecord(const scene::ShadowSet& set, const scene::LocalShadow& s, glm::dvec3 eye) {
  std::vector<glm::vec4> t(SHADOW_TEXELS, glm::vec4(0));
  t[0] = glm::vec4(s.cube ? 1 : 0, float(s.near * s.far / (s.far - s.near)), float(s.near / (s.far - s.near)), float(s.tangent));
  const glm::dvec3 at = glm::transpose(s.axes) * (eye - s.origin);
  for (int i = 0; i < 3; ++i) {
    const double scale = i < 2 ? 1 / s.tangent : 1;
    t[std::size_t(1 + i)] = glm::vec4(glm::vec3(s.axes[i] * scale), float(at[i] * scale));
  }
  for (std::size_t i = 0; i < 6; ++i) t[4 + i].x = layerOf(set, s.maps[i]);
  return t;
}

}  // namespace burnish::gpu_scene
