// Structured bindings list every member of what they hash: a new one does not compile until it is looked at here.
#include "scene/scene_hash.h"

namespace burnish::scene {
namespace {

using core::Hash128;
using core::Hasher;

template <class V>
  requires requires { V::length(); }
void add(Hasher& h, const V& v) {
  for (int i = 0; i < V::length(); ++i)
    if constexpr (requires { v[i].x; }) add(h, v[i]);
    else h.value(v[i]);
}
void add(Hasher& h, const Image& image) {
  const auto& [width, height, channels, type, data] = image;
  h.value(width), h.value(height), h.value(channels), h.value(type);
  h.list(std::span(data));
}
void add(Hasher& h, const Sampler& sampler) {
  const auto& [wrapU, wrapV, magnifyLinear, minifyLinear, mipLinear, mips] = sampler;
  h.value(wrapU), h.value(wrapV), h.value(magnifyLinear), h.value(minifyLinear), h.value(mipLinear), h.value(mips);
}
void add(Hasher& h, const UvMapping& mapping) {
  const auto& [set, transform] = mapping;
  h.value(set);
  add(h, transform);
}
template <class T>
void addList(Hasher& h, const std::vector<T>& values) {
  h.list(std::span<const T>(values));
}

template <class T, class F>
Hash128 kept(std::unordered_map<std::uint32_t, Hash128>& known, const Table<T>& table, Id<T> id, F&& fill) {
  const T* row = table.get(id);
  if (!row) return {};
  const auto [place, fresh] = known.try_emplace(id.index);
  if (fresh) {
    Hasher h;
    fill(h, *row);
    place->second = h.finish();
  }
  return place->second;
}

}  // namespace

Hash128 hashOf(const Environment& environment) {
  const auto& [map, color, scale, background, revision, sun, filterSize, filterError] = environment;
  (void)revision;  // counts changes, which the content tells
  Hasher h;
  add(h, map), add(h, color), h.value(scale), h.value(background), h.value(filterSize), h.value(filterError), h.value(sun.has_value());
  if (sun) {
    const auto& [toSun, radiance, radius, horizon] = *sun;
    add(h, toSun), add(h, radiance), h.value(radius), h.value(horizon);
  }
  return h.finish();
}

Hash128 hashOf(const Fog& fog) {
  const auto& [density, falloff, height, albedo, anisotropy, start] = fog;
  Hasher h;
  h.value(density), h.value(falloff), h.value(height), add(h, albedo), h.value(anisotropy), h.value(start);
  return h.finish();
}

Hash128 SceneHashes::mesh(Id<Mesh> id) {
  return kept(meshes_, scene_.meshes, id, [](Hasher& h, const Mesh& m) {
    const auto& [name, positions, normals, tangents, uv0, uv1, colors, indices, joints, weights, targets] = m;
    addList(h, positions), addList(h, normals), addList(h, tangents), addList(h, uv0), addList(h, uv1), addList(h, colors), addList(h, indices), addList(h, joints), addList(h, weights);
    for (const MorphTarget& target : targets) addList(h, target.positions), addList(h, target.normals), addList(h, target.tangents);
  });
}

Hash128 SceneHashes::texture(Id<Texture> id) {
  return kept(textures_, scene_.textures, id, [](Hasher& h, const Texture& t) {
    const auto& [name, kind, sampler, image] = t;
    h.value(kind), add(h, sampler), add(h, image);
  });
}

Hash128 SceneHashes::material(Id<Material> id) {
  return kept(materials_, scene_.materials, id, [this](Hasher& h, const Material& m) {
    const auto& [name, mapA, mapB, mapC, emissiveMap, metalRoughMap, uvA, uvB, uvC, uvEmissive, uvMetalRough, albedo, substance, roughness, occlusionStrength, emission, opacity, alphaCutoff,
                 alphaTest, blend, twoSided, unlit, useVertexColor, metalness, transmission, thickness, attenuationColor, attenuationDistance, ior, anisotropy, anisotropyRotation, diffuseRoughness,
                 conductorEta, conductorK] = m;
    for (const Id<Texture> map : {mapA, mapB, mapC, emissiveMap, metalRoughMap}) h.hash(texture(map));
    for (const UvMapping& uv : {uvA, uvB, uvC, uvEmissive, uvMetalRough}) add(h, uv);
    for (const glm::vec3& v : {albedo, emission, attenuationColor, conductorEta, conductorK}) add(h, v);
    for (const float v : {substance, roughness, occlusionStrength, opacity, alphaCutoff, metalness, transmission, thickness, attenuationDistance, ior, anisotropy, anisotropyRotation, diffuseRoughness}) h.value(v);
    for (const bool v : {alphaTest, blend, twoSided, unlit, useVertexColor}) h.value(v);
  });
}

Hash128 SceneHashes::shape(const Placed& placed, bool withHoles) {
  Hasher h;
  h.hash(mesh(placed.instance->mesh));
  add(h, placed.placement);
  if (const Pose* pose = placed.pose) {
    h.value(pose->flipped);
    for (const glm::mat4& joint : pose->joints) add(h, joint);
    for (const auto& [target, weight] : pose->targets) h.value(target), h.value(weight);
  }
  if (withHoles) h.hash(material(placed.instance->material));
  return h.finish();
}

Hash128 SceneHashes::look(const Placed& placed) {
  Hasher h;
  h.hash(shape(placed, true));
  h.value(placed.instance->castsShadow);
  return h.finish();
}

Hash128 SceneHashes::light(const Light& light) const {
  const auto& [name, kind, node, color, intensity, range, innerCone, outerCone, enabled, castsShadow, standIn, sourceRadius, angularDiameter] = light;
  Hasher h;
  h.value(kind), add(h, scene_.world(node)), add(h, color), h.value(intensity), h.value(range), h.value(innerCone), h.value(outerCone), h.value(enabled), h.value(castsShadow), h.value(standIn);
  h.value(sourceRadius), h.value(angularDiameter);
  return h.finish();
}

}  // namespace burnish::scene
