#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "inspect.h"
#include "messages.h"

namespace cli {
namespace {

using burnish::Id;
using burnish::Material;
using burnish::Scene;
using burnish::Texture;

struct Range {
  float least = INFINITY, most = -INFINITY;
  void add(float v) { least = std::min(least, v), most = std::max(most, v); }
};

/// Range of the fourth channel, 0..1, over the whole map; {1,1} without one.
Range alphaRange(const Scene& scene, Id<Texture> id) {
  const Texture* texture = scene.textures.get(id);
  if (!texture || texture->image.channels != 4 || texture->image.type != burnish::PixelType::U8) return {1, 1};
  Range range;
  for (std::size_t i = 0; i < texture->image.pixelCount(); ++i) range.add(float(texture->image.u8()[i * 4 + 3]) / 255);
  return range;
}

std::string_view kindName(burnish::MapKind kind) {
  switch (kind) {
    case burnish::MapKind::AlbedoSubstance: return "A: albedo + substance";
    case burnish::MapKind::NormalRoughness: return "B: normal + roughness";
    case burnish::MapKind::Occlusion: return "C: occlusion + opacity";
    case burnish::MapKind::Emissive: return "emissive";
    case burnish::MapKind::MetalRough: return "metal + roughness";
  }
  return "";
}

std::string nameOr(const std::string& name, std::string_view kind, std::uint32_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index) : shown(name);
}

std::string rangeText(float least, float most) { return most - least < 0.0005f ? fmt::format("{:.3f}", least) : fmt::format("{:.3f} to {:.3f}", least, most); }

struct Use {
  std::uint64_t instances = 0, triangles = 0;
};

void printMaterials(const Scene& scene, const std::map<std::uint32_t, Use>& uses) {
  fmt::print("materials: {}\n", scene.materials.size());
  scene.materials.each([&](Id<Material> id, const Material& m) {
    const Range map = alphaRange(scene, m.mapB);
    const Range codes = m.mapA ? alphaRange(scene, m.mapA) : Range{m.substance, m.substance};
    std::string extra;
    if (m.metalRoughMap) extra += fmt::format(", metalness up to {:.2f} by a map of its own", m.metalness);
    if (m.alphaTest) extra += fmt::format(", alpha test at {:.2f}", m.alphaCutoff);
    if (m.opacity < 1) extra += fmt::format(", opacity {:.2f}", m.opacity);
    if (m.twoSided) extra += ", two-sided";
    if (m.unlit) extra += ", unlit";
    if (m.mapC) extra += ", map C";
    if (m.diffuseRoughness > 0) extra += fmt::format(", diffuse roughness {:.2f}", m.diffuseRoughness);
    if (m.anisotropy > 0) extra += fmt::format(", anisotropy {:.2f} at {:.1f}°", m.anisotropy, m.anisotropyRotation * 180 / M_PI);
    if (m.conductorEta != glm::vec3(0))
      extra += fmt::format(", eta {:.3f},{:.3f},{:.3f} k {:.3f},{:.3f},{:.3f}", m.conductorEta.x, m.conductorEta.y, m.conductorEta.z, m.conductorK.x, m.conductorK.y,
                           m.conductorK.z);
    if (std::max({m.emission.x, m.emission.y, m.emission.z}) > 0) extra += fmt::format(", emits {:g},{:g},{:g} cd/m²", m.emission.x, m.emission.y, m.emission.z);
    const auto use = uses.find(id.index);
    fmt::print("  {}: {}, roughness {}{}, {} triangles\n", nameOr(m.name, "material", id.index), describeCodes(codes.least, codes.most),
               rangeText(map.least * m.roughness, map.most * m.roughness), extra, use == uses.end() ? 0 : use->second.triangles);
  });
}

void printTextures(const Scene& scene) {
  std::uint64_t bytes = 0;
  scene.textures.each([&](Id<Texture>, const Texture& t) { bytes += t.image.byteSize(); });
  fmt::print("textures: {} ({:.1f} MB without mip levels)\n", scene.textures.size(), double(bytes) / 1e6);
  scene.textures.each([&](Id<Texture> id, const Texture& t) {
    fmt::print("  {}: {}x{}, {} channels, {}\n", nameOr(t.name, "texture", id.index), t.image.width, t.image.height, t.image.channels, kindName(t.kind));
  });
}

void printLights(const Scene& scene) {
  fmt::print("lights: {}\n", scene.lights.size());
  scene.lights.each([&](Id<burnish::Light> id, const burnish::Light& light) {
    const char* kinds[] = {"directional", "point", "spot"};
    const char* unit = light.kind == burnish::LightKind::Directional ? "lux" : "cd";
    std::string extra = light.kind == burnish::LightKind::Directional ? "" : light.range > 0 ? fmt::format(", range {:g} m", light.range) : ", no range";
    if (light.kind == burnish::LightKind::Spot)
      extra += fmt::format(", cone {:.1f}° to {:.1f}°", light.innerCone * 180 / M_PI, light.outerCone * 180 / M_PI);
    fmt::print("  {}: {}, {:g} {}, colour {:.3g},{:.3g},{:.3g}{}{}\n", nameOr(light.name, "light", id.index), kinds[int(light.kind)], light.intensity, unit,
               light.color.x, light.color.y, light.color.z, extra, light.enabled ? "" : ", off");
  });
}

void printCameras(const Scene& scene) {
  fmt::print("cameras: {}\n", scene.cameras.size());
  scene.cameras.each([&](Id<burnish::Camera> id, const burnish::Camera& camera) {
    const glm::dmat4 world = scene.world(camera.node);
    const std::string lens = camera.orthographic ? fmt::format("orthographic, {:g} m high", camera.height)
                                                 : fmt::format("perspective, {:.1f}° vertical", camera.fovY * 180 / M_PI);
    fmt::print("  {}: {}, at {:.2f},{:.2f},{:.2f}\n", nameOr(camera.name, "camera", id.index), lens, world[3].x, world[3].y, world[3].z);
  });
}

void printSkins(const Scene& scene) {
  fmt::print("skins: {}\n", scene.skins.size());
  scene.skins.each([&](Id<burnish::Skin> id, const burnish::Skin& skin) {
    std::size_t users = 0;
    scene.instances.each([&](Id<burnish::Instance>, const burnish::Instance& i) { users += i.skin == id; });
    fmt::print("  {}: {} joints, on {} instances\n", nameOr(skin.name, "skin", id.index), skin.joints.size(), users);
  });
}

void printMorphTargets(const Scene& scene) {
  std::size_t meshes = 0;
  scene.meshes.each([&](Id<burnish::Mesh>, const burnish::Mesh& m) { meshes += !m.targets.empty(); });
  fmt::print("meshes with morph targets: {}\n", meshes);
  scene.meshes.each([&](Id<burnish::Mesh> id, const burnish::Mesh& mesh) {
    if (mesh.targets.empty()) return;
    std::vector<std::string> names;
    for (std::size_t t = 0; t < mesh.targets.size(); ++t) names.push_back(nameOr(mesh.targets[t].name, "target", std::uint32_t(t)));
    fmt::print("  {}: {}\n", nameOr(mesh.name, "mesh", id.index), listed(names));
  });
}

void printAnimations(const Scene& scene) {
  fmt::print("animations: {}\n", scene.animations.size());
  scene.animations.each([&](Id<burnish::Animation> id, const burnish::Animation& a) {
    std::size_t translations = 0, rotations = 0, scales = 0;
    for (const burnish::Animation::NodeTrack& t : a.nodes) translations += t.translation >= 0, rotations += t.rotation >= 0, scales += t.scale >= 0;
    fmt::print("  {}: {:.3f} s, {} channels ({} translations, {} rotations, {} scales, {} of morph weights)\n", nameOr(a.name, "animation", id.index), a.length(),
               translations + rotations + scales + a.weights.size(), translations, rotations, scales, a.weights.size());
  });
}

void printEnvironment(const burnish::Environment& environment) {
  if (!environment.map.empty())
    fmt::print("environment: {}x{} lat-long, scale {:g}\n", environment.map.width, environment.map.height, environment.scale);
  else if (environment.color != glm::vec3(0))
    fmt::print("environment: colour {:g},{:g},{:g} cd/m²\n", environment.color.x, environment.color.y, environment.color.z);
  else
    fmt::print("environment: none\n");
}

float dielectricF0(float code) { return burnish::decodeSubstance(code, glm::vec3(0)).f0.x; }
// ((n-1)/(n+1))^2 = F0 solved for n.
float iorOf(float f0) { return (1 + std::sqrt(f0)) / (1 - std::sqrt(f0)); }
int metalPercent(float code) { return int(std::lround((code - 0.4f) / 0.6f * 100)); }

}  // namespace

std::string describeCodes(float least, float most) {
  constexpr float kLastDielectric = 0.4f;  // docs/shading.md, section 1
  const auto dielectric = [](float code) { return fmt::format("F0 {:.3f} (IOR {:.2f})", dielectricF0(code), iorOf(dielectricF0(code))); };
  const bool same = most - least < 0.5f / 255;
  if (most <= kLastDielectric) return "dielectric, " + dielectric(least) + (same ? "" : " to " + dielectric(most));
  if (same) return fmt::format("metal {} %", metalPercent(most));
  if (least > kLastDielectric) return fmt::format("metal {} to {} %", metalPercent(least), metalPercent(most));
  return fmt::format("dielectric of {} to metal {} %", dielectric(least), metalPercent(most));
}

void printScene(const Scene& scene, const burnish::Report& report, const std::string& name) {
  std::map<std::uint32_t, Use> uses;
  std::uint64_t triangles = 0, drawn = 0;
  scene.meshes.each([&](Id<burnish::Mesh>, const burnish::Mesh& mesh) { triangles += mesh.indices.size() / 3; });
  scene.instances.each([&](Id<burnish::Instance>, const burnish::Instance& instance) {
    const burnish::Mesh* mesh = scene.meshes.get(instance.mesh);
    if (!mesh || !instance.visible) return;
    drawn += mesh->indices.size() / 3;
    Use& use = uses[instance.material.index];
    ++use.instances;
    use.triangles += mesh->indices.size() / 3;
  });
  fmt::print("{}\n", shown(name));
  fmt::print("meshes: {} with {} triangles; {} instances draw {}\n", scene.meshes.size(), triangles, scene.instances.size(), drawn);
  if (const burnish::Bounds b = scene.bounds(); !b.empty())
    fmt::print("bounds: {:.3f},{:.3f},{:.3f} to {:.3f},{:.3f},{:.3f} m\n", b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
  printMaterials(scene, uses);
  printTextures(scene);
  printLights(scene);
  printCameras(scene);
  printSkins(scene);
  printMorphTargets(scene);
  printAnimations(scene);
  printEnvironment(scene.environment);
  fmt::print("warnings: {}\n", report.warnings().size());
  for (const burnish::Warning& warning : report.warnings()) fmt::print("  {}\n", shown(warning.message()));
}

}  // namespace cli
