// One scene on the GPU: meshes and textures are uploaded when they are first drawn (nearest first, within a budget a frame) and again when their rows change.
#pragma once
#include <burnish/plan.h>

#include <array>
#include <map>
#include <memory>
#include <vector>

#include "gl/objects.h"
#include "gpu_scene/deformation.h"
#include "gpu_scene/grid.h"
#include "gpu_scene/layout.h"
#include "gpu_scene/mesh_parts.h"
#include "gpu_scene/probes.h"

namespace burnish::gpu_scene {

/// Vertices: binding 0 = position f32x3, normal and tangent snorm16x4, uv0 f32x2; binding 1 (general programs) = uv1 f32x2, colour unorm16x4.
struct GpuMesh {
  gl::Buffer vertices, extras, indices;
  int indexCount = 0;
  GLenum indexType = GL_UNSIGNED_SHORT;
  std::vector<MeshPart> parts;  ///< of its vertices as they are; empty: it is small
  bool tangents = false;
  bool madeTangents = false;    ///< scene::preparedMesh was asked for them
  int vertexCount = 0;
  std::uint64_t serial = 0;     ///< tells uploads apart
  static constexpr int kStride = 36, kExtraStride = 16;
};

/// A map B of a material that packs occlusion (plan::packsOcclusion) holds normal x, normal y, occlusion, roughness.
/// What an instance is drawn with; textures that have not arrived are their 1x1 defaults.
struct MaterialBinding {
  std::array<GLuint, 5> texture{};  ///< by texture unit: A, B, C, metal-rough, emissive
  std::array<GLuint, 5> sampler{};
  std::size_t offset = 0;           ///< of its MaterialData in materials()
};

/// Environment textures and coefficients, made from the scene's environment on first use. A texture is empty until it is wanted.
struct GpuEnvironment {
  gl::Texture cube, sky;
  std::array<glm::vec3, 9> irradiance{};
  float meanLuminance = 0, lastLevel = 0;
};

/// The textures of the environment that a plan reads.
struct EnvironmentWants {
  bool cube = false, picture = false;
};

class GpuScene {
 public:
  explicit GpuScene(gl::Device& device) : device_(device) {}

  /// Call once a frame before anything else. budget: bytes that may be uploaded in this frame, 0: no limit (one resource always goes through).
  void beginFrame(const Scene& scene, std::uint64_t budget);
  /// Brings materials() up to date; before mesh() and material(), in frames that draw instances.
  Result<void> updateMaterials(const Scene& scene);
  /// nullptr while it waits for its turn or cannot be drawn.
  /// tangents: the material has a normal map; they are made where the mesh brings none (MikkTSpace, which may split vertices).
  const GpuMesh* mesh(const Scene& scene, Id<Mesh> id, bool tangents, Report& report);
  const MaterialBinding& material(const Scene& scene, Id<Material> id, Report& report);
  [[nodiscard]] const gl::Buffer& materials() const { return materialBuffer_; }
  /// Only called when the plan lights by it or shows it.
  Result<const GpuEnvironment*> environment(const Scene& scene, EnvironmentWants wants, Report& report);
  /// Only called when the plan looks reflections up in captured places: some probe of the scene is usable.
  /// `cubes`: something looks reflections up. What a refresh writes there holds until the set's revision moves.
  Result<GpuProbes*> probes(const Scene& scene, bool cubes, Report& report);
  /// Only called when the plan reads the lattice.
  Result<const GpuGrid*> grid(const Scene& scene, Report& report);

  [[nodiscard]] Deformation& deformation() { return deformation_; }
  /// Whether so many bytes may be uploaded in this frame; they count as uploaded then.
  [[nodiscard]] bool admit(std::uint64_t bytes);

  [[nodiscard]] std::uint64_t uploadedBytes() const { return uploaded_; }  ///< in this frame
  [[nodiscard]] std::uint64_t pending() const { return pending_; }         ///< resources refused in this frame

 private:
  struct MeshRow {
    std::uint64_t revision = 0;
    std::uint32_t generation = 0;
    std::unique_ptr<GpuMesh> mesh;  // empty: cannot be drawn
  };
  struct TextureRow {
    std::uint64_t revision = 0;
    std::uint32_t generation = 0;
    gl::Texture texture;
    GLuint sampler = 0;
  };
  struct MaterialRow {
    std::uint64_t revision = 0;
    MaterialBinding binding;
    bool complete = false;  // every texture has arrived
  };
  void sweep(const Scene& scene);
  const TextureRow* texture(const Scene& scene, Id<Texture> id, Report& report);
  Result<gl::Texture> uploadTexture(const Texture& texture, const Texture* occlusion);
  const TextureRow* packedTexture(const Scene& scene, Id<Texture> normal, Id<Texture> occlusion, Report& report);
  GLuint sampler(const Sampler& s);
  Result<void> makeDefaults();

  gl::Device& device_;
  std::vector<MeshRow> meshes_;
  std::vector<TextureRow> textures_;
  /// Maps B with a map C's occlusion in the third channel, by the two rows' indices.
  std::map<std::pair<std::uint32_t, std::uint32_t>, TextureRow> packed_;
  std::vector<MaterialRow> materials_;
  std::vector<std::pair<Sampler, gl::Sampler>> samplers_;
  std::array<gl::Texture, 5> defaults_;
  MaterialBinding defaultMaterial_;
  gl::Buffer materialBuffer_;
  std::size_t materialStride_ = 256;
  std::unique_ptr<GpuEnvironment> environment_;
  std::uint64_t environmentRevision_ = 0;
  std::unique_ptr<GpuProbes> probes_;
  std::uint64_t probesRevision_ = 0;
  std::unique_ptr<GpuGrid> grid_;
  std::uint64_t gridRevision_ = 0;
  std::uint64_t meshesRevision_ = 0, texturesRevision_ = 0, materialsRevision_ = ~0ull;
  Deformation deformation_;
  std::uint64_t meshSerial_ = 0;
  std::uint64_t budget_ = 0, uploaded_ = 0, pending_ = 0;
};

}  // namespace burnish::gpu_scene
