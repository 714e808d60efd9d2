// One scene for every material field: a floor, a wall seen from behind, a sphere and a box that share the material under test, beside a plain sphere; directional, point and
// spot lights and an environment with a bright side.
#pragma once
#include "render/scenes.h"

namespace burnish::test {

/// A texture from f(u, v) in bytes.
template <class F>
Texture painted(MapKind kind, int size, F&& f) {
  Texture t;
  t.kind = kind;
  t.image = makeImage(size, size, 4, PixelType::U8);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec4 texel = f((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
      for (int c = 0; c < 4; ++c) t.image.u8()[(y * size + x) * 4 + c] = std::uint8_t(std::lround(std::clamp(texel[c], 0.0f, 1.0f) * 255));
    }
  return t;
}

/// A second uv set that is not the first, and a colour at each vertex (its alpha under 0.5 in places).
inline Mesh enriched(Mesh m) {
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    const vec3 p = m.positions[i];
    m.uv1.push_back({m.uv0[i].y * 1.7f + 0.1f, m.uv0[i].x * 0.6f + 0.3f});
    m.colors.emplace_back(0.6f + 0.4f * std::sin(5 * p.x), 0.5f + 0.4f * std::sin(7 * p.y), 0.3f + 0.2f * std::cos(4 * p.z), 0.55f + 0.4f * std::sin(6 * p.x + 5 * p.y));
  }
  return m;
}

struct Workshop {
  Scene scene;
  Id<Texture> albedo, substance, plastic, normals, roughness, occlusion, metalRough, emissive;
  Id<Material> material;
  std::vector<Id<Instance>> objects;
  View view = lookAt({0.4, 1.5, 4.2}, {0, -0.05, 0}, {0, 1, 0}, 0.6f);

  Workshop() {
    paint();
    material = scene.materials.add(base());
    Mesh floor = box({-2, -0.9f, -2}, {2, -0.85f, 2});
    for (glm::vec2& uv : floor.uv0) uv = uv * 3.0f;
    add(enriched(floor));
    add(enriched(sphere(0.7f, 48, 96)), translation({-0.6, 0, 0.2}));
    glm::dmat4 turned = glm::dmat4(glm::dmat3(glm::dvec3(0.8, 0, -0.6), glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0, 0.8)));
    turned[3] = glm::dvec4(0.9, -0.35, 0.4, 1);
    add(enriched(box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f})), turned);
    add(enriched(quad({0, 0.8f, -1.2f}, {-1.4f, 0, 0}, {0, 0.6f, 0})));  // it faces away from the eye
    Material other;
    other.albedo = {0.3f, 0.5f, 0.2f};
    other.roughness = 0.6f;
    place(scene, sphere(0.3f, 32, 64), other, translation({0.3, -0.5, 1.2}));
    light();
  }
  static Material base() {
    Material m;
    m.albedo = {0.7f, 0.5f, 0.4f};
    m.roughness = 0.5f;
    m.useVertexColor = false;
    return m;
  }
  /// The picture with another material on the objects.
  template <class F>
  void setMaterial(F&& f) {
    Material m = base();
    f(m);
    *scene.materials.edit(material) = m;
  }

 private:
  void add(Mesh mesh, const glm::dmat4& local = glm::dmat4(1)) {
    Instance instance;
    instance.mesh = scene.meshes.add(std::move(mesh));
    instance.material = material;
    instance.node = addNode(scene, local);
    objects.push_back(scene.instances.add(instance));
  }
  void paint() {
    const auto wave = [](float x) { return 0.5f + 0.5f * std::sin(6.2831853f * x); };
    albedo = scene.textures.add(painted(MapKind::AlbedoSubstance, 32, [&](float u, float v) { return vec4(0.55f + 0.4f * wave(2 * u), 0.4f + 0.4f * wave(3 * v), 0.6f, 1.0f / 3); }));
    substance = scene.textures.add(painted(MapKind::AlbedoSubstance, 32, [&](float u, float v) { return vec4(0.9f, 0.75f, 0.6f, 0.1f + 0.9f * wave(u + v)); }));
    plastic = scene.textures.add(painted(MapKind::AlbedoSubstance, 32, [&](float, float) { return vec4(0.9f, 0.75f, 0.6f, 1.0f / 3); }));
    normals = scene.textures.add(painted(MapKind::NormalRoughness, 64, [&](float u, float v) {
      const vec3 n = glm::normalize(vec3(0.4f * std::sin(12.566f * u), 0.3f * std::sin(18.85f * v), 1));
      return vec4(n * (127.0f / 255) + 128.0f / 255, 1);
    }));
    roughness = scene.textures.add(painted(MapKind::NormalRoughness, 32, [&](float u, float v) { return vec4(128 / 255.0f, 128 / 255.0f, 1, 0.75f + 0.25f * wave(2 * u - v)); }));
    occlusion = scene.textures.add(painted(MapKind::Occlusion, 32, [&](float u, float v) { return vec4(0.2f + 0.8f * wave(u), wave(3 * u) * wave(2 * v) > 0.2f ? 1.0f : 0.0f, 0, 0); }));
    metalRough = scene.textures.add(painted(MapKind::MetalRough, 32, [&](float u, float v) { return vec4(0, 0.6f + 0.4f * wave(v), wave(2 * u), 1); }));
    emissive = scene.textures.add(painted(MapKind::Emissive, 32, [&](float u, float v) { return vec4(wave(u), wave(2 * v), 0.3f, 1); }));
  }
  void light() {
    using test::light;
    addLight(scene, light(LightKind::Directional, {1, 0.9f, 0.8f}, 40), {0, 0, 0}, {-0.5, -1, -0.6});
    addLight(scene, light(LightKind::Directional, {0.3f, 0.4f, 0.6f}, 25), {0, 0, 0}, {0.8, -0.3, 0.5});
    addLight(scene, light(LightKind::Point, {1, 0.5f, 0.3f}, 20, 3), {-1.2, 0.9, 1.3});
    addLight(scene, light(LightKind::Point, {0.3f, 0.6f, 1}, 15, 2.5f), {1.4, 0.6, 1.2});
    addLight(scene, light(LightKind::Point, {0.5f, 1, 0.5f}, 8), {0.2, 1.2, -0.6});
    for (int i = 0; i < 9; ++i) addLight(scene, light(LightKind::Point, {1, 0.8f, 0.6f}, 1.5f, 0.9f), {-1.8 + 0.45 * i, -0.6, 1.6 - 0.2 * i});
    Light spot = light(LightKind::Spot, {1, 1, 0.7f}, 60, 6);
    spot.innerCone = 0.2f;
    spot.outerCone = 0.5f;
    addLight(scene, spot, {0.5, 2.5, 1.5}, {-0.1, -1, -0.5});
    spot.outerCone = 0.35f;
    addLight(scene, spot, {-2, 1.5, 1}, {1, -0.8, -0.5});
    Image& map = scene.environment.map;
    map = makeImage(32, 16, 3, PixelType::F32);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c) map.f32()[(y * 32 + x) * 3 + c] = float(2 + 2 * std::cos(0.2 * (x - 20)) + (y < 8 ? 3 - c : 0.3 * c));
    scene.environment.background = false;
    ++scene.environment.revision;
  }
};

}  // namespace burnish::test
