// Scenes of which the light is known in closed form, and what the path tracer makes of it.
#pragma once
#include <burnish/plan.h>

#include <array>

#include "light_surfaces.h"
#include "pathtrace/integrator.h"

namespace burnish::test {

/// Rungs under which a surface of roughness 0 is Lambert's and nothing else: an unnormalized lobe of power 1e7 reflects 1e-6 of the light.
inline Quality lambertQuality() {
  Quality q;
  q.specular = Specular::BlinnPhong, q.fresnel = Fresnel::None, q.diffuse = Diffuse::Lambert;
  return q;
}

inline Material lambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0)) { return {.name = "lambert", .albedo = albedo, .substance = 0.4f, .roughness = 0, .emission = emission}; }

/// A rectangle through `middle` with the half edges u and v; its front is the side of u × v.
inline Mesh rectangle(const glm::vec3& middle, const glm::vec3& u, const glm::vec3& v) {
  Mesh m{.name = "rectangle", .positions = {middle - u - v, middle + u - v, middle + u + v, middle - u + v}, .indices = {0, 1, 2, 0, 2, 3}};
  m.normals.assign(4, glm::normalize(glm::cross(u, v)));
  return m;
}

/// A ball with smooth normals, fronts outward; its corners lie on it.
inline Mesh ball(const glm::vec3& middle, float radius, int rings) {
  Mesh m{.name = "ball"};
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= around; ++j) {
      const float theta = 3.14159265f * float(i) / float(rings), phi = 6.2831853f * float(j % around) / float(around);
      // The poles are one place each, so that the mesh is closed.
      const glm::vec3 n = i == 0 ? glm::vec3(0, 1, 0) : i == rings ? glm::vec3(0, -1, 0) : glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      m.positions.push_back(middle + radius * n);
      m.normals.push_back(n);
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < around; ++j) {
      const auto a = std::uint32_t(i * (around + 1) + j), b = a + std::uint32_t(around) + 1;
      if (i > 0) m.indices.insert(m.indices.end(), {a, b, a + 1});
      if (i < rings - 1) m.indices.insert(m.indices.end(), {a + 1, b, b + 1});
    }
  return m;
}

/// An axis-aligned box of flat faces; inward: one sees it from inside.
inline Mesh box(const glm::vec3& low, const glm::vec3& high, bool inward) {
  Mesh m{.name = "box"};
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const glm::vec3 half = 0.5f * (high - low), middle = 0.5f * (high + low);
      glm::vec3 n(0), u(0), v(0);
      n[axis] = side, u[(axis + 1) % 3] = half[(axis + 1) % 3], v[(axis + 2) % 3] = side * half[(axis + 2) % 3];
      Mesh face = rectangle(middle + n * half, inward ? v : u, inward ? u : v);
      for (std::uint32_t i : face.indices) m.indices.push_back(i + std::uint32_t(m.positions.size()));
      m.positions.insert(m.positions.end(), face.positions.begin(), face.positions.end());
      m.normals.insert(m.normals.end(), face.normals.begin(), face.normals.end());
    }
  return m;
}

struct Setting {
  Scene scene;
  Id<Node> root;
  Setting() : root(scene.nodes.add({})) {}
  Id<Instance> add(const Mesh& mesh, const Material& material) {
    return scene.instances.add({.name = mesh.name, .node = root, .mesh = scene.meshes.add(mesh), .material = scene.materials.add(material)});
  }
  /// A light whose node turns its -Z along `shines` at `place`.
  void light(Light light, const glm::dvec3& place, const glm::dvec3& shines) {
    const glm::dvec3 z = -glm::normalize(shines), x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), z)), y = glm::cross(z, x);
    light.node = scene.nodes.add({.local = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(place, 1))});
    scene.lights.add(light);
  }
  [[nodiscard]] pathtrace::World world(const Quality& quality) const {
    Report report;
    auto made = pathtrace::World::create(scene, lookAt({0, 0, 5}, {0, 0, 0}), quality, {16, 16}, report);
    REQUIRE(made.has_value());
    return std::move(*made);
  }
};

/// From a point toward another.
inline pathtrace::PathRay rayFrom(const glm::dvec3& origin, const glm::dvec3& to) { return {.origin = origin, .direction = glm::normalize(to - origin)}; }

struct Seen {
  std::array<Mean, 3> light, direct;
  [[nodiscard]] double value(int channel = 0) const { return light[std::size_t(channel)].value(); }
  [[nodiscard]] double error(int channel = 0) const { return light[std::size_t(channel)].error(); }
};

/// Samples along a ray. Groups of samples are spread evenly: their means are what is independent.
inline Seen see(const pathtrace::World& world, const pathtrace::PathRay& ray, int samples, int bounces = -1, pathtrace::Technique technique = pathtrace::Technique::Both, std::uint64_t seed = 1) {
  const pathtrace::Integrator integrator(world, bounces, technique);
  Seen seen;
  for (int group = 0; group < samples / pathtrace::Sampler::kGroup; ++group) {
    glm::dvec3 sum(0), direct(0);
    for (int i = 0; i < pathtrace::Sampler::kGroup; ++i) {
      pathtrace::Sampler sampler(seed, 7, std::uint32_t(group * pathtrace::Sampler::kGroup + i));
      glm::dvec3 d(0);
      pathtrace::Features features;
      sum += integrator.radiance(ray, sampler, d, features);
      direct += d;
    }
    for (int c = 0; c < 3; ++c) seen.light[std::size_t(c)].add(sum[c] / pathtrace::Sampler::kGroup), seen.direct[std::size_t(c)].add(direct[c] / pathtrace::Sampler::kGroup);
  }
  return seen;
}

/// Within 3 standard errors, which are at most a hundredth of it, and what the geometry's or a table's own error allows.
inline void checkSeen(const Mean& seen, double exact, double slack = 1e-4) {
  CAPTURE(seen.value(), seen.error(), exact);
  CHECK(seen.error() <= 0.01 * exact + 1e-9);
  CHECK(std::abs(seen.value() - exact) <= 3 * seen.error() + slack * exact);
}

}  // namespace burnish::test
