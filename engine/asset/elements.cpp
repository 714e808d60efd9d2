#include "asset/elements.h"

namespace burnish::asset {
namespace {

std::uint64_t loadUnsigned(const std::byte* from, int bytes) {
  std::uint64_t v = 0;
  std::memcpy(&v, from, std::size_t(bytes));  // little-endian, as the file and every machine this runs on
  return v;
}

double normalizationOf(const Accessor& a) {
  if (!a.normalized) return 1;
  switch (a.component) {
    case Component::I8:
      return 1.0 / 127;
    case Component::U8:
      return 1.0 / 255;
    case Component::I16:
      return 1.0 / 32767;
    case Component::U16:
      return 1.0 / 65535;
    default:
      return 1;
  }
}

}  // namespace

Elements::Elements(const Document& doc, const Accessor& a) : a_(a), scale_(normalizationOf(a)) {
  const int rows = a.shape == Shape::Mat2 ? 2 : a.shape == Shape::Mat3 ? 3 : 4;
  const int bytes = componentBytes(a.component);
  const int column = a.shape >= Shape::Mat2 ? (rows * bytes + 3) / 4 * 4 : rows * bytes;
  for (int c = 0; c < a.components(); ++c) offsets_[c] = std::size_t(c / rows * column + c % rows * bytes);
  if (a.view >= 0) {
    const auto view = bytesOf(doc, a.view);
    available_ = !view.empty();
    base_ = available_ ? view.data() + a.offset : nullptr;
    const std::uint32_t stride = doc.views[std::size_t(a.view)].stride;
    stride_ = stride ? stride : a.packedStride();
  }
  if (!a.sparse) return;
  const auto indices = bytesOf(doc, a.sparse->indexView), values = bytesOf(doc, a.sparse->valueView);
  available_ = available_ && !indices.empty() && !values.empty();
  if (!available_) return;
  indices_ = indices.data() + a.sparse->indexOffset;
  values_ = values.data() + a.sparse->valueOffset;
  sparseCount_ = a.sparse->count;
}

void Elements::at(std::uint64_t index, double* v) const {
  const std::byte* from = base_ ? base_ + index * stride_ : nullptr;
  std::uint64_t low = 0, high = sparseCount_;
  while (low < high) {
    const std::uint64_t middle = (low + high) / 2;
    (sparseIndex(middle) < index ? low : high) = sparseIndex(middle) < index ? middle + 1 : middle;
  }
  if (low < sparseCount_ && sparseIndex(low) == index) from = values_ + low * a_.packedStride();
  switch (a_.component) {
    case Component::I8:
      return load<std::int8_t>(from, v);
    case Component::U8:
      return load<std::uint8_t>(from, v);
    case Component::I16:
      return load<std::int16_t>(from, v);
    case Component::U16:
      return load<std::uint16_t>(from, v);
    case Component::U32:
      return load<std::uint32_t>(from, v);
    case Component::F32:
      return load<float>(from, v);
    case Component::Unknown:
      return;
  }
}

std::uint64_t Elements::sparseIndex(std::uint64_t k) const {
  const int bytes = componentBytes(a_.sparse->indexComponent);
  return loadUnsigned(indices_ + k * std::uint64_t(bytes), bytes);
}

}  // namespace burnish::asset
