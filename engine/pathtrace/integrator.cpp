#include "pathtrace/integrator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pathtrace/glass.h"

namespace burnish::pathtrace {

using glm::dvec3;
using glm::vec3;

namespace {

/// From this many surfaces on a path goes on by chance, in proportion to what it still carries and at most in 19 of 20 cases, so that paths end where surfaces reflect more than they get.
constexpr int kSure = 4;
constexpr float kMostSurvival = 0.95f;

/// After a bounce that was less dense than this (per sr: the peak of a lobe of alpha 0.1), lobes are held at kHeldAlpha. What a narrow lobe throws on something wide (caustics) comes from lights
/// that no path meets by chance: without this a few samples in a million would bring all of it. It is blurred, and its energy kept (Kaplanyan and Dachsbacher 2013, "Path Space Regularization
/// for Holistic and Robust Light Transport", section 4). The surface that is seen, what is seen in mirrors and what glass refracts stay as they are.
constexpr float kWide = 8, kHeldAlpha = 0.25f;

/// Lobes without a normalization never reflect more than F0 toward a light: narrow ones need no holding, and would not keep their energy.
float heldAlpha(const shading::Rungs& k) {
  const bool bare = k.specular == SPECULAR_MICROFACET && k.distribution == DISTRIBUTION_BLINN_PHONG && k.geometry == GEOMETRY_VOID && k.normalization == NORMALIZATION_NONE;
  return bare || k.specular == SPECULAR_PHONG || k.specular == SPECULAR_BLINN_PHONG ? 0 : kHeldAlpha;
}

bool finite(const vec3& c) { return std::isfinite(c.x + c.y + c.z); }

}  // namespace

/// A path on its way.
struct Integrator::Path {
  PathRay ray;
  Sampler& sampler;
  dvec3& direct;
  Features& features;
  dvec3 sum{0};
  vec3 throughput{1};
  int bounces = 0, surfaces = 0;
  float density = 0;           ///< with which a surface sent the ray; 0: what it meets counts in full
  dvec3 from{0};               ///< where that surface is
  bool wide = false;           ///< something wide sent it, or a surface before
  bool inside = false;         ///< in a body of glass
  vec3 absorption{0};          ///< of it, 1/m
  float index = 1;             ///< of it
  float fogged = 1;            ///< camera's ray: fog's `through` up to where it stands

  void add(const vec3& light, bool withoutBounce) {
    if (!finite(light)) return;
    sum += light;
    if (withoutBounce) direct += light;
  }
};

Integrator::Integrator(const World& world, int bounces, Technique technique)
    : world_(&world), table_(world.rungs()), lights_(world.lights()), glows_(world), bounces_(bounces), technique_(technique), held_(heldAlpha(world.rungs())) {}

dvec3 Integrator::radiance(const PathRay& ray, Sampler& sampler, dvec3& direct, Features& features) const {
  direct = dvec3(0);
  features = {};
  Path path{.ray = ray, .sampler = sampler, .direct = direct, .features = features};
  while (meet(path)) {
  }
  return path.sum;
}

// One surface of a path, or its end. false: it ends.
bool Integrator::meet(Path& path) const {
  SurfacePoint point;
  if (!world_->nearest(path.ray, point)) {
    meetSky(path);
    return false;
  }
  travel(path, point);
  ++path.surfaces;
  const vec3 toRay(-path.ray.direction);
  receiveEmission(path, point);
  const bool limited = bounces_ >= 0 && path.bounces > bounces_;
  if (point.unlit || (limited && point.passage == Passage::Opaque)) {
    if (path.ray.camera) path.features.albedo += path.throughput * glm::min(point.emission, 1.0f), path.features.normal += point.normal * luminance(path.throughput);
    return point.coverage < 1 || point.passage == Passage::Blend ? goStraight(path, point, toRay, 0) && survives(path) : false;
  }
  const Bsdf bsdf(point, toRay, world_->rungs(), table_, path.wide ? held_ : 0);
  const bool within = point.passage == Passage::Body && !point.open && point.back;
  if (path.ray.camera) {
    const vec3 kept = path.throughput * (1.0f - (point.passage == Passage::Opaque ? vec3(0) : world_->crossing(point, toRay)));
    path.features.albedo += kept * bsdf.layerAlbedo();
    path.features.normal += bsdf.surface().n * luminance(kept);
  }
  if (!limited && !within) path.add(path.throughput * point.coverage * lit(point, bsdf, path.sampler, path.bounces == 0), path.bounces == 0);
  if (point.passage != Passage::Opaque && goStraight(path, point, toRay, bsdf.albedoGuess() + luminance(bsdf.through()))) return survives(path);
  if (path.throughput == vec3(0)) return false;
  if (isGlass(point.passage) && point.passage != Passage::Pane && cross(path, point, bsdf)) return survives(path);
  if (limited) return false;
  return bounce(path, point, bsdf) && survives(path);
}

// Fog up to the surface, absorption in glass.
void Integrator::travel(Path& path, const SurfacePoint& point) const {
  if (path.ray.camera && world_->foggy()) {
    const FogShare fog = world_->fog(path.ray, point.distance);
    path.add(path.throughput * fog.source * ((path.fogged - fog.through) / std::max(path.fogged, 1e-30f)), true);
    path.throughput *= fog.through / std::max(path.fogged, 1e-30f);
    path.fogged = fog.through;
  }
  const bool within = point.passage == Passage::Body && !point.open && point.back;
  if (!path.inside && !within) return;
  const float way = float(glm::length(point.position - path.ray.origin));
  path.throughput *= shading::f32::absorbed(path.inside ? path.absorption : point.absorption, way);
}

void Integrator::meetSky(Path& path) const {
  const vec3 toSky(path.ray.direction);
  if (path.ray.camera) {
    float through = 1;
    if (world_->foggy()) {
      const FogShare fog = world_->fog(path.ray, std::numeric_limits<double>::infinity());
      path.add(path.throughput * fog.source * ((path.fogged - fog.through) / std::max(path.fogged, 1e-30f)), true);
      through = fog.through / std::max(path.fogged, 1e-30f);
    }
    path.add(path.throughput * through * world_->background(path.ray), true);
    return;
  }
  if (!world_->hasEnvironment()) return;
  // A body that was entered and never left has a mesh with holes: nothing is gained or lost by its index.
  const float scale = path.inside ? path.index * path.index : 1;
  const float w = path.density > 0 ? weight(path.density, world_->environmentDensity(toSky), true) : 1;
  path.add(path.throughput * (scale * w) * world_->environment(toSky), path.bounces <= 1);
}

void Integrator::receiveEmission(Path& path, const SurfacePoint& point) const {
  if (point.emission == vec3(0)) return;
  float w = 1;
  if (path.density > 0 && point.emitter >= 0) {
    const dvec3 way = point.position - path.from;
    const double d2 = glm::dot(way, way), cosine = std::abs(glm::dot(path.ray.direction, dvec3(point.geometric)));
    w = weight(path.density, cosine > 0 ? float(world_->emitterDensity(point.emitter) * d2 / cosine) : 0, true);
  }
  path.add(path.throughput * (point.coverage * w) * point.emission, path.bounces <= 1);
}

// What crosses without being turned goes on by chance, by its share. true: the path goes on straight; false: it meets the surface, whose share is in the throughput then (0: there is none).
bool Integrator::goStraight(Path& path, const SurfacePoint& point, const vec3& toRay, float reflects) const {
  const bool clear = point.passage == Passage::Blend || point.passage == Passage::Pane;
  const vec3 straight = clear ? world_->crossing(point, toRay) : vec3(1 - point.coverage);
  const float share = luminance(straight), other = point.coverage * reflects;
  if (!(share > 0)) {
    path.throughput *= point.coverage;
    return false;
  }
  const float chance = other > 0 ? std::clamp(share / (share + other), 0.05f, 0.95f) : 1;
  if (path.sampler.next() < chance) {
    path.throughput *= straight / chance;
    path.ray = world_->past(path.ray, point);
    return true;
  }
  path.throughput *= chance < 1 ? point.coverage / (1 - chance) : 0;
  return false;
}

// Glass that turns light: crosses it by chance. true: the path goes on, through it (or, from inside, back into it).
bool Integrator::cross(Path& path, const SurfacePoint& point, const Bsdf& bsdf) const {
  Crossed crossed;
  if (point.passage == Passage::Body && !point.open && point.back) {
    crossed = meetFromInside(point, bsdf, path.sampler);
    if (crossed.into) ++path.bounces;
    if (bounces_ >= 0 && path.bounces > bounces_ + 1) crossed.share = vec3(0);
  } else {
    const float through = luminance(bsdf.through()) * (1 - faceReflectance(point, bsdf.surface().nov)), reflects = bsdf.albedoGuess();
    if (!(through > 0)) return false;
    const float chance = reflects > 0 ? std::clamp(through / (through + reflects), 0.05f, 0.95f) : 1;
    if (path.sampler.next() >= chance) {
      path.throughput *= chance < 1 ? 1 / (1 - chance) : 0;
      return false;
    }
    crossed = point.passage == Passage::Body && !point.open ? enter(point, bsdf, path.sampler) : crossPane(point, bsdf, path.sampler);
    crossed.share /= chance;
  }
  path.throughput *= crossed.share;
  path.ray = world_->leave(point, crossed.direction);
  path.ray.origin += crossed.shift;
  path.density = 0;
  if (point.passage != Passage::Body || point.open) return true;
  path.inside = crossed.into;
  path.absorption = point.absorption;
  path.index = indexOf(point);
  return true;
}

// Wide lobes, on the first bounces: later ones carry little, and narrow ones find what they mirror.
bool Integrator::looksForGlows(const Path& path, const Bsdf& bsdf) const {
  return !glows_.empty() && technique_ == Technique::Both && path.bounces < 2 && !path.inside && bsdf.spread() > 0.2f;
}

bool Integrator::bounce(Path& path, const SurfacePoint& point, const Bsdf& bsdf) const {
  vec3 toLight;
  float pick = path.sampler.next();
  const glm::vec2 place = path.sampler.next2();
  Glows::Cones cones;
  if (looksForGlows(path, bsdf)) cones = glows_.from(point.position, point.geometric);
  const float share = cones.count > 0 ? Glows::kShare : 0;
  if (pick < share) {
    toLight = Glows::sample(cones, pick / share, place);
  } else {
    pick = std::min((pick - share) / (1 - share), 0.99999994f);
    if (!bsdf.sample(pick, place, toLight)) return false;
  }
  const Reflected r = bsdf.reflected(toLight);
  const float density = (1 - share) * r.density + (share > 0 ? share * Glows::density(cones, toLight) : 0);
  if (!(r.density > 0) || r.value == vec3(0)) return false;
  path.throughput *= r.value / density;
  path.ray = world_->leave(point, toLight);
  path.density = r.density;  // as lit() weighs it
  path.wide = path.wide || r.density < kWide;
  path.from = point.position;
  ++path.bounces;
  return true;
}

// Russian roulette. What is left of a path that goes on is divided by the chance, which is never above kMostSurvival.
bool Integrator::survives(Path& path) const {
  const float carries = largest(path.throughput);
  if (!(carries > 0) || !std::isfinite(carries)) return false;
  if (path.surfaces < kSure) return true;
  const float chance = std::min(carries, kMostSurvival);
  if (path.sampler.next() >= chance) return false;
  path.throughput /= chance;
  return true;
}

float Integrator::weight(float own, float other, bool surface) const {
  if (technique_ != Technique::Both && other > 0) return surface == (technique_ == Technique::Surfaces) ? 1.0f : 0.0f;
  return powerHeuristic(own, other);
}

}  // namespace burnish::pathtrace
