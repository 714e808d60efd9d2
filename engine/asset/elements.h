// The elements of an accessor as numbers, sparse replacements applied, without a copy.
#pragma once
#include <cstring>

#include "asset/buffers.h"

namespace burnish::asset {

class Elements {
 public:
  /// The accessor must be readable and its bounds validated; `available` says whether its data are there.
  Elements(const Document& doc, const Accessor& accessor);
  [[nodiscard]] bool available() const { return available_; }

  /// f(index, const double* components) for every element in order; components as stored, not normalized.
  template <class F>
  void each(F&& f) const {
    switch (a_.component) {
      case Component::I8:
        return run<std::int8_t>(f);
      case Component::U8:
        return run<std::uint8_t>(f);
      case Component::I16:
        return run<std::int16_t>(f);
      case Component::U16:
        return run<std::uint16_t>(f);
      case Component::U32:
        return run<std::uint32_t>(f);
      case Component::F32:
        return run<float>(f);
      case Component::Unknown:
        return;
    }
  }
  /// One element, for those who need few of many.
  void at(std::uint64_t index, double* components) const;
  /// The index that sparse replacement k stands for.
  [[nodiscard]] std::uint64_t sparseIndex(std::uint64_t k) const;
  /// Stored to real value (glTF 2.0, section 3.6.2.2): c / max for normalized integers, at least -1.
  [[nodiscard]] double scale() const { return scale_; }

 private:
  template <class T>
  void load(const std::byte* from, double* v) const {
    const int n = a_.components();
    for (int c = 0; c < n; ++c) {
      T stored{};
      if (from) std::memcpy(&stored, from + offsets_[c], sizeof(T));
      v[c] = double(stored);
    }
  }
  template <class T, class F>
  void run(F& f) const {
    double v[16];
    std::uint64_t k = 0, next = sparseCount_ ? sparseIndex(0) : a_.count;
    for (std::uint64_t i = 0; i < a_.count; ++i) {
      const std::byte* from = base_ ? base_ + i * stride_ : nullptr;
      if (i == next) {
        from = values_ + k * a_.packedStride();
        next = ++k < sparseCount_ ? sparseIndex(k) : a_.count;
      }
      load<T>(from, v);
      f(i, static_cast<const double*>(v));
    }
  }
  const Accessor& a_;
  const std::byte* base_ = nullptr;
  const std::byte* values_ = nullptr;
  const std::byte* indices_ = nullptr;
  std::uint64_t stride_ = 0, sparseCount_ = 0;
  std::size_t offsets_[16] = {};
  double scale_ = 1;
  bool available_ = true;
};

/// Non-finite numbers, sparse indices, declared bounds, and the values of joints, skins and animations. Faults stand in
/// `check`.
void validateData(Check& check, const Document& doc, std::uint64_t sourceBytes);

/// Meshes with their vertices, indices checked against them. Primitives that cannot be shown are left out with a
/// warning.
std::vector<Mesh> buildMeshes(Check& check, const Document& doc, std::uint64_t sourceBytes);
/// Skins and animations into the asset, whose nodes are there; `shown`: the asset's node for each of the document's, -1
/// for those that the scene does not show.
void buildMotion(Check& check, const Document& doc, const std::vector<int>& shown, std::uint64_t sourceBytes, Asset& asset);

}  // namespace burnish::asset
