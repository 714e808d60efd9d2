// The tables of a glTF file as they stand in it: what parse_*.cpp fill, validate_*.cpp compare with each other and
// build_*.cpp read from.
#pragma once
#include "asset/asset.h"
#include "asset/check.h"

namespace burnish::asset {

enum class Component : std::uint16_t { Unknown = 0, I8 = 5120, U8, I16, U16, U32 = 5125, F32 };
enum class Shape : std::uint8_t { Unknown, Scalar, Vec2, Vec3, Vec4, Mat2, Mat3, Mat4 };
[[nodiscard]] int componentBytes(Component c);
[[nodiscard]] int componentCount(Shape s);
[[nodiscard]] std::string formatName(Shape s, Component c, bool normalized);  ///< "VEC3 of FLOAT", for messages

/// What a buffer view holds; one view cannot hold two kinds.
enum class Usage : std::uint8_t { None, Vertices, Indices, Image, Skin, Animation, Sparse };

struct Buffer {
  std::uint64_t byteLength = 0;
  const std::string* uri = nullptr;  ///< in the JSON document
  bool used = false;                 ///< by a buffer view
  std::vector<std::byte> owned;
  std::span<const std::byte>
      bytes;  ///< byteLength of them, or none: a buffer without uri outside GLB has no data that this reader can know
};
struct BufferView {
  int buffer = -1;
  std::uint64_t offset = 0, length = 0;
  std::uint32_t stride = 0;  ///< 0: tightly packed
  Usage usage = Usage::None;
  int vertexAccessor = -1;  ///< the first accessor that reads vertices from it
};
struct Sparse {
  std::uint64_t count = 0;
  int indexView = -1, valueView = -1;
  std::uint64_t indexOffset = 0, valueOffset = 0;
  Component indexComponent = Component::Unknown;
};
struct Accessor {
  int view = -1;  ///< -1: zeros
  std::uint64_t offset = 0, count = 0;
  Component component =
      Component::Unknown;  ///< Unknown: a value that the specification does not list; nothing may use the accessor
  Shape shape = Shape::Unknown;
  bool normalized = false;
  std::vector<double> min, max;
  std::optional<Sparse> sparse;
  [[nodiscard]] int components() const { return componentCount(shape); }
  [[nodiscard]] bool readable() const { return component != Component::Unknown && shape != Shape::Unknown; }
  /// Bytes from the first to the last byte of one element: columns of matrices start at multiples of 4 (glTF 2.0,
  /// section 3.6.2.4).
  [[nodiscard]] std::uint64_t elementBytes() const;
  [[nodiscard]] std::uint64_t packedStride() const;
};
struct PictureSource {
  std::string name;
  const std::string* uri = nullptr;
  int view = -1;
};
struct Attribute {
  std::string semantic;
  int accessor = -1;
};
struct PrimitiveSource {
  std::vector<Attribute> attributes;
  std::vector<std::vector<Attribute>> targets;
  int indices = -1, material = -1, mode = 4;
  [[nodiscard]] int find(std::string_view semantic) const;  ///< accessor, -1 without one
};
struct MeshSource {
  std::string name;
  std::vector<PrimitiveSource> primitives;
  std::vector<double> weights;
  std::vector<std::string> targetNames;
};
struct NodeSource {
  std::string name;
  std::vector<int> children;
  int parent = -1, mesh = -1, camera = -1, skin = -1, light = -1;
  glm::dmat4 local{1};
  glm::dvec3 translation{0}, scale{1};
  glm::dquat rotation{1, 0, 0, 0};
  bool hasMatrix = false;
  std::optional<ProbeBox> probe;
  std::optional<ProbeGrid> probeGrid;
  std::vector<double> weights;
};
struct SkinSource {
  std::string name;
  std::vector<int> joints;
  int skeleton = -1, inverseBindMatrices = -1;
};
struct SceneSource {
  std::string name, environment;
  std::optional<Fog> fog;
  std::optional<Sky> sky;
  std::vector<int> nodes;
};
struct SamplerSource {
  int input = -1, output = -1;
  Interpolation interpolation = Interpolation::Linear;
  [[nodiscard]] bool cubic() const { return interpolation == Interpolation::CubicSpline; }
};
struct ChannelSource {
  int sampler = -1, node = -1;
  std::string path;
};
struct AnimationSource {
  std::string name;
  std::vector<SamplerSource> samplers;
  std::vector<ChannelSource> channels;
};

struct Document {
  std::vector<Buffer> buffers;
  std::vector<BufferView> views;
  std::vector<Accessor> accessors;
  std::vector<PictureSource> pictures;
  std::vector<Sampler> samplers;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<MeshSource> meshes;
  std::vector<NodeSource> nodes;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<SkinSource> skins;
  std::vector<AnimationSource> animations;
  std::vector<SceneSource> scenes;
  int scene = -1;
  bool quantized = false;  ///< KHR_mesh_quantization widens the formats of vertex attributes
};

/// JSON to tables: types, ranges, required members, references. Faults stand in `check`.
Document parseDocument(const Json& root, Check& check);
void parseBuffers(const At& root, Check& check, Document& doc);
void parseMaterials(const At& root, Check& check, Document& doc);
void parseMeshes(const At& root, Check& check, Document& doc);
void parseNodes(const At& root, Check& check, Document& doc);
/// A node's places of probes; its name, mesh, camera and light are known.
void parseProbes(const At& node, Check& check, NodeSource& out);
void parseAnimations(const At& root, Check& check, Document& doc);

/// Tables against each other, before any byte of binary data is read.
void validateDocument(Check& check, Document& doc);
void validateAccessors(Check& check, Document& doc);
void validateMeshes(Check& check, Document& doc);
void validateNodes(Check& check, Document& doc);
void validateSkins(Check& check, Document& doc);
void validateAnimations(Check& check, Document& doc);
/// Marks what a buffer view holds; a second kind is a fault of the value at `path`.
void useView(Check& check, Document& doc, int view, Usage usage, const std::string& path);

}  // namespace burnish::asset
