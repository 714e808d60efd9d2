#include "asset/document.h"

#include <fmt/format.h>

namespace burnish::asset {

int componentBytes(Component c) {
  switch (c) {
    case Component::I8:
    case Component::U8:
      return 1;
    case Component::I16:
    case Component::U16:
      return 2;
    case Component::U32:
    case Component::F32:
      return 4;
    case Component::Unknown:
      break;
  }
  return 0;
}

int componentCount(Shape s) {
  constexpr int kCounts[] = {0, 1, 2, 3, 4, 4, 9, 16};
  return kCounts[int(s)];
}

std::string formatName(Shape s, Component c, bool normalized) {
  constexpr const char* kShapes[] = {"?", "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
  constexpr const char* kComponents[] = {"BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT",
                                         "?",    "UNSIGNED_INT",  "FLOAT"};
  const char* component = c == Component::Unknown ? "?" : kComponents[int(c) - int(Component::I8)];
  return fmt::format("{} of {}{}", kShapes[int(s)], component, normalized ? " normalized" : "");
}

std::uint64_t Accessor::elementBytes() const {
  const std::uint64_t bytes = std::uint64_t(componentBytes(component));
  if (shape == Shape::Mat2 && bytes == 1) return 6;
  if (shape == Shape::Mat3 && bytes == 1) return 11;
  if (shape == Shape::Mat3 && bytes == 2) return 22;
  return bytes * std::uint64_t(components());
}

std::uint64_t Accessor::packedStride() const {
  const bool matrix = shape >= Shape::Mat2;
  return matrix ? (elementBytes() + 3) / 4 * 4 : elementBytes();
}

int PrimitiveSource::find(std::string_view semantic) const {
  for (const Attribute& a : attributes)
    if (a.semantic == semantic) return a.accessor;
  return -1;
}

}  // namespace burnish::asset
