#include "pathtrace/glass.h"

#include <algorithm>
#include <cmath>

#include "pathtrace/bsdf.h"

namespace burnish::pathtrace {

namespace f32 = shading::f32;
using glm::vec3;

float indexOf(const SurfacePoint& point) { return std::max(point.ior > 0 ? point.ior : f32::indexFromF0(f32::substanceDielectricF0(point.substance)), 1.0f); }

float faceReflectance(const SurfacePoint& point, float cosine) { return f32::dielectricReflectance(indexOf(point), cosine); }

vec3 paneThrough(float f, const vec3& tint) { return (1 - f) * (1 - f) * tint / glm::max(1.0f - f * f * tint * tint, 1e-6f); }
vec3 paneBack(float f, const vec3& tint) { return tint * paneThrough(f, tint); }

vec3 slabLeft(const SurfacePoint& point, float cosine) {
  if (point.passage != Passage::Body) return vec3(1);
  const float eta = indexOf(point), inside = std::sqrt(std::max(1 - (1 - cosine * cosine) / (eta * eta), 1e-6f));
  return f32::absorbed(point.absorption, point.thickness / inside);
}

Crossed enter(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) {
  const float eta = indexOf(point);
  Crossed out;
  const vec3 h = bsdf.facet(sampler);
  const float through = f32::refractSnell(bsdf.surface().v, h, eta, out.direction);
  out.direction = glm::normalize(out.direction);
  out.share = bsdf.through() * (through / (eta * eta));
  out.into = glm::dot(out.direction, point.geometric) < 0;
  // A facet so steep that the ray would stay outside, on a surface that is bent away: it goes in along the surface's own normal.
  if (!out.into) {
    f32::refractSnell(bsdf.surface().v, point.geometric, eta, out.direction);
    out.into = true;
  }
  return out;
}

Crossed meetFromInside(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) {
  const float eta = indexOf(point);
  const vec3 v = bsdf.surface().v, h = bsdf.facet(sampler), g = point.geometric;
  Crossed out;
  const float through = f32::refractSnell(v, h, 1 / eta, out.direction);
  const bool leaves = sampler.next() < through;
  if (leaves) out.share = vec3(eta * eta);
  else {
    out.direction = 2 * glm::dot(v, h) * h - v;
    out.share = vec3(1);
  }
  out.direction = glm::normalize(out.direction);
  out.into = !leaves;
  // On the wrong side of the triangle: mirrored on it, so that nothing is lost where the normals disagree.
  const float above = glm::dot(out.direction, g);
  if (leaves ? above > 0 : above < 0) out.direction -= 2 * above * g;
  return out;
}

Crossed crossPane(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) {
  const float eta = indexOf(point), nov = bsdf.surface().nov;
  const vec3 n = bsdf.surface().n, v = bsdf.surface().v;
  Crossed out;
  // A rough face reflects less toward grazing than a smooth one.
  const float reflects = f32::reflectedFit(f32::f0FromIndex(eta), faceReflectance(point, nov), bsdf.surface().alpha);
  out.share = paneThrough(reflects, bsdf.through() * slabLeft(point, nov));
  out.direction = -v;
  vec3 inside(0);
  for (int i = 0; i < 8; ++i) {
    vec3 leaves;
    f32::refractSnell(v, bsdf.facet(sampler), eta, inside);
    if (glm::dot(inside, n) < 0 && f32::refractSnell(-inside, n, 1 / eta, leaves) > 0 && glm::dot(leaves, point.geometric) < 0) {
      out.direction = glm::normalize(leaves);
      break;
    }
  }
  if (point.passage != Passage::Body) return out;
  // Where it leaves the far face, brought back to the surface along the way it goes on.
  f32::refractSnell(v, n, eta, inside);
  const glm::dvec3 normal(n), way = glm::dvec3(inside) * (double(point.thickness) / std::max(-double(glm::dot(inside, n)), 1e-4)), on(out.direction);
  const double along = std::min(glm::dot(on, normal), -1e-4);
  out.shift = way - on * (glm::dot(way, normal) / along);
  return out;
}

}  // namespace burnish::pathtrace
