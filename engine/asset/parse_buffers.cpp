// Buffers, buffer views and accessors of a glTF file.
#include <fmt/format.h>

#include "asset/document.h"

namespace burnish::asset {
namespace {

constexpr std::uint64_t kArrayBuffer = 34962, kElementArrayBuffer = 34963;

Component parseComponent(const At& at, Check& check) {
  const std::uint64_t v = check.integer(at, "componentType", 0, 0, Check::kMaxInteger, Need::Required);
  if ((v >= 5120 && v <= 5123) || v == 5125 || v == 5126) return Component(v);
  if (check.ok()) check.warn(at.path() + "/componentType", fmt::format("unknown component type {}", v));
  return Component::Unknown;
}

Shape parseShape(const At& at, Check& check) {
  constexpr std::string_view kNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  const std::string* name = check.string(at, "type", Need::Required);
  if (!name) return Shape::Unknown;
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (kNames[i] == *name) return Shape(i + 1);
  check.warn(at.path() + "/type", fmt::format("unknown accessor type '{}'", name->substr(0, 40)));
  return Shape::Unknown;
}

Sparse parseSparse(const At& at, Check& check, std::uint64_t accessorCount) {
  Sparse s;
  check.known(at, {"count", "indices", "values"});
  s.count = check.integer(at, "count", 1, 1, Check::kMaxInteger, Need::Required);
  if (check.ok() && s.count > accessorCount)
    check.fail(at.path() + "/count", fmt::format("{} elements are replaced of {}", s.count, accessorCount));
  check.withObject(
      at, "indices",
      [&](const At& indices) {
        check.known(indices, {"bufferView", "byteOffset", "componentType"});
        s.indexView = check.reference(indices, "bufferView", Table::BufferViews, Need::Required);
        s.indexOffset = check.integer(indices, "byteOffset", 0);
        s.indexComponent = parseComponent(indices, check);
        if (check.ok() && s.indexComponent != Component::U8 && s.indexComponent != Component::U16 &&
            s.indexComponent != Component::U32)
          check.fail(indices.path() + "/componentType", "indices of sparse values must be unsigned");
      },
      Need::Required);
  check.withObject(
      at, "values",
      [&](const At& values) {
        check.known(values, {"bufferView", "byteOffset"});
        s.valueView = check.reference(values, "bufferView", Table::BufferViews, Need::Required);
        s.valueOffset = check.integer(values, "byteOffset", 0);
      },
      Need::Required);
  return s;
}

void parseAccessor(const At& at, Check& check, Document& doc) {
  Accessor& a = doc.accessors.emplace_back();
  check.known(at, {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "max", "min", "sparse"});
  a.view = check.reference(at, "bufferView", Table::BufferViews);
  a.offset = check.integer(at, "byteOffset", 0);
  if (a.view < 0 && check.ok() && at->contains("byteOffset"))
    check.fail(at.path() + "/byteOffset", "byteOffset needs a bufferView");
  a.component = parseComponent(at, check);
  a.shape = parseShape(at, check);
  a.count = check.integer(at, "count", 1, 1, 0xffffffffu, Need::Required);
  a.normalized = check.boolean(at, "normalized", false);
  if (a.normalized && (a.component == Component::F32 || a.component == Component::U32))
    check.fail(at.path() + "/normalized",
               fmt::format("{} cannot be normalized", formatName(a.shape, a.component, false)));
  a.min = check.numberList(at, "min", std::size_t(a.components()));
  a.max = check.numberList(at, "max", std::size_t(a.components()));
  check.withObject(at, "sparse", [&](const At& sparse) { a.sparse = parseSparse(sparse, check, a.count); });
}

}  // namespace

void parseBuffers(const At& root, Check& check, Document& doc) {
  check.eachObject(root, "buffers", [&](const At& at, std::size_t) {
    Buffer& b = doc.buffers.emplace_back();
    check.known(at, {"uri", "byteLength"});
    b.uri = check.string(at, "uri");
    b.byteLength = check.integer(at, "byteLength", 1, 1, Check::kMaxInteger, Need::Required);
  });
  check.eachObject(root, "bufferViews", [&](const At& at, std::size_t) {
    BufferView& v = doc.views.emplace_back();
    check.known(at, {"buffer", "byteOffset", "byteLength", "byteStride", "target"});
    v.buffer = check.reference(at, "buffer", Table::Buffers, Need::Required);
    v.offset = check.integer(at, "byteOffset", 0);
    v.length = check.integer(at, "byteLength", 1, 1, Check::kMaxInteger, Need::Required);
    v.stride = std::uint32_t(check.integer(at, "byteStride", 0, 4, 252));
    if (v.stride % 4) check.fail(at.path() + "/byteStride", fmt::format("{} is not a multiple of 4", v.stride));
    const std::uint64_t target = check.integer(at, "target", 0);
    if (target == kArrayBuffer) v.usage = Usage::Vertices;
    if (target == kElementArrayBuffer) v.usage = Usage::Indices;
    if (target && v.usage == Usage::None)
      check.warn(at.path() + "/target", fmt::format("unknown target {} is ignored", target));
    if (v.usage == Usage::Indices && v.stride)
      check.fail(at.path() + "/byteStride", "only views of vertex data may have a stride");
  });
  check.eachObject(root, "accessors", [&](const At& at, std::size_t) { parseAccessor(at, check, doc); });
}

}  // namespace burnish::asset
