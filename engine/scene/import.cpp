#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "scene/convert_material.h"
#include "scene/load.h"
#include "scene/tangents.h"
#include "scene/validate.h"

namespace burnish {
namespace scene {
namespace {

class Importer {
 public:
  Importer(asset::Asset& asset, const Deadline& deadline, Report& report)
      : asset_(asset), deadline_(deadline), report_(report), converter_(asset, scene_, report) {}

  Result<Scene> run() {
    scene_.name = asset_.name;
    if (auto r = materials(); !r) return fail(r.error());
    if (auto r = meshes(); !r) return fail(r.error());
    nodes();
    return std::move(scene_);
  }

 private:
  [[nodiscard]] Result<void> inTime() const {
    if (!deadline_.passed()) return {};
    return fail(asset_.name, "loading took longer than allowed", "raise LoadOptions::seconds or give a smaller file");
  }

  /// The index of a primitive's row in materials_: the last one is glTF's default material.
  [[nodiscard]] std::size_t rowOf(const asset::Primitive& p) const {
    return p.material >= 0 && std::size_t(p.material) < asset_.materials.size() ? std::size_t(p.material)
                                                                                : asset_.materials.size();
  }

  Result<void> materials() {
    std::vector<bool> vertexAlpha(asset_.materials.size() + 1, false);
    bool needsDefault = false;
    for (const asset::Mesh& mesh : asset_.meshes)
      for (const asset::Primitive& p : mesh.primitives) {
        needsDefault = needsDefault || rowOf(p) == asset_.materials.size();
        if (std::any_of(p.colors.begin(), p.colors.end(), [](const glm::vec4& c) { return c.a < 1; }))
          vertexAlpha[rowOf(p)] = true;
      }
    for (std::size_t i = 0; i < asset_.materials.size(); ++i) {
      materials_.push_back(converter_.convert(int(i), vertexAlpha[i]));
      if (auto t = inTime(); !t) return t;
    }
    materials_.push_back(needsDefault ? converter_.convert(-1, false) : MaterialConverter::Converted{});
    return {};
  }

  Result<void> meshes() {
    meshes_.resize(asset_.meshes.size());
    for (std::size_t m = 0; m < asset_.meshes.size(); ++m)
      for (std::size_t p = 0; p < asset_.meshes[m].primitives.size(); ++p) {
        if (auto r = primitive(m, p); !r) return r;
        if (auto t = inTime(); !t) return t;
      }
    faults_.report(asset_.name, report_);
    return {};
  }

  Result<void> primitive(std::size_t m, std::size_t p) {
    asset::Mesh& mesh = asset_.meshes[m];
    asset::Primitive& in = mesh.primitives[p];
    const MaterialConverter::Converted& material = materials_[rowOf(in)];
    Mesh out;
    out.name = mesh.name.empty() ? fmt::format("mesh {}", m) : mesh.name;
    if (mesh.primitives.size() > 1) out.name += fmt::format("/{}", p);
    out.positions = std::move(in.positions);
    out.normals = std::move(in.normals);
    out.tangents = std::move(in.tangents);
    out.uv0 = std::move(in.uv0);
    out.uv1 = std::move(in.uv1);
    out.colors = std::move(in.colors);
    out.indices = std::move(in.indices);
    auto good = validated(std::move(out), faults_);
    if (!good)
      return fail(fmt::format("{}: /meshes/{}/primitives/{}", asset_.name, m, p), good.error().what,
                  good.error().remedy);
    if (material.tangents && good->tangents.empty() && !good->indices.empty()) {
      if ((material.tangents->set == 1 ? good->uv1 : good->uv0).empty())
        report_.warn(fmt::format("mesh \"{}\"", good->name),
                     material.normalMap
                         ? "its material has a normal map, but it has no texture coordinates for it"
                         : "its material is anisotropic, but it has neither tangents nor texture coordinates: the "
                           "direction is arbitrary");
      makeTangents(*good, *material.tangents);
    }
    if (!good->indices.empty()) meshes_[m].push_back({scene_.meshes.add(std::move(*good)), material.id});
    return {};
  }

  void nodes() {
    std::vector<Id<Node>> ids;
    ids.reserve(asset_.nodes.size());
    for (const asset::Node& in : asset_.nodes) {
      const Id<Node> id =
          scene_.nodes.add({in.name, in.parent >= 0 ? ids[std::size_t(in.parent)] : Id<Node>{}, in.local});
      ids.push_back(id);
      if (in.mesh >= 0)
        for (const auto& [mesh, material] : meshes_[std::size_t(in.mesh)])
          scene_.instances.add({in.name.empty() ? scene_.meshes.get(mesh)->name : in.name, id, mesh, material});
      if (in.camera >= 0) scene_.cameras.add(cameraOf(asset_.cameras[std::size_t(in.camera)], in, id));
      if (in.light >= 0) scene_.lights.add(lightOf(asset_.lights[std::size_t(in.light)], in, id));
    }
  }

  static Camera cameraOf(const asset::Camera& in, const asset::Node& node, Id<Node> id) {
    Camera c;
    c.name = in.name.empty() ? node.name : in.name;
    c.node = id;
    c.orthographic = in.orthographic;
    c.fovY = float(in.fovY);
    c.height = float(2 * in.ymag);
    c.near = float(in.near);
    c.far = float(in.far);
    return c;
  }

  static Light lightOf(const asset::Light& in, const asset::Node& node, Id<Node> id) {
    Light l;
    l.name = in.name.empty() ? node.name : in.name;
    l.kind = in.kind == asset::Light::Kind::Directional ? LightKind::Directional
             : in.kind == asset::Light::Kind::Spot      ? LightKind::Spot
                                                        : LightKind::Point;
    l.node = id;
    l.color = glm::max(in.color, glm::vec3(0));
    l.intensity = std::max(in.intensity, 0.0f);
    l.range = std::max(in.range, 0.0f);
    l.outerCone = std::clamp(in.outerCone, 0.0f, 1.5707964f);
    l.innerCone = std::clamp(in.innerCone, 0.0f, l.outerCone);
    return l;
  }

  struct Part {
    Id<Mesh> mesh;
    Id<Material> material;
  };

  asset::Asset& asset_;
  const Deadline& deadline_;
  Report& report_;
  Scene scene_;
  MaterialConverter converter_;
  std::vector<MaterialConverter::Converted> materials_;
  MeshFaults faults_;                      ///< of all meshes together: one warning for each kind
  std::vector<std::vector<Part>> meshes_;  ///< by the asset's mesh
};

/// The file's own environment. A path that is missing or leaves the folder is an error as for buffers; a picture that
/// cannot be decoded is a warning.
Result<void> ownEnvironment(Scene& scene, const std::filesystem::path& file, const std::string& uri,
                            const LoadOptions& options, ImageDecoder& decoder, Report& report) {
  auto bytes = core::readFileInside(file.parent_path(), uri, options.allowOutside, options.maxFileBytes);
  if (!bytes) return fail(file.filename().string() + ": extras.burnish.environment", bytes.error().message());
  if (auto made = decodeEnvironment(scene, *bytes, uri, decoder, report); !made)
    report.warn(file.filename().string(), "its environment is left out: " + made.error().message());
  return {};
}

}  // namespace

Result<Scene> importAsset(asset::Asset asset, const Deadline& deadline, Report& report) {
  return Importer(asset, deadline, report).run();
}

}  // namespace scene

Result<Scene> loadScene(const std::filesystem::path& file, const LoadOptions& options, Report& report) {
  const scene::Deadline deadline(options.seconds);
  std::unique_ptr<ImageDecoder> own;
  if (!options.decoder) own = makeDecoderPool();
  ImageDecoder& decoder = options.decoder ? *options.decoder : *own;
  auto asset = asset::readGltf(
      file, {.decoder = &decoder, .allowOutside = options.allowOutside, .maxFileBytes = options.maxFileBytes}, report);
  if (!asset) return fail(asset.error());
  const std::string environment = asset->environment;
  auto made = scene::importAsset(std::move(*asset), deadline, report);
  if (!made) return made;
  if (!environment.empty())
    if (auto read = scene::ownEnvironment(*made, file, environment, options, decoder, report); !read)
      return fail(read.error());
  return made;
}

}  // namespace burnish
