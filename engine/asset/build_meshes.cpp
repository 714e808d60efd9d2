// Primitives as they stand in the file to indexed triangle lists (glTF 2.0, section 3.7.2).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "asset/gather.h"

namespace burnish::asset {
namespace {

enum Mode { Triangles = 4, TriangleStrip = 5, TriangleFan = 6 };

// The indices as stored; without an accessor 0, 1, 2, ... Each is checked against the number of vertices.
std::vector<std::uint32_t> readIndices(Builder& b, const PrimitiveSource& p, std::uint64_t vertices,
                                       const std::string& path) {
  const std::uint64_t count = p.indices < 0 ? vertices : accessorAt(b, p.indices).count;
  if (count * 12 > b.bytesLeft) {
    b.check.fail(path, "the primitives stand for far more data than the file holds",
                 "share meshes between nodes, not data between meshes");
    return {};
  }
  b.bytesLeft -= count * 12;
  std::vector<std::uint32_t> out(count);
  if (p.indices < 0) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::uint32_t(i);
    return out;
  }
  const Accessor& a = accessorAt(b, p.indices);
  const Elements e(b.doc, a);
  const double restart = std::ldexp(1.0, 8 * componentBytes(a.component)) - 1;
  std::optional<std::uint64_t> bad;
  double badValue = 0;
  e.each([&](std::uint64_t i, const double* v) {
    if (*v >= double(vertices) || *v == restart) {
      if (!bad) bad = i, badValue = *v;
      return;
    }
    out[i] = std::uint32_t(*v);
  });
  if (!bad) return out;
  const char* why = badValue == restart ? " (the primitive restart value, which glTF forbids)" : "";
  b.check.fail(path + "/indices",
               fmt::format("element {} is {}, the primitive has {} vertices{}", *bad, badValue, vertices, why));
  return {};
}

// Strips and fans to lists: glTF 2.0, section 3.7.2.1.
std::vector<std::uint32_t> toTriangles(const std::vector<std::uint32_t>& v, int mode) {
  if (mode == Triangles) return {v.begin(), v.end() - std::ptrdiff_t(v.size() % 3)};
  std::vector<std::uint32_t> out;
  if (v.size() < 3) return out;
  out.reserve((v.size() - 2) * 3);
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TriangleFan)
      out.insert(out.end(), {v[i + 1], v[i + 2], v[0]});
    else
      out.insert(out.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
  }
  return out;
}

// Many writers let all primitives share one large vertex buffer: where few of its vertices are used, only those are
// taken.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& indices, std::uint64_t vertices) {
  std::vector<std::uint32_t> used;
  if (indices.size() >= vertices / 2) return used;
  used = indices;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (std::uint32_t& i : indices) i = std::uint32_t(std::lower_bound(used.begin(), used.end(), i) - used.begin());
  return used;
}

void mendColors(Check& check, std::vector<glm::vec4>& colors, const std::string& path) {
  bool clamped = false;
  for (glm::vec4& c : colors) {
    const glm::vec4 inside = glm::clamp(c, 0.0f, 1.0f);
    clamped = clamped || glm::any(glm::notEqual(inside, c));
    c = inside;
  }
  if (clamped) check.warn(path + "/attributes/COLOR_0", "colours outside 0 to 1 are clamped");
}

void mendTangents(Check& check, std::vector<glm::vec4>& tangents, const std::string& path) {
  bool bad = false;
  for (glm::vec4& t : tangents) {
    bad = bad || std::abs(std::abs(t.w) - 1) > 0.01f;
    t.w = t.w < 0 ? -1.0f : 1.0f;
  }
  if (bad)
    check.warn(path + "/attributes/TANGENT", "tangents whose w is neither 1 nor -1 take the sign that is nearer");
}

bool dataMissing(const Builder& b, const PrimitiveSource& p) {
  const auto missing = [&](int accessor) {
    return accessor >= 0 && !Elements(b.doc, accessorAt(b, accessor)).available();
  };
  for (const char* semantic : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
    if (missing(p.find(semantic))) return true;
  return missing(p.indices) || deformationMissing(b, p);
}

// What the material asks of the primitive, and what the primitive brings in vain.
void warnOfAttributes(const Builder& b, const PrimitiveSource& p, const std::string& path) {
  for (const Attribute& at : p.attributes)
    if ((at.semantic.starts_with("TEXCOORD_") && at.semantic != "TEXCOORD_0" && at.semantic != "TEXCOORD_1") ||
        (at.semantic.starts_with("COLOR_") && at.semantic != "COLOR_0"))
      b.check.warn(path + "/attributes/" + at.semantic,
                   fmt::format("attribute {} is not supported and ignored", at.semantic));
  if (p.material < 0) return;
  const Material& m = b.doc.materials[std::size_t(p.material)];
  for (const TextureRef* t :
       {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture, &m.emissiveTexture,
        &m.specularTexture, &m.specularColorTexture, &m.diffuseTexture, &m.specularGlossinessTexture})
    if (*t && p.find(t->uvSet ? "TEXCOORD_1" : "TEXCOORD_0") < 0)
      b.check.warn(path + "/material",
                   fmt::format("the material's textures need TEXCOORD_{}, which the primitive lacks", t->uvSet));
}

void buildPrimitive(Builder& b, const PrimitiveSource& p, const std::string& path, Mesh& mesh) {
  const int positions = p.find("POSITION");
  if (positions < 0) return;  // the validator said so
  if (dataMissing(b, p)) return b.check.warn(path, "the buffers of this primitive have no data: it is left out");
  const std::uint64_t vertices = accessorAt(b, positions).count;
  std::vector<std::uint32_t> indices = readIndices(b, p, vertices, path);
  if (!b.check.ok()) return;
  if (p.mode < Triangles)
    return b.check.warn(path + "/mode", "points and lines are not supported: the primitive is left out");
  if (p.mode == Triangles && indices.size() % 3)
    b.check.warn(path, "the number of indices is no multiple of 3: the rest is left out");
  Primitive out;
  out.material = p.material;
  out.indices = toTriangles(indices, p.mode);
  indices = {};
  const std::vector<std::uint32_t> used = compact(out.indices, vertices);
  if (out.indices.empty()) return b.check.warn(path, "the primitive has no triangles: it is left out");
  const Gather gather{b, p, used, vertices, path};
  out.positions = gather.operator()<glm::vec3>("POSITION");
  out.normals = gather.operator()<glm::vec3>("NORMAL");
  if (!out.normals.empty()) out.tangents = gather.operator()<glm::vec4>("TANGENT");
  out.uv0 = gather.operator()<glm::vec2>("TEXCOORD_0");
  out.uv1 = gather.operator()<glm::vec2>("TEXCOORD_1");
  out.colors = gather.operator()<glm::vec4>("COLOR_0", glm::vec4(1));
  mendColors(b.check, out.colors, path);
  mendTangents(b.check, out.tangents, path);
  warnOfAttributes(b, p, path);
  gatherDeformation(gather, out);
  mesh.primitives.push_back(std::move(out));
}

}  // namespace

std::vector<Mesh> buildMeshes(Check& check, const Document& doc, std::uint64_t sourceBytes) {
  Builder b{check, doc, outputBudget(sourceBytes)};
  std::vector<Mesh> meshes(doc.meshes.size());
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    meshes[m].name = doc.meshes[m].name;
    meshes[m].weights.assign(doc.meshes[m].weights.begin(), doc.meshes[m].weights.end());
    meshes[m].targetNames = doc.meshes[m].targetNames;
    for (std::size_t p = 0; check.ok() && p < doc.meshes[m].primitives.size(); ++p)
      buildPrimitive(b, doc.meshes[m].primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p), meshes[m]);
  }
  return meshes;
}

}  // namespace burnish::asset
