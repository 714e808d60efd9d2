// A glTF file as the CPU sees it, before any conversion: what asset/gltf_reader produces and scene/import consumes.
// Every index in it is valid (or -1 where it is optional), every number finite, every hierarchy a tree: the validator saw to it.
#pragma once
#include <burnish/image.h>
#include <burnish/material.h>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace burnish::asset {

enum class Wrap : std::uint8_t { Repeat, ClampToEdge, MirroredRepeat };
struct Sampler {
  Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
  bool magnifyLinear = true, minifyLinear = true, mipLinear = true, mips = true;
};
struct Picture {
  std::string name;    ///< file name or JSON path, for messages
  Image pixels;        ///< empty when it could not be decoded (a warning says why)
};
struct Texture {
  int picture = -1;
  int sampler = -1;  ///< -1: the default sampler
};
/// textureInfo with KHR_texture_transform folded in.
struct TextureRef {
  int texture = -1;
  int uvSet = 0;
  glm::vec2 offset{0}, scale{1};
  float rotation = 0;  ///< radians, as the extension defines it
  float strength = 1;  ///< normalTexture.scale or occlusionTexture.strength
  [[nodiscard]] explicit operator bool() const { return texture >= 0; }
};
enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };
struct Material {
  std::string name;
  glm::vec4 baseColor{1};
  float metallic = 1, roughness = 1;
  TextureRef baseColorTexture, metallicRoughnessTexture, normalTexture, occlusionTexture, emissiveTexture;
  glm::vec3 emissive{0};      ///< factor × KHR_materials_emissive_strength
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  bool unlit = false;                     ///< KHR_materials_unlit
  float ior = 1.5f;                       ///< KHR_materials_ior
  float specular = 1;                     ///< KHR_materials_specular
  glm::vec3 specularColor{1};
  TextureRef specularTexture, specularColorTexture;
  float anisotropy = 0;                   ///< KHR_materials_anisotropy: strength, 0..1
  float anisotropyRotation = 0;           ///< radians, counter-clockwise from the tangent
  float diffuseRoughness = 0;             ///< extras.burnish.diffuseRoughness: Oren and Nayar's sigma, radians, 0..1
  float transmission = 0;                 ///< KHR_materials_transmission, 0..1
  float thickness = 0;                    ///< KHR_materials_volume: metres of the mesh
  glm::vec3 attenuationColor{1};
  float attenuationDistance = 0;          ///< metres; 0: infinite
  TextureRef transmissionTexture, thicknessTexture;  ///< R, G
  const Substance* substance = nullptr;   ///< extras.burnish.substance: a row of the library; replaces metalness, IOR and, for conductors without a texture, base colour
  bool specularGlossiness = false;        ///< KHR_materials_pbrSpecularGlossiness: the next five fields replace metal and roughness
  glm::vec4 diffuse{1};
  glm::vec3 specularF0{1};
  float glossiness = 1;
  TextureRef diffuseTexture, specularGlossinessTexture;
};
/// What a weight of 1 adds; streams are empty or as long as the primitive's positions.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;
};
struct Primitive {  ///< always an indexed triangle list; strips, fans and non-indexed ones were converted
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;
  std::vector<std::uint32_t> indices;
  std::vector<glm::u16vec4> joints;  ///< with `weights` or not at all; of more than four joints a vertex the strongest four, their sum as it was
  std::vector<glm::vec4> weights;    ///< not negative
  std::vector<MorphTarget> targets;  ///< as many in each primitive of a mesh
  int material = -1;
};
struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  std::vector<float> weights;            ///< of the morph targets; empty: zeros
  std::vector<std::string> targetNames;  ///< extras.targetNames; empty, or one for each target
};
struct Camera {
  std::string name;
  bool orthographic = false;
  double fovY = 0.8726646, aspect = 0, ymag = 1, near = 0.05, far = 0;
};
struct Light {
  std::string name;
  enum class Kind : std::uint8_t { Directional, Point, Spot } kind = Kind::Point;
  glm::vec3 color{1};
  float intensity = 1, range = 0, innerCone = 0, outerCone = 0.7853982f;
  bool shadow = false;                               ///< extras.burnish.shadow
  float sourceRadius = -1, angularDiameter = -1;     ///< extras.burnish's, metres and radians; negative: not given
};
/// scene.extras.burnish.fog, as burnish::Fog.
struct Fog {
  float density = 0, falloff = 0, height = 0;
  glm::vec3 albedo{1};
  float anisotropy = 0, start = 0;
};
/// scene.extras.burnish.sky, as burnish::SunSky.
struct Sky {
  glm::vec3 sun{0, 1, 0};
  float turbidity = 2.5f;
  glm::vec3 ground{0.2f};
  float altitude = 2;
};
/// A place of a reflection probe: a box around its node, along the node's axes.
struct ProbeBox {
  glm::dvec3 halfSize{1};              ///< in the node's space, above 0
  std::optional<glm::dvec3> capture;   ///< in the node's space; none: the node's origin
  std::optional<glm::dvec3> fade;      ///< metres
  std::optional<double> margin;        ///< metres
};
/// A place of the lattice of ambient probes, likewise.
struct ProbeGrid {
  glm::dvec3 halfSize{1};              ///< in the node's space, above 0
  glm::dvec3 spacing{1};               ///< metres, above 0; without `counts`
  std::optional<glm::ivec3> counts;    ///< at least 1 each, at most kMaxProbePoints together
  std::optional<double> margin;        ///< metres
};
inline constexpr int kMaxProbePoints = 1 << 20;
struct Node {
  std::string name;
  int parent = -1;
  glm::dmat4 local{1};
  int mesh = -1, camera = -1, light = -1;
  int skin = -1;
  std::vector<float> weights;  ///< of the mesh's morph targets; empty: the mesh's own
  glm::dvec3 translation{0}, scale{1};  ///< with `rotation` what `local` is made of, where the file gives no matrix
  glm::dquat rotation{1, 0, 0, 0};
  std::optional<ProbeBox> probe;
  std::optional<ProbeGrid> probeGrid;
};
struct Skin {
  std::string name;
  std::vector<int> joints;             ///< indices into Asset::nodes; empty when the shown scene lacks them (no node of it then has the skin)
  std::vector<glm::mat4> inverseBind;  ///< one a joint; empty: identities
};
enum class Interpolation : std::uint8_t { Linear, Step, CubicSpline };
struct AnimationSampler {
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;   ///< strictly growing; empty: the sampler's data are missing or faulty (a warning says which) and no channel names it
  std::vector<float> values;  ///< CubicSpline: three for each that the others have
};
struct AnimationChannel {
  enum class Path : std::uint8_t { Translation, Rotation, Scale, Weights } path = Path::Translation;
  int sampler = -1, node = -1;
};
struct Animation {
  std::string name;
  std::vector<AnimationSampler> samplers;
  std::vector<AnimationChannel> channels;  ///< those whose node is shown
};
struct Asset {
  std::string name;             ///< file name, for messages
  std::vector<Picture> pictures;
  std::vector<Sampler> samplers;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;      ///< of the file's default scene only (scene 0 without one), parents before children
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  std::optional<Fog> fog;
  std::optional<Sky> sky;
  std::string environment;      ///< scene.extras.burnish.environment: path relative to the file's folder; empty: none
};

struct ReadOptions {
  ImageDecoder* decoder = nullptr;  ///< required
  bool allowOutside = false;
  std::uint64_t maxFileBytes = 2048ull * 1024 * 1024;
  int maxJsonDepth = 64;
};
/// Reads .gltf or .glb (told apart by magic bytes). Errors name the file and, for faults of content, the JSON path. Damaged or refused pictures are warnings
/// (the material goes on without that texture), except a path that leaves the asset's folder, which is an error.
Result<Asset> readGltf(const std::filesystem::path& file, const ReadOptions& options, Report& report);

}  // namespace burnish::asset
