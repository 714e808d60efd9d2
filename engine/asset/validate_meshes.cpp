// Attributes and indices of primitives against the accessors that they name: formats, counts, alignment, kinds of views
// (glTF 2.0, section 3.7.2).
#include <fmt/format.h>

#include "asset/document.h"

namespace burnish::asset {
namespace {

// Sets of component types, with a second bit for the normalized form of each.
enum Formats : unsigned {
  F32 = 1,
  I8 = 2,
  I8n = 4,
  U8 = 8,
  U8n = 16,
  I16 = 32,
  I16n = 64,
  U16 = 128,
  U16n = 256,
  U32 = 512,
  AnyFormat = 1023
};

unsigned formatOf(const Accessor& a) {
  switch (a.component) {
    case Component::F32:
      return F32;
    case Component::I8:
      return a.normalized ? I8n : I8;
    case Component::U8:
      return a.normalized ? U8n : U8;
    case Component::I16:
      return a.normalized ? I16n : I16;
    case Component::U16:
      return a.normalized ? U16n : U16;
    case Component::U32:
      return U32;
    case Component::Unknown:
      break;
  }
  return 0;
}

struct Allowed {
  unsigned shapes;  // bits 1 << Shape
  unsigned formats, quantized;
};
constexpr unsigned bit(Shape s) { return 1u << unsigned(s); }

Allowed allowedFor(std::string_view semantic, bool target) {
  constexpr unsigned kAnyQuantized = I8 | I8n | I16 | I16n;
  if (semantic == "POSITION") return {bit(Shape::Vec3), F32, kAnyQuantized | (target ? 0u : U8 | U8n | U16 | U16n)};
  if (semantic == "NORMAL") return {bit(Shape::Vec3), F32, target ? kAnyQuantized : I8n | I16n};
  if (semantic == "TANGENT") return {bit(target ? Shape::Vec3 : Shape::Vec4), F32, target ? kAnyQuantized : I8n | I16n};
  if (semantic.starts_with("TEXCOORD_")) return {bit(Shape::Vec2), F32 | U8n | U16n, kAnyQuantized | U8 | U16};
  if (semantic.starts_with("COLOR_")) return {bit(Shape::Vec3) | bit(Shape::Vec4), F32 | U8n | U16n, 0};
  if (semantic.starts_with("JOINTS_")) return {bit(Shape::Vec4), U8 | U16, 0};
  if (semantic.starts_with("WEIGHTS_")) return {bit(Shape::Vec4), F32 | U8n | U16n, 0};
  return {~0u, AnyFormat & ~U32, 0};
}

struct Checked {
  Check& check;
  Document& doc;
  const PrimitiveSource& source;
  std::string path;  // "/meshes/0/primitives/1"
};

void checkVertexAccessor(Checked& p, const Attribute& at, bool target, const std::string& path) {
  const Accessor& a = p.doc.accessors[std::size_t(at.accessor)];
  const Allowed allowed = allowedFor(at.semantic, target);
  const unsigned formats = allowed.formats | (p.doc.quantized ? allowed.quantized : 0);
  if (!(allowed.shapes & bit(a.shape)) || !(formats & formatOf(a)))
    return p.check.fail(path, fmt::format("accessor {} is {}, which {} cannot be", at.accessor,
                                          formatName(a.shape, a.component, a.normalized), at.semantic));
  if (at.semantic == "POSITION" && (a.min.empty() || a.max.empty()))
    return p.check.fail(path, fmt::format("accessor {} has no min and max, which positions need", at.accessor));
  if (a.view < 0) return;
  BufferView& v = p.doc.views[std::size_t(a.view)];
  if (a.offset % 4 || (v.stride == 0 && a.elementBytes() % 4 && a.count > 1))
    return p.check.fail(path,
                        fmt::format("accessor {} is not aligned to 4 bytes, which vertex data must be", at.accessor),
                        "pad the elements and give the view a byteStride");
  if (v.vertexAccessor >= 0 && v.vertexAccessor != at.accessor && v.stride == 0)
    return p.check.fail(path,
                        fmt::format("buffer view {} holds several vertex accessors and has no byteStride", a.view),
                        "give the view a byteStride");
  v.vertexAccessor = at.accessor;
  useView(p.check, p.doc, a.view, Usage::Vertices, path);
}

void checkAttributes(Checked& p) {
  std::uint64_t count = 0;
  for (const Attribute& at : p.source.attributes) {
    std::string path = p.path + "/attributes";
    appendPointer(path, at.semantic);
    checkVertexAccessor(p, at, false, path);
    const std::uint64_t n = p.doc.accessors[std::size_t(at.accessor)].count;
    if (count && n != count)
      p.check.fail(path, fmt::format("{} elements where the other attributes have {}", n, count));
    count = n;
  }
  const auto has = [&](const char* name) { return p.source.find(name) >= 0; };
  if (!has("POSITION")) p.check.warn(p.path + "/attributes", "there are no positions: the primitive is left out");
  if (has("TANGENT") && !has("NORMAL"))
    p.check.warn(p.path + "/attributes/TANGENT", "tangents without normals are ignored");
}

void checkTargets(Checked& p) {
  for (std::size_t t = 0; p.check.ok() && t < p.source.targets.size(); ++t)
    for (const Attribute& at : p.source.targets[t]) {
      std::string path = fmt::format("{}/targets/{}", p.path, t);
      appendPointer(path, at.semantic);
      const int base = p.source.find(at.semantic);
      if (base < 0) return p.check.fail(path, "the primitive itself has no such attribute");
      if (p.doc.accessors[std::size_t(base)].count != p.doc.accessors[std::size_t(at.accessor)].count)
        return p.check.fail(path, "the number of elements differs from the primitive's");
      checkVertexAccessor(p, at, true, path);
    }
}

void checkIndices(Checked& p) {
  if (p.source.indices < 0) return;
  const Accessor& a = p.doc.accessors[std::size_t(p.source.indices)];
  const std::string path = p.path + "/indices";
  if (a.shape != Shape::Scalar || !(formatOf(a) & (U8 | U16 | U32)))
    return p.check.fail(path, fmt::format("accessor {} is {}, which indices cannot be", p.source.indices,
                                          formatName(a.shape, a.component, a.normalized)));
  useView(p.check, p.doc, a.view, Usage::Indices, path);
}

}  // namespace

void validateMeshes(Check& check, Document& doc) {
  for (std::size_t m = 0; m < doc.meshes.size(); ++m)
    for (std::size_t i = 0; check.ok() && i < doc.meshes[m].primitives.size(); ++i) {
      Checked p{check, doc, doc.meshes[m].primitives[i], fmt::format("/meshes/{}/primitives/{}", m, i)};
      checkAttributes(p);
      if (check.ok()) checkTargets(p);
      if (check.ok()) checkIndices(p);
    }
}

}  // namespace burnish::asset
