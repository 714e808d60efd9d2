#include "pathtrace/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pathtrace/world_parts.h"
#include "plan/rungs.h"

namespace burnish::pathtrace {
namespace {

PunctualLight localOf(const scene::LocalLight& l, const Light& light, const glm::dvec3& eye) {
  PunctualLight p;
  p.position = eye + glm::dvec3(l.position);
  p.power = l.intensity;
  p.invRange4 = light.range > 0 && std::isfinite(light.range) ? l.invRange4 : 0;
  p.spot = light.kind == LightKind::Spot;
  p.axis = l.axis;
  p.spotScale = l.spotScale;
  p.spotOffset = l.spotOffset;
  p.radius = l.sourceRadius;
  p.castsShadow = l.castsShadow;
  return p;
}

// As the renderer has them, but for the end of lights without a range; what it says of that end would not be true here.
std::vector<PunctualLight> lightsOf(const Scene& scene, const scene::Derived& derived, const scene::ViewFrame& frame, const Quality& quality) {
  Report unsaid;
  const scene::LightSet set = scene::gatherLights(scene, derived, frame, quality, unsaid, scene::Reach::Everywhere);
  std::vector<PunctualLight> out;
  for (const scene::DirectionalLight& l : set.directional) {
    if (scene.lights.get(l.id)->standIn) continue;
    PunctualLight p;
    p.directional = true;
    p.toLight = l.toLight;
    p.power = l.illuminance;
    p.angularDiameter = l.angularDiameter;
    p.castsShadow = l.castsShadow;
    out.push_back(p);
  }
  for (const scene::LocalLight& l : set.local)
    if (const Light& light = *scene.lights.get(l.id); !light.standIn) out.push_back(localOf(l, light, frame.eye));
  return out;
}

shading::Rungs rungsOf(const Quality& quality) {
  shading::Rungs k = plan::rungsOf(quality);
  k.anisotropic = plan::drawsBrushed(quality);
  k.roughDiffuse = quality.roughDiffuse != RoughDiffuse::None;
  return k;
}

}  // namespace

World::World(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

Result<World> World::create(const Scene& scene, const View& view, const Quality& quality, glm::ivec2 size, Report& report) {
  scene::Derived derived;
  derived.update(scene, &report);
  auto geometry = Geometry::create(scene, derived, report);
  if (!geometry) return fail(geometry.error());
  auto surroundings = Surroundings::create(scene.environment);
  if (!surroundings) return fail(surroundings.error());
  const Camera camera(view, size);
  std::vector<PunctualLight> lights = lightsOf(scene, derived, camera.frame(), quality);
  FogBefore fog(scene, *surroundings, lights, report);
  Emitters emitters(*geometry);
  const double gap = 8 * geometry->rays.rounding();
  return World(std::make_unique<Parts>(Parts{std::move(*geometry), camera, rungsOf(quality), std::move(*surroundings), scene.environment.background, scene.environment.sun, std::move(lights),
                                             std::move(emitters), std::move(fog), gap}));
}

const shading::Rungs& World::rungs() const { return parts_->rungs; }
PathRay World::cameraRay(glm::dvec2 pixel) const { return parts_->camera.ray(pixel); }

glm::vec3 World::background(const PathRay& ray) const {
  glm::vec3 c = parts_->background ? parts_->surroundings.radiance(glm::vec3(ray.direction)) : glm::vec3(0);
  if (parts_->background && parts_->sun) c += parts_->camera.sunDisc(*parts_->sun, ray.direction);
  return c;
}

bool World::foggy() const { return parts_->fog.there(); }
FogShare World::fog(const PathRay& ray, double distance) const { return parts_->fog.share(ray, distance); }

bool World::nearest(const PathRay& ray, SurfacePoint& point) const {
  reference::Ray r{ray.origin, ray.direction, ray.from};
  r.cull = ray.camera;
  const double end = ray.camera ? parts_->camera.end(ray) : std::numeric_limits<double>::infinity();
  // Each hole takes the ray a little farther, so that it comes to an end.
  for (;;) {
    const reference::Hit hit = parts_->geometry.rays.nearest(r);
    if (!hit || hit.distance > end) return false;
    if (parts_->surface(ray, hit, point)) return true;
    r.from = std::max(hit.distance, r.from) * (1 + 1e-6) + parts_->gap;
  }
}

PathRay World::leave(const SurfacePoint& point, const glm::vec3& direction) const {
  PathRay r;
  r.direction = glm::normalize(glm::dvec3(direction));
  r.origin = parts_->off(point, r.direction);
  return r;
}

PathRay World::past(const PathRay& ray, const SurfacePoint& point) const {
  PathRay r = ray;
  r.from = std::max(point.distance, ray.from) * (1 + 1e-6) + parts_->gap;
  return r;
}

glm::vec3 World::crossing(const SurfacePoint& point, const glm::vec3& toRay) const { return parts_->crossing(point, toRay); }

glm::vec3 World::transmittance(const SurfacePoint& from, const glm::dvec3& to, Bodies bodies) const {
  const glm::dvec3 origin = parts_->off(from, to - from.position), way = to - origin;
  const double length = glm::length(way);
  if (!(length > 0) || !std::isfinite(length)) return glm::vec3(1);
  return parts_->transmittance(origin, way / length, length * (1 - 1e-6) - 2 * parts_->gap, bodies);
}

glm::vec3 World::transmittanceAlong(const SurfacePoint& from, const glm::vec3& direction, Bodies bodies) const {
  const glm::dvec3 d = glm::normalize(glm::dvec3(direction));
  return parts_->transmittance(parts_->off(from, d), d, std::numeric_limits<double>::infinity(), bodies);
}

std::span<const PunctualLight> World::lights() const { return parts_->lights; }
bool World::hasEmitters() const { return !parts_->emitters.empty(); }
bool World::sampleEmitter(const glm::dvec3& at, float pick, const glm::vec2& place, EmitterSample& sample) const { return parts_->emitters.sample(parts_->geometry, at, pick, place, sample); }
float World::emitterDensity(std::int32_t emitter) const { return parts_->emitters.density(emitter); }
bool World::hasEnvironment() const { return parts_->surroundings.lit(); }
glm::vec3 World::environment(const glm::vec3& direction) const { return parts_->surroundings.radiance(direction); }
EnvironmentSample World::sampleEnvironment(const glm::vec2& place) const { return parts_->surroundings.sample(place); }
float World::environmentDensity(const glm::vec3& direction) const { return parts_->surroundings.density(direction); }

}  // namespace burnish::pathtrace
