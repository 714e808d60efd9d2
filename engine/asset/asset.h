// A glTF file as the CPU sees it, before any conversion: what asset/gltf_reader produces and scene/import consumes.
// Every index in it is valid (or -1 where it is optional), every number finite, every hierarchy a tree: the validator saw to it.
#pragma once
#include <burnish/image.h>
#include <burnish/material.h>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
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
  const Substance* substance = nullptr;   ///< extras.burnish.substance: a row of the library; replaces metalness, IOR and, for conductors without a texture, base colour
  bool specularGlossiness = false;        ///< KHR_materials_pbrSpecularGlossiness: the next five fields replace metal and roughness
  glm::vec4 diffuse{1};
  glm::vec3 specularF0{1};
  float glossiness = 1;
  TextureRef diffuseTexture, specularGlossinessTexture;
};
struct Primitive {  ///< always an indexed triangle list; strips, fans and non-indexed ones were converted
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> uv0, uv1;
  std::vector<glm::vec4> colors;
  std::vector<std::uint32_t> indices;
  int material = -1;
};
struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
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
};
struct Node {
  std::string name;
  int parent = -1;
  glm::dmat4 local{1};
  int mesh = -1, camera = -1, light = -1;
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
