#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/file.h"
#include "scene/convert_material.h"
#include "scene/import_probes.h"
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
    if (const auto& fog = asset_.fog) scene_.fog = {fog->density, fog->falloff, fog->height, fog->albedo, fog->anisotropy, fog->start};
    if (auto r = materials(); !r) return fail(r.error());
    if (auto r = meshes(); !r) return fail(r.error());
    nodes();
    importProbes(asset_, nodes_, scene_, report_);
    animations();
    if (const auto& sky = asset_.sky) setSky(scene_, {sky->sun, sky->turbidity, sky->ground, sky->altitude}, report_);
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
    out.joints = std::move(in.joints);
    out.weights = std::move(in.weights);
    for (std::size_t t = 0; t < in.targets.size(); ++t) {
      asset::MorphTarget& target = in.targets[t];
      out.targets.push_back({t < mesh.targetNames.size() ? mesh.targetNames[t] : std::string(), std::move(target.positions),
                             std::move(target.normals), std::move(target.tangents)});
    }
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
    for (const asset::Node& in : asset_.nodes)
      nodes_.push_back(
          scene_.nodes.add({in.name, in.parent >= 0 ? nodes_[std::size_t(in.parent)] : Id<Node>{}, in.local}));
    skins();
    instances_.resize(asset_.nodes.size());
    for (std::size_t n = 0; n < asset_.nodes.size(); ++n) {
      const asset::Node& in = asset_.nodes[n];
      const Id<Node> id = nodes_[n];
      if (in.mesh >= 0)
        for (const auto& [mesh, material] : meshes_[std::size_t(in.mesh)])
          instances_[n].push_back(scene_.instances.add(instanceOf(in, id, mesh, material)));
      if (in.camera >= 0) scene_.cameras.add(cameraOf(asset_.cameras[std::size_t(in.camera)], in, id));
      if (in.light >= 0) scene_.lights.add(lightOf(asset_.lights[std::size_t(in.light)], in, id));
    }
  }

  void skins() {
    for (const asset::Skin& in : asset_.skins) {
      Skin out{in.name, {}, in.inverseBind};
      for (const int joint : in.joints) out.joints.push_back(nodes_[std::size_t(joint)]);
      const auto flat = std::count_if(out.inverseBind.begin(), out.inverseBind.end(),
                                      [](const glm::mat4& m) { return glm::determinant(glm::dmat4(m)) == 0; });
      if (flat > 0)
        report_.warn(fmt::format("{}: skin \"{}\"", asset_.name, in.name),
                     fmt::format("{} inverse bind matrices are singular: what hangs on their joints is flat", flat));
      skins_.push_back(in.joints.empty() ? Id<Skin>{} : scene_.skins.add(std::move(out)));
    }
  }

  [[nodiscard]] Instance instanceOf(const asset::Node& in, Id<Node> node, Id<Mesh> mesh, Id<Material> material) const {
    const Mesh& m = *scene_.meshes.get(mesh);
    Instance out{in.name.empty() ? m.name : in.name, node, mesh, material};
    if (in.skin >= 0 && !m.joints.empty()) out.skin = skins_[std::size_t(in.skin)];
    if (m.targets.empty()) return out;
    out.morphWeights = in.weights.empty() ? asset_.meshes[std::size_t(in.mesh)].weights : in.weights;
    out.morphWeights.resize(m.targets.size());
    return out;
  }

  void animations() {
    for (std::size_t i = 0; i < asset_.animations.size(); ++i) {
      asset::Animation& in = asset_.animations[i];
      Animation out;
      out.name = in.name;
      for (asset::AnimationSampler& s : in.samplers)
        out.curves.push_back({s.interpolation == asset::Interpolation::Step     ? Interpolation::Step
                              : s.interpolation == asset::Interpolation::Linear ? Interpolation::Linear
                                                                                : Interpolation::CubicSpline,
                              std::move(s.times), std::move(s.values)});
      std::map<int, std::size_t> tracks;
      for (const asset::AnimationChannel& c : in.channels) addChannel(c, out, tracks);
      if (out.nodes.empty() && out.weights.empty())
        report_.warn(fmt::format("{}: /animations/{}", asset_.name, i), "the animation moves nothing that is shown");
      else
        scene_.animations.add(std::move(out));
    }
  }

  /// `tracks`: the node track of each of the asset's nodes that has one.
  void addChannel(const asset::AnimationChannel& c, Animation& out, std::map<int, std::size_t>& tracks) {
    using Path = asset::AnimationChannel::Path;
    const asset::Node& node = asset_.nodes[std::size_t(c.node)];
    if (c.path == Path::Weights) {
      const std::vector<Id<Instance>>& instances = instances_[std::size_t(c.node)];
      if (!instances.empty())
        out.weights.push_back(
            {instances, int(scene_.instances.get(instances[0])->morphWeights.size()), c.sampler});
      return;
    }
    const auto [track, fresh] = tracks.try_emplace(c.node, out.nodes.size());
    if (fresh) out.nodes.push_back({nodes_[std::size_t(c.node)], node.translation, node.rotation, node.scale});
    Animation::NodeTrack& t = out.nodes[track->second];
    (c.path == Path::Translation ? t.translation : c.path == Path::Rotation ? t.rotation : t.scale) = c.sampler;
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
    l.castsShadow = in.shadow;
    if (in.sourceRadius >= 0) l.sourceRadius = in.sourceRadius;
    if (in.angularDiameter >= 0) l.angularDiameter = in.angularDiameter;
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
  std::vector<Id<Node>> nodes_;                     ///< by the asset's node
  std::vector<std::vector<Id<Instance>>> instances_;  ///< by the asset's node
  std::vector<Id<Skin>> skins_;                     ///< by the asset's skin
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
