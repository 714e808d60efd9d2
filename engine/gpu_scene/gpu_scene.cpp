#include "gpu_scene/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "image/resample.h"
#include "material/mips.h"
#include "plan/variants.h"

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

// RGB to RGBA and the like; missing channels are opaque.
Image withChannels(const Image& in, int channels) {
  if (in.channels == channels) return in;
  Image out = makeImage(in.width, in.height, channels, PixelType::U8);
  const std::uint8_t* from = in.u8();
  std::uint8_t* to = out.u8();
  for (std::size_t i = 0; i < in.pixelCount(); ++i)
    for (int c = 0; c < channels; ++c) to[i * std::size_t(channels) + std::size_t(c)] = c < in.channels ? from[i * std::size_t(in.channels) + std::size_t(c)] : 255;
  return out;
}

float finiteOr(float value, float low, float high, float otherwise) { return std::isfinite(value) ? std::clamp(value, low, high) : otherwise; }

vec4 uvRow(const UvMapping& uv, int row) {
  const glm::mat3x2& t = uv.transform;
  const auto fin = [](float f) { return std::isfinite(f) ? f : 0.0f; };
  return {fin(t[0][row]), fin(t[1][row]), fin(t[2][row]), float(uv.set == 1)};
}

MaterialData dataOf(const Material& m) {
  MaterialData d{};
  const auto unit = [](float f, float otherwise) { return finiteOr(f, 0, 1, otherwise); };
  d.albedo = {unit(m.albedo.r, 0.5f), unit(m.albedo.g, 0.5f), unit(m.albedo.b, 0.5f), unit(m.opacity, 1)};
  // A material without a map A takes the code from its factor: the default map's alpha counts for nothing.
  d.params = {m.mapA ? 1.0f : 0.0f, m.mapA ? 0.0f : unit(m.substance, 1.0f / 3), unit(m.roughness, 1), unit(m.occlusionStrength, 1)};
  d.emission = {finiteOr(m.emission.r, 0, 1e9f, 0), finiteOr(m.emission.g, 0, 1e9f, 0), finiteOr(m.emission.b, 0, 1e9f, 0), unit(m.alphaCutoff, 0.5f)};
  d.more = {unit(m.metalness, 0), m.unlit ? 1.0f : 0.0f, m.useVertexColor ? 1.0f : 0.0f, m.metalRoughMap ? (m.mapB ? 1.0f : 2.0f) : 0.0f};
  const UvMapping* maps[] = {&m.uvA, &m.uvB, &m.uvC, &m.uvMetalRough, &m.uvEmissive};
  for (int i = 0; i < 5; ++i)
    for (int row = 0; row < 2; ++row) d.uv[2 * i + row] = uvRow(*maps[i], row);
  for (int i = 0; i < 3; ++i) {
    d.conductorEta[i] = finiteOr(m.conductorEta[i], 0, 1e4f, 0);
    d.conductorK[i] = finiteOr(m.conductorK[i], 0, 1e4f, 0);
  }
  const float strength = unit(m.anisotropy, 0), rotation = std::isfinite(m.anisotropyRotation) ? m.anisotropyRotation : 0;
  d.conductorEta.w = strength * strength * std::cos(rotation);
  d.conductorK.w = strength * strength * std::sin(rotation);
  d.glass = {unit(m.transmission, 0), finiteOr(m.thickness, 0, 1e9f, 0), m.ior >= 1 ? finiteOr(m.ior, 1, 100, 1.5f) : 0.0f, m.blend ? 1.0f : 0.0f};
  d.attenuation.w = unit(m.diffuseRoughness, 0);
  // Beer-Lambert: color = exp(-absorption · distance). A channel of no light at all stands for a millionth.
  if (m.attenuationDistance > 0 && std::isfinite(m.attenuationDistance))
    for (int i = 0; i < 3; ++i) d.attenuation[i] = std::min(-std::log(finiteOr(m.attenuationColor[i], 1e-6f, 1, 1)) / m.attenuationDistance, 1e9f);
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
  const std::uint8_t texels[5][4] = {{255, 255, 255, 85}, {128, 128, 255, 255}, {255, 255, 0, 0}, {255, 255, 255, 255}, {255, 255, 255, 255}};
  const GLenum formats[5] = {GL_SRGB8_ALPHA8, GL_RGBA8, GL_RG8, GL_RGBA8, GL_SRGB8_ALPHA8};
  const char* names[5] = {"default map A", "default map B", "default map C", "default metal-rough", "default emissive"};
  for (std::size_t i = 0; i < 5; ++i) {
    auto t = gl::Texture::create(device_, {.format = formats[i]}, names[i]);
    if (!t) return fail(t.error());
    t->upload(0, texels[i]);
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

namespace {

Result<void> checkImage(const Texture& t) {
  if (t.image.empty() || t.image.type != PixelType::U8 || t.image.data.size() != t.image.byteSize() || t.image.channels < 1 || t.image.channels > 4)
    return fail(fmt::format("texture '{}'", t.name), "is empty, not 8 bit, or shorter than its size says", "give it an Image as makeImage makes it");
  return {};
}

std::vector<Image> levelsOf(const Texture& t, int channels) {
  if (t.sampler.mips) return material::buildMips(t.kind, withChannels(t.image, channels));
  std::vector<Image> one;
  one.push_back(withChannels(t.image, channels));
  return one;
}

// Writes the occlusion's chain into the third channel of the normals'.
void packOcclusion(std::vector<Image>& levels, const Texture& occlusion) {
  Texture c = occlusion;
  c.image = withChannels(c.image, 1);
  c.sampler.mips = levels.size() > 1;
  if (c.image.width != levels[0].width || c.image.height != levels[0].height) c.image = image::resampleArea(c.image, levels[0].width, levels[0].height);
  const std::vector<Image> from = levelsOf(c, 1);
  for (std::size_t k = 0; k < levels.size() && k < from.size(); ++k)
    for (std::size_t i = 0; i < levels[k].pixelCount(); ++i) levels[k].u8()[i * 4 + 2] = from[k].u8()[i];
}

}  // namespace

// `occlusion`: a map C to pack into map B, or nullptr.
Result<gl::Texture> GpuScene::uploadTexture(const Texture& t, const Texture* occlusion) {
  if (auto good = checkImage(t); !good) return fail(good.error());
  if (occlusion)
    if (auto good = checkImage(*occlusion); !good) return fail(good.error());
  const KindFormat f = formatOf(t.kind, t.image.channels);
  std::vector<Image> levels = levelsOf(t, f.channels);
  if (occlusion) packOcclusion(levels, *occlusion);
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
