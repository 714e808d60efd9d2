// Elements of accessors into the vectors of a primitive, within a budget.
#pragma once
#include <algorithm>

#include "asset/elements.h"

namespace burnish::asset {

/// Bytes that may be made of a file: a small one may name the same data very often.
inline std::uint64_t outputBudget(std::uint64_t sourceBytes) { return (std::uint64_t(128) << 20) + 64 * sourceBytes; }

struct Builder {
  Check& check;
  const Document& doc;
  std::uint64_t bytesLeft;
};

inline const Accessor& accessorAt(const Builder& b, int index) { return b.doc.accessors[std::size_t(index)]; }

struct Gather {
  Builder& b;
  const PrimitiveSource& source;
  const std::vector<std::uint32_t>& used;  // empty: all vertices
  std::uint64_t vertices;
  const std::string& path;

  template <class V>
  std::vector<V> operator()(std::string_view semantic, V fill = V(0)) const {
    return read<V>(source.find(semantic), fill);
  }
  /// The accessor's elements for the primitive's vertices; nothing without one (-1).
  template <class V>
  std::vector<V> read(int accessor, V fill = V(0)) const {
    std::vector<V> out;
    const std::uint64_t count = used.empty() ? vertices : used.size();
    if (accessor < 0 || !b.check.ok()) return out;
    if (count * sizeof(V) > b.bytesLeft) {
      b.check.fail(path, "the primitives stand for far more data than the file holds",
                   "share meshes between nodes, not data between meshes");
      return out;
    }
    b.bytesLeft -= count * sizeof(V);
    const Accessor& a = accessorAt(b, accessor);
    const Elements e(b.doc, a);
    const int n = std::min(a.components(), int(V::length()));
    out.assign(count, fill);
    const auto put = [&](std::uint64_t i, const double* v) {
      for (int c = 0; c < n; ++c)
        out[i][c] = typename V::value_type(a.normalized ? std::max(v[c] * e.scale(), -1.0) : v[c]);
    };
    double v[16];
    for (std::size_t i = 0; i < used.size(); ++i) e.at(used[i], v), put(i, v);
    if (used.empty()) e.each(put);
    return out;
  }
};

/// Whether joints, weights or morph targets name data that are not there.
bool deformationMissing(const Builder& b, const PrimitiveSource& p);
/// Joints, weights and morph targets; more than four joints a vertex are reduced to four with a warning.
void gatherDeformation(const Gather& gather, Primitive& out);

}  // namespace burnish::asset
