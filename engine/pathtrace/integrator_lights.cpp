// What a surface reflects of lights that are sampled: punctual ones, emissive surfaces, surroundings.
#include <algorithm>
#include <cmath>

#include "pathtrace/integrator.h"

namespace burnish::pathtrace {

using glm::dvec3;
using glm::vec3;

namespace {

constexpr int kLooks = 6;  // places on emitters, where a surface is seen

}  // namespace

vec3 Integrator::lit(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler, bool first) const {
  vec3 sum(0);
  for (const std::uint32_t i : lights_.directional()) {
    const PunctualLight& light = world_->lights()[i];
    sum += litByLight(point, bsdf, light, receive(light, point.position), sampler);
  }
  if (lights_.hasLocal()) {
    const LightPicker::Pick pick = lights_.pick(point.position, bsdf, sampler.next());
    if (pick.light) sum += litByLight(point, bsdf, *pick.light, pick.received, sampler) / pick.chance;
  }
  if (technique_ == Technique::Surfaces) return sum;
  if (world_->hasEmitters()) sum += litByEmitter(point, bsdf, sampler, first ? kLooks : 1);
  if (world_->hasEnvironment()) sum += litBySky(point, bsdf, sampler);
  return sum;
}

// The light arrives as from its middle; its size makes shadows soft: their rays end on the disc that it shows to the point. What of the disc lies below the triangle is hidden by it.
vec3 Integrator::litByLight(const SurfacePoint& point, const Bsdf& bsdf, const PunctualLight& light, const Received& received, Sampler& sampler) const {
  const glm::vec2 u = light.castsShadow ? sampler.next2() : glm::vec2(0);
  if (received.irradiance == vec3(0)) return vec3(0);
  const vec3 value = bsdf.alone(received.toLight) * received.irradiance;
  if (!light.castsShadow || value == vec3(0)) return value;
  if (light.directional) {
    const vec3 toDisc = light.angularDiameter > 0 ? inCone(light.toLight, 0.5f * std::min(light.angularDiameter, 3.1415926f), u) : light.toLight;
    if (!(glm::dot(toDisc, point.geometric) > 0)) return vec3(0);
    return value * world_->transmittanceAlong(point, toDisc, Bodies::Straight);
  }
  const glm::vec2 disc = onDisc(u) * light.radius;
  const Frame frame(received.toLight);
  const dvec3 place = light.position + dvec3(frame.t * disc.x + frame.b * disc.y);
  if (!(glm::dot(place - point.position, dvec3(point.geometric)) > 0)) return vec3(0);
  return value * world_->transmittance(point, place, Bodies::Straight);
}

// One of `looks` places, chosen by what each would give if nothing stood between (resampling: Talbot, Cline and Egbert 2005, "Importance Resampling for Global Illumination"). Each is weighed as if
// it were alone, so the weights go with those of the paths that meet emitters by chance.
vec3 Integrator::litByEmitter(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler, int looks) const {
  vec3 chosen(0);
  dvec3 place(0);
  float sum = 0, chosenSize = 0;
  for (int i = 0; i < looks; ++i) {
    const float pick = sampler.next();
    const glm::vec2 where = sampler.next2();
    const float keep = looks > 1 ? sampler.next() : 0;
    EmitterSample light;
    if (!world_->sampleEmitter(point.position, pick, where, light)) continue;
    const vec3 value = fromEmitter(point, bsdf, light);
    const float size = luminance(value);
    if (!(size > 0) || !std::isfinite(size)) continue;
    sum += size;
    if (keep * sum < size) chosen = value, chosenSize = size, place = light.position;
  }
  if (!(sum > 0)) return vec3(0);
  return chosen * (sum / (chosenSize * float(looks))) * world_->transmittance(point, place, Bodies::Block);
}

// What a place on an emitter gives, shadows apart, over its density.
vec3 Integrator::fromEmitter(const SurfacePoint& point, const Bsdf& bsdf, const EmitterSample& light) const {
  const dvec3 way = light.position - point.position;
  const double d2 = glm::dot(way, way);
  if (!(d2 > 0) || !(light.density > 0)) return vec3(0);
  const vec3 toLight(way / std::sqrt(d2));
  const float cosine = -glm::dot(light.normal, toLight);
  if (!(cosine > 0)) return vec3(0);
  const Reflected r = bsdf.reflected(toLight);
  const float density = float(light.density * d2 / double(cosine));
  return std::isfinite(density) ? r.value * light.radiance * (weight(density, r.density, false) / density) : vec3(0);
}

vec3 Integrator::litBySky(const SurfacePoint& point, const Bsdf& bsdf, Sampler& sampler) const {
  const EnvironmentSample light = world_->sampleEnvironment(sampler.next2());
  if (!(light.density > 0)) return vec3(0);
  const Reflected r = bsdf.reflected(light.direction);
  const vec3 value = r.value * light.radiance * (weight(light.density, r.density, false) / light.density);
  if (value == vec3(0)) return vec3(0);
  return value * world_->transmittanceAlong(point, light.direction, Bodies::Block);
}

}  // namespace burnish::pathtrace
