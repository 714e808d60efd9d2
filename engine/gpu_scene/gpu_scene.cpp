#include "gpu_scene/gpu_scene.h"

#include <fmt/format.h>

#include <cstring>

#include "plan/variants.h"
#include "scene/material_factors.h"
#include "scene/texture_levels.h"

namespace burnish::gpu_scene {
namespace {

struct KindFormat {
  GLenum format;
  int channels;
};
KindFormat formatOf(MapKind kind, int channels) {
  switch (kind) {
    case MapKind::AlbedoSubstance: return {GL_SRGB8_ALPHA8, 4};
    case MapKind::Emissive: return {GL_SRGB8_ALPHA8, 4};
    case MapKind::Occlusion: return channels >= 2 ? KindFormat{GL_RG8, 2} : KindFormat{GL_R8, 1};
    case MapKind::NormalRoughness:
    case MapKind::MetalRough: break;
  }
  return {GL_RGBA8, 4};
}

vec4 uvRow(const UvMapping& uv, int row) { return {uv.transform[0][row], uv.transform[1][row], uv.transform[2][row], float(uv.set == 1)}; }

MaterialData dataOf(const Material& m) {
  const scene::MaterialFactors f = scene::factorsOf(m);
  MaterialData d{};
  d.albedo = vec4(f.albedo, f.opacity);
  d.params = {f.codeScale, f.codeBias, f.roughness, f.occlusionStrength};
  d.emission = vec4(f.emission, f.alphaCutoff);
  d.more = {f.metalness, f.unlit ? 1.0f : 0.0f, f.vertexColor ? 1.0f : 0.0f, f.metalRoughMap ? (f.mapB ? 1.0f : 2.0f) : 0.0f};
  for (int i = 0; i < 5; ++i)
    for (int row = 0; row < 2; ++row) d.uv[2 * i + row] = uvRow(f.uv[i], row);
  d.conductorEta = vec4(f.eta, f.brushed.x);
  d.conductorK = vec4(f.k, f.brushed.y);
  d.glass = {f.transmission, f.thickness, f.ior, f.blend ? 1.0f : 0.0f};
  d.attenuation = vec4(f.absorption, f.sigma);
  return d;
}

GLenum wrapOf(Wrap w) { return w == Wrap::Repeat ? GL_REPEAT : w == Wrap::MirroredRepeat ? GL_MIRRORED_REPEAT : GL_CLAMP_TO_EDGE; }

}  // namespace

bool GpuScene::admit(std::uint64_t bytes) {
  if (budget_ > 0 && uploaded_ > 0 && uploaded_ + bytes > budget_) {
    ++pending_;
    return false;
  }
  uploaded_ += bytes;
  return true;
}

void GpuScene::beginFrame(const Scene& scene, std::uint64_t budget) {
  budget_ = budget;
  uploaded_ = pending_ = 0;
  sweep(scene);
}

// Frees what no row stands for any more.
void GpuScene::sweep(const Scene& scene) {
  if (scene.meshes.revision() != meshesRevision_) {
    for (std::uint32_t i = 0; i < meshes_.size(); ++i)
      if (const Id<Mesh> id = scene.meshes.at(i); !id || id.generation != meshes_[i].generation) meshes_[i] = {};
    meshes_.resize(scene.meshes.capacity());
    meshesRevision_ = scene.meshes.revision();
  }
  if (scene.textures.revision() != texturesRevision_) {
    for (std::uint32_t i = 0; i < textures_.size(); ++i)
      if (const Id<Texture> id = scene.textures.at(i); !id || id.generation != textures_[i].generation || scene.textures.revision(id) != textures_[i].revision) textures_[i] = {};
    textures_.resize(scene.textures.capacity());
    packed_.clear();
    for (MaterialRow& m : materials_) m.complete = false;
    texturesRevision_ = scene.textures.revision();
  }
}

Result<void> GpuScene::makeDefaults() {
  const GLenum formats[5] = {GL_SRGB8_ALPHA8, GL_RGBA8, GL_RG8, GL_RGBA8, GL_SRGB8_ALPHA8};
  const char* names[5] = {"default map A", "default map B", "default map C", "default metal-rough", "default emissive"};
  for (std::size_t i = 0; i < 5; ++i) {
    auto t = gl::Texture::create(device_, {.format = formats[i]}, names[i]);
    if (!t) return fail(t.error());
    t->upload(0, scene::kDefaultTexels[i]);
    defaults_[i] = std::move(*t);
    defaultMaterial_.texture[i] = defaults_[i].id();
    defaultMaterial_.sampler[i] = sampler({});
  }
  return {};
}

Result<void> GpuScene::updateMaterials(const Scene& scene) {
  if (!defaults_[0])
    if (auto made = makeDefaults(); !made) return made;
  if (scene.materials.revision() == materialsRevision_) return {};
  materialStride_ = (sizeof(MaterialData) + std::size_t(device_.caps.uniformAlignment) - 1) / std::size_t(device_.caps.uniformAlignment) * std::size_t(device_.caps.uniformAlignment);
  // Row 0 is the default material.
  std::vector<std::byte> bytes((scene.materials.capacity() + 1) * materialStride_);
  const MaterialData plain = dataOf(Material{});
  std::memcpy(bytes.data(), &plain, sizeof plain);
  materials_.resize(scene.materials.capacity());
  for (std::uint32_t i = 0; i < materials_.size(); ++i) {
    const Id<Material> id = scene.materials.at(i);
    if (!id) continue;
    const MaterialData data = dataOf(*scene.materials.get(id));
    std::memcpy(bytes.data() + (i + 1) * materialStride_, &data, sizeof data);
    if (materials_[i].revision != scene.materials.revision(id)) materials_[i] = {scene.materials.revision(id), {}, false};
    materials_[i].binding.offset = (i + 1) * materialStride_;
  }
  auto buffer = gl::Buffer::create(device_, gl::BufferUse::Static, bytes.size(), bytes.data(), "materials");
  if (!buffer) return fail(buffer.error());
  materialBuffer_ = std::move(*buffer);
  materialsRevision_ = scene.materials.revision();
  return {};
}

const MaterialBinding& GpuScene::material(const Scene& scene, Id<Material> id, Report& report) {
  const Material* m = scene.materials.get(id);
  if (!m) return defaultMaterial_;
  MaterialRow& row = materials_[id.index];
  if (row.complete) return row.binding;
  row.complete = true;
  const Id<Texture> maps[] = {m->mapA, m->mapB, m->mapC, m->metalRoughMap, m->emissiveMap};
  for (std::size_t i = 0; i < 5; ++i) {
    row.binding.texture[i] = defaults_[i].id();
    row.binding.sampler[i] = defaultMaterial_.sampler[i];
    if (!maps[i]) continue;
    const bool packs = i == 1 && plan::packsOcclusion(*m);
    if (i == 2 && plan::packsOcclusion(*m)) continue;
    const TextureRow* t = packs ? packedTexture(scene, maps[1], maps[2], report) : texture(scene, maps[i], report);
    if (!t) {
      row.complete = false;
    } else if (t->texture) {
      row.binding.texture[i] = t->texture.id();
      row.binding.sampler[i] = t->sampler;
    }
  }
  return row.binding;
}

// nullptr: waits for its turn; a row without a texture: it cannot be used.
const GpuScene::TextureRow* GpuScene::texture(const Scene& scene, Id<Texture> id, Report& report) {
  static const TextureRow kNone;
  const Texture* t = scene.textures.get(id);
  if (!t) return &kNone;
  TextureRow& row = textures_[id.index];
  if (row.revision == scene.textures.revision(id)) return &row;
  if (!admit(t->image.byteSize() * 4 / 3)) return nullptr;
  row = {scene.textures.revision(id), id.generation, {}, sampler(t->sampler)};
  auto uploaded = uploadTexture(*t, nullptr);
  if (uploaded)
    row.texture = std::move(*uploaded);
  else
    report.warn(uploaded.error().place, uploaded.error().what + ": the material goes on without it");
  return &row;
}

const GpuScene::TextureRow* GpuScene::packedTexture(const Scene& scene, Id<Texture> normal, Id<Texture> occlusion, Report& report) {
  const Texture* b = scene.textures.get(normal);
  const Texture* c = scene.textures.get(occlusion);
  if (!b || !c) return texture(scene, normal, report);
  TextureRow& row = packed_[{normal.index, occlusion.index}];
  if (row.revision) return &row;
  if (!admit(b->image.byteSize() * 4 / 3)) return nullptr;
  row = {scene.textures.revision(normal), normal.generation, {}, sampler(b->sampler)};
  auto uploaded = uploadTexture(*b, c);
  if (uploaded)
    row.texture = std::move(*uploaded);
  else
    report.warn(uploaded.error().place, uploaded.error().what + ": the material goes on without it");
  return &row;
}

// `occlusion`: a map C to pack into map B, or nullptr.
Result<gl::Texture> GpuScene::uploadTexture(const Texture& t, const Texture* occlusion) {
  auto made = scene::levelsOf(t, occlusion);
  if (!made) return fail(made.error());
  const std::vector<Image>& levels = *made;
  const KindFormat f = formatOf(t.kind, t.image.channels);
  auto texture = gl::Texture::create(device_, {.format = f.format, .width = t.image.width, .height = t.image.height, .levels = int(levels.size())}, t.name);
  if (!texture) return texture;
  for (std::size_t k = 0; k < levels.size(); ++k) texture->upload(int(k), levels[k].data.data());
  return texture;
}

GLuint GpuScene::sampler(const Sampler& s) {
  for (const auto& [key, made] : samplers_)
    if (key == s) return made.id();
  gl::SamplerDesc d;
  d.magFilter = s.magnifyLinear ? GL_LINEAR : GL_NEAREST;
  if (!s.mips)
    d.minFilter = s.minifyLinear ? GL_LINEAR : GL_NEAREST;
  else if (s.minifyLinear)
    d.minFilter = s.mipLinear ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_NEAREST;
  else
    d.minFilter = s.mipLinear ? GL_NEAREST_MIPMAP_LINEAR : GL_NEAREST_MIPMAP_NEAREST;
  d.wrapS = wrapOf(s.wrapU);
  d.wrapT = wrapOf(s.wrapV);
  samplers_.emplace_back(s, gl::Sampler::create(device_, d, "material sampler"));
  return samplers_.back().second.id();
}

}  // namespace burnish::gpu_scene
