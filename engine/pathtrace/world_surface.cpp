// The surface at a hit: shaders/gbuffer/fetch.glsl on the CPU.
#include <algorithm>
#include <cmath>

#include "pathtrace/world_parts.h"

namespace burnish::pathtrace {
namespace {

namespace f32 = shading::f32;
using f32::real;

/// Panes that are rougher turn light by more than a tenth of a pixel of a picture 1000 pixels high.
constexpr float kClearAlpha = 0.001f;

struct Frame {
  glm::vec3 normal{0};
  glm::vec4 tangent{0};
};

Frame frameAt(const Part& part, const reference::Hit& hit) {
  Frame f;
  const std::uint32_t* i = part.indices().data() + std::size_t(hit.triangle) * 3;
  const float b = hit.barycentric.x, c = hit.barycentric.y, a = 1 - b - c;
  if (!part.normals.empty()) f.normal = part.normals[i[0]] * a + part.normals[i[1]] * b + part.normals[i[2]] * c;
  if (!part.tangents.empty()) f.tangent = part.tangents[i[0]] * a + part.tangents[i[1]] * b + part.tangents[i[2]] * c;
  return f;
}

// Map B's normal as it is mapped; flat where there is no direction left.
glm::vec3 shadingNormal(const Frame& f, const glm::vec3& mapped, const SurfacePoint& p) {
  const glm::vec3 t(f.tangent), b = glm::cross(f.normal, t) * f.tangent.w;
  glm::vec3 m = t * mapped.x + b * mapped.y + f.normal * mapped.z;
  if (!(glm::dot(m, m) > 1e-12f)) m = f.normal;
  const float square = glm::dot(m, m);
  // The G-buffer's code of no direction is +z: there is no normal to go by. Here the triangle's own stands in.
  if (!(square > 1e-30f) || !std::isfinite(square)) return p.geometric;
  return m * ((p.back ? -1.0f : 1.0f) / std::sqrt(square));
}

// World metres of one metre of the mesh along the normal (forward/transparent.frag, meshScale).
float meshScale(const glm::mat3& model, const glm::vec3& n) {
  const glm::vec3 o = glm::transpose(model) * n;
  const float o2 = glm::dot(o, o);
  return o2 <= 1e-30f ? 0 : std::abs(glm::dot(n, model * (o / std::sqrt(o2))));
}

void setLobe(const MaterialInputs& m, const Corners& corners, const Frame& frame, const glm::vec4& b, SurfacePoint& p) {
  const scene::MaterialFactors& f = m.factors;
  float roughness = b.a * f.roughness;
  if (f.metalRoughMap) {
    const glm::vec4 mr = lookUp(m, 3, corners);
    // Below 0.01 it is plain plastic, as encodeMetalness has it. Map B's alpha holds only the spread of its normals.
    const float metal = mr.b * f.metalness, rough = mr.g * f.roughness, spread = f.mapB ? b.a : 0.0f;
    p.substance = metal >= 0.01f ? 0.4f + 0.6f * metal : 1.0f / 3;
    roughness = std::sqrt(std::sqrt(rough * rough * rough * rough + spread * spread * spread * spread));
  }
  p.alpha = f32::alphaFromRoughness(std::clamp(roughness, BURNISH_ROUGHNESS_MIN, 1.0f));
  p.brushed = f.brushed != glm::vec2(0) && !f.unlit;
  p.alphaX = p.alpha;
  p.tangent = glm::vec3(0);
  if (!p.brushed) return;
  const glm::vec3 t(frame.tangent), across = glm::cross(frame.normal, t) * frame.tangent.w;
  p.tangent = t * f.brushed.x + across * f.brushed.y;
  p.alphaX = f32::alphaOfStrength2(p.alpha, glm::length(f.brushed));
}

void setPassage(const MaterialInputs& m, const Part& part, SurfacePoint& p) {
  const scene::MaterialFactors& f = m.factors;
  p.passage = m.glass ? Passage::Pane : f.blend ? Passage::Blend : Passage::Opaque;
  p.pigment = p.passage == Passage::Blend ? f.opacity : 1;
  p.transmission = m.glass ? f.transmission : 0;
  p.ior = m.glass ? f.ior : 0;
  p.absorption = m.glass ? f.absorption : glm::vec3(0);
  p.thickness = m.glass && f.thickness > 0 ? f.thickness * meshScale(part.model, p.normal) : 0;
  if (p.thickness > 0) p.passage = Passage::Body;
  else if (m.glass && p.alpha > kClearAlpha) p.passage = Passage::Frosted;
  p.open = p.passage == Passage::Body && part.open;
}

}  // namespace

// The plane of the triangle seen through the next pixel, and where that lies in the texture.
void World::Parts::footprints(const PathRay& ray, const Part& part, const reference::Hit& hit, Corners& corners) const {
  const glm::dvec3 p0 = geometry.corner(part, hit.triangle, 0), e1 = geometry.corner(part, hit.triangle, 1) - p0, e2 = geometry.corner(part, hit.triangle, 2) - p0;
  const glm::dvec3 n = glm::cross(e1, e2), here = ray.origin + ray.direction * hit.distance;
  const double n2 = glm::dot(n, n);
  if (!(n2 > 0)) return;
  const glm::dvec3 forward = camera.forward();
  const bool flat = camera.frame().orthographic;
  const glm::vec2* uv[2] = {part.mesh->uv0.empty() ? nullptr : part.mesh->uv0.data(), part.mesh->uv1.empty() ? nullptr : part.mesh->uv1.data()};
  const std::uint32_t* i = part.indices().data() + std::size_t(hit.triangle) * 3;
  for (int axis = 0; axis < 2; ++axis) {
    const glm::dvec3 across = axis == 0 ? ray.acrossX : ray.acrossY;
    const glm::dvec3 o = flat ? ray.origin + across : ray.origin, d = flat ? forward : ray.direction / glm::dot(ray.direction, forward) + across;
    const double slope = glm::dot(n, d);
    const glm::dvec3 moved = o + d * (glm::dot(n, p0 - o) / slope) - here;
    // In shares of the two edges (dual basis of the triangle's plane).
    const double a = glm::dot(glm::cross(moved, e2), n) / n2, b = glm::dot(glm::cross(e1, moved), n) / n2;
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    for (std::size_t set = 0; set < 2; ++set) {
      if (!uv[set]) continue;
      const glm::vec2 change = (uv[set][i[1]] - uv[set][i[0]]) * float(a) + (uv[set][i[2]] - uv[set][i[0]]) * float(b);
      (axis == 0 ? corners.footprint[set].x : corners.footprint[set].y) = change;
    }
  }
}

bool World::Parts::surface(const PathRay& ray, const reference::Hit& hit, SurfacePoint& p) const {
  const Part& part = geometry.parts[hit.mesh];
  const MaterialInputs& m = geometry.materials[part.material];
  const scene::MaterialFactors& f = m.factors;
  Corners corners = cornersAt(part, hit.triangle, hit.barycentric);
  if (ray.camera) footprints(ray, part, hit, corners);
  if (!solidAt(m, corners)) return false;

  p.distance = hit.distance;
  p.position = ray.origin + ray.direction * hit.distance;
  p.back = hit.back;
  p.twoSided = m.twoSided;
  p.instance = part.instance;
  const glm::vec3 triangle(hit.normal);
  p.geometric = hit.normal == glm::dvec3(0) ? glm::vec3(-ray.direction) : hit.back ? -triangle : triangle;

  const glm::vec4 a = lookUp(m, 0, corners), b = lookUp(m, 1, corners);
  p.albedo = glm::vec3(a) * f.albedo;
  if (f.vertexColor) p.albedo *= glm::vec3(corners.color);
  p.albedo = glm::clamp(p.albedo, glm::vec3(0), glm::vec3(1));
  p.substance = std::clamp(a.a * f.codeScale + f.codeBias, 0.0f, 1.0f);

  // 128 is zero: 8-bit normal maps hold flat as (128, 128, 255).
  glm::vec3 mapped = glm::vec3(b) * (255.0f / 127) - 128.0f / 127;
  if (m.packed) mapped.z = std::sqrt(std::max(1 - mapped.x * mapped.x - mapped.y * mapped.y, 0.0f));
  const Frame frame = frameAt(part, hit);
  p.normal = shadingNormal(frame, mapped, p);
  setLobe(m, corners, frame, b, p);
  p.eta = f.eta;
  p.k = f.k;
  p.sigma = f.unlit ? 0 : f.sigma;
  p.unlit = f.unlit;

  const bool shows = m.emits && (!hit.back || m.twoSided);
  p.emission = shows ? emissionAt(m, corners) : glm::vec3(0);
  p.emitter = shows ? emitters.of(hit.mesh, hit.triangle) : -1;
  p.coverage = coverageAt(m, corners);
  setPassage(m, part, p);
  return true;
}

}  // namespace burnish::pathtrace
