// Buffers, views and accessors against each other: bounds, alignment, strides, and one use for each view. Sums stay
// below 2^54, so nothing overflows.
#include <fmt/format.h>

#include "asset/document.h"

namespace burnish::asset {
namespace {

std::string viewPath(std::size_t i, const char* member) { return fmt::format("/bufferViews/{}/{}", i, member); }

void validateViews(Check& check, Document& doc) {
  for (std::size_t i = 0; check.ok() && i < doc.views.size(); ++i) {
    const BufferView& v = doc.views[i];
    Buffer& b = doc.buffers[std::size_t(v.buffer)];
    b.used = true;
    const std::string does = fmt::format("does not fit buffer {} of {} bytes", v.buffer, b.byteLength);
    if (v.offset >= b.byteLength)
      check.fail(viewPath(i, "byteOffset"), fmt::format("offset {} {}", v.offset, does));
    else if (v.offset + v.length > b.byteLength)
      check.fail(viewPath(i, "byteLength"), fmt::format("offset {}, length {} {}", v.offset, v.length, does));
    else if (v.stride > v.length)
      check.fail(viewPath(i, "byteStride"), fmt::format("stride {} is greater than the length {}", v.stride, v.length));
  }
}

struct Fit {
  int view;
  std::uint64_t offset, count, elementBytes, stride;
  std::uint64_t alignment;       // of the offset in the view: 4 for matrices, else the component's size
  std::uint64_t componentBytes;  // alignment in the buffer
};

// One run of elements in one view (glTF 2.0, section 3.6.2.4: Data Alignment).
void checkFit(Check& check, const Document& doc, const Fit& f, const std::string& path) {
  const BufferView& v = doc.views[std::size_t(f.view)];
  const std::uint64_t length = (f.count - 1) * f.stride + f.elementBytes;
  if (f.offset % f.alignment)
    check.fail(path + "/byteOffset", fmt::format("offset {} is not a multiple of {}", f.offset, f.alignment));
  else if ((f.offset + v.offset) % f.componentBytes)
    check.fail(path, fmt::format("its place in the buffer, {}, is not a multiple of {}", f.offset + v.offset,
                                 f.componentBytes));
  else if (f.offset + length > v.length)
    check.fail(path, fmt::format("{} elements from offset {} take {} bytes, buffer view {} has {}", f.count, f.offset,
                                 length, f.view, v.length));
}

void validateAccessor(Check& check, Document& doc, std::size_t index) {
  const Accessor& a = doc.accessors[index];
  if (!a.readable()) return;
  const std::string path = fmt::format("/accessors/{}", index);
  const std::uint64_t component = std::uint64_t(componentBytes(a.component));
  const std::uint64_t alignment = a.shape >= Shape::Mat2 ? 4 : component;
  if (a.view >= 0) {
    const std::uint32_t stride = doc.views[std::size_t(a.view)].stride;
    if (stride && stride < a.elementBytes())
      check.fail(path,
                 fmt::format("the view's stride of {} bytes is less than the element's {}", stride, a.elementBytes()));
    checkFit(check, doc,
             {a.view, a.offset, a.count, a.elementBytes(), stride ? stride : a.packedStride(), alignment, component},
             path);
  }
  if (!a.sparse) return;
  const Sparse& s = *a.sparse;
  for (const auto& [view, part] : {std::pair(s.indexView, "indices"), std::pair(s.valueView, "values")}) {
    const std::string place = fmt::format("{}/sparse/{}/bufferView", path, part);
    useView(check, doc, view, Usage::Sparse, place);
  }
  const std::uint64_t bytes = std::uint64_t(componentBytes(s.indexComponent));
  checkFit(check, doc, {s.indexView, s.indexOffset, s.count, bytes, bytes, bytes, bytes}, path + "/sparse/indices");
  checkFit(check, doc, {s.valueView, s.valueOffset, s.count, a.elementBytes(), a.packedStride(), alignment, component},
           path + "/sparse/values");
}

}  // namespace

void useView(Check& check, Document& doc, int view, Usage usage, const std::string& path) {
  constexpr const char* kNames[] = {"nothing",      "vertices",     "indices", "a picture", "matrices of a skin",
                                    "an animation", "sparse values"};
  if (!check.ok() || view < 0) return;
  BufferView& v = doc.views[std::size_t(view)];
  if (v.usage != Usage::None && v.usage != usage)
    check.fail(path,
               fmt::format("buffer view {} is used for {} and for {}", view, kNames[int(v.usage)], kNames[int(usage)]));
  else if (v.stride && usage != Usage::Vertices)
    check.fail(path, fmt::format("buffer view {} has a stride and holds {}", view, kNames[int(usage)]));
  v.usage = usage;
}

void validateAccessors(Check& check, Document& doc) {
  for (std::size_t i = 0; check.ok() && i < doc.accessors.size(); ++i) validateAccessor(check, doc, i);
}

void validateDocument(Check& check, Document& doc) {
  validateViews(check, doc);
  if (check.ok()) validateAccessors(check, doc);
  for (std::size_t i = 0; check.ok() && i < doc.pictures.size(); ++i)
    useView(check, doc, doc.pictures[i].view, Usage::Image, fmt::format("/images/{}/bufferView", i));
  for (const auto validate : {validateMeshes, validateNodes, validateSkins, validateAnimations})
    if (check.ok()) validate(check, doc);
}

}  // namespace burnish::asset
