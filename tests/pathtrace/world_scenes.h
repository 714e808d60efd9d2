// Small scenes for the tests of the path tracer's world and film.
#pragma once
#include <burnish/measure.h>

#include "pathtrace/world.h"

namespace burnish::test {

/// One colour, RGBA.
inline Image plain(int width, int height, std::array<std::uint8_t, 4> rgba) {
  Image image = makeImage(width, height, 4, PixelType::U8);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.u8()[i] = rgba[i % 4];
  return image;
}
inline Id<Texture> addTexture(Scene& scene, MapKind kind, Image image, const Sampler& sampler = {}) {
  return scene.textures.add({.name = "map", .kind = kind, .sampler = sampler, .image = std::move(image)});
}

/// Unit half edges around the origin in the plane z = 0, seen from +z; u grows toward +x, v toward -y, as pictures lie.
inline Mesh panel(float half = 1) {
  Mesh m{.name = "panel", .positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}};
  m.normals.assign(4, glm::vec3(0, 0, 1));
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}
inline Id<Instance> add(Scene& scene, Mesh mesh, const Material& material, const glm::dmat4& local = glm::dmat4(1)) {
  const Id<Node> node = scene.nodes.add({.local = local});
  return scene.instances.add({.name = mesh.name, .node = node, .mesh = scene.meshes.add(std::move(mesh)), .material = scene.materials.add(material)});
}
inline glm::dmat4 moved(const glm::dvec3& by) {
  glm::dmat4 m(1);
  m[3] = glm::dvec4(by, 1);
  return m;
}
inline pathtrace::World worldOf(const Scene& scene, const Quality& quality = {}, const View& view = lookAt({0, 0, 4}, {0, 0, 0}), glm::ivec2 size = {32, 32}) {
  Report report;
  auto made = pathtrace::World::create(scene, view, quality, size, report);
  if (!made) FAIL(made.error().message());
  return std::move(*made);
}
inline pathtrace::PathRay toward(const glm::dvec3& origin, const glm::dvec3& to) { return {.origin = origin, .direction = glm::normalize(to - origin)}; }
/// What a ray meets; the test fails where that is nothing.
inline pathtrace::SurfacePoint met(const pathtrace::World& world, const pathtrace::PathRay& ray) {
  pathtrace::SurfacePoint p;
  REQUIRE(world.nearest(ray, p));
  return p;
}

}  // namespace burnish::test
