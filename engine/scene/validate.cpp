// What a mesh must be before anything else sees it: sizes agree, indices are in range, every number is finite, normals
// are unit length.
#include "scene/validate.h"

#include <burnish/scene.h>
#include <fmt/format.h>

#include <cmath>

#include "scene/basis.h"

namespace burnish {
namespace {

using scene::MeshFaults;

bool finite(const glm::vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }
bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const glm::vec4& v) { return finite(glm::vec3(v)) && std::isfinite(v.w); }

std::string placeOf(const Mesh& mesh) { return fmt::format("mesh \"{}\"", mesh.name); }

Result<void> checkSizes(const Mesh& mesh) {
  const std::size_t n = mesh.positions.size();
  const std::pair<const char*, std::size_t> streams[] = {{"normals", mesh.normals.size()},
                                                         {"tangents", mesh.tangents.size()},
                                                         {"uv0", mesh.uv0.size()},
                                                         {"uv1", mesh.uv1.size()},
                                                         {"colors", mesh.colors.size()},
                                                         {"joints", mesh.joints.size()},
                                                         {"weights", mesh.weights.size()}};
  const auto check = [&](std::string_view name, std::size_t size) -> Result<void> {
    if (size == 0 || size == n) return {};
    return fail(placeOf(mesh), fmt::format("{} has {} elements, positions has {}", name, size, n),
                "leave the stream empty or give one element for each position");
  };
  for (const auto& [name, size] : streams)
    if (auto good = check(name, size); !good) return good;
  for (std::size_t t = 0; t < mesh.targets.size(); ++t)
    for (const auto& [name, size] : {std::pair("positions", mesh.targets[t].positions.size()),
                                     std::pair("normals", mesh.targets[t].normals.size()),
                                     std::pair("tangents", mesh.targets[t].tangents.size())})
      if (auto good = check(fmt::format("targets[{}].{}", t, name), size); !good) return good;
  if (mesh.joints.size() != mesh.weights.size())
    return fail(placeOf(mesh), "only one of joints and weights is given", "give both or neither");
  if (n > 0xfffffffeu)
    return fail(placeOf(mesh), fmt::format("positions has {} elements", n), "split the mesh: indices are 32 bits");
  if (mesh.indices.size() % 3 != 0)
    return fail(placeOf(mesh), fmt::format("indices has {} elements, not a multiple of 3", mesh.indices.size()),
                "give a triangle list");
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    if (mesh.indices[i] >= n)
      return fail(placeOf(mesh), fmt::format("indices[{}] is {}, past the last of {} positions", i, mesh.indices[i], n),
                  "correct the index");
  return {};
}

/// The vector along a triangle's normal, its length twice the area; in double, so that huge and tiny triangles neither
/// overflow nor vanish.
glm::dvec3 areaNormal(const Mesh& mesh, const std::uint32_t* t) {
  const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
  return glm::cross(b - a, c - a);
}

/// Drops triangles with a non-finite corner or without area (unless something may give them one: joints, morph targets);
/// puts the non-finite positions that are left over at the origin.
void dropTriangles(Mesh& mesh, MeshFaults& faults) {
  const bool moves = !mesh.joints.empty() || !mesh.targets.empty();
  std::size_t kept = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &mesh.indices[i];
    if (!finite(mesh.positions[t[0]]) || !finite(mesh.positions[t[1]]) || !finite(mesh.positions[t[2]])) {
      ++faults.brokenTriangles;
    } else if (!moves && areaNormal(mesh, t) == glm::dvec3(0)) {
      ++faults.flatTriangles;
    } else {
      std::copy_n(t, 3, mesh.indices.begin() + std::ptrdiff_t(kept));
      kept += 3;
    }
  }
  mesh.indices.resize(kept);
  for (glm::vec3& p : mesh.positions)
    if (!finite(p)) p = glm::vec3(0);
}

template <class V, class Good>
void mendStream(std::vector<V>& stream, const V& substitute, std::size_t& mended, Good&& good) {
  for (V& v : stream)
    if (!good(v)) {
      v = substitute;
      ++mended;
    }
}

template <class V>
void unweld(std::vector<V>& stream, const std::vector<std::uint32_t>& indices) {
  if (stream.empty()) return;
  std::vector<V> out(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) out[i] = stream[indices[i]];
  stream = std::move(out);
}

/// What a weight of 1 adds to flat normals: the face normal of the moved triangle less that of the resting one (exact at
/// weights 0 and 1 of a single target).
void morphFlatNormals(const Mesh& mesh, MorphTarget& target) {
  target.tangents.clear();
  target.normals.clear();
  if (target.positions.empty()) return;
  Mesh moved;
  moved.positions = mesh.positions;
  for (std::size_t i = 0; i < moved.positions.size(); ++i) moved.positions[i] += target.positions[i];
  target.normals.resize(mesh.normals.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 n = areaNormal(moved, &mesh.indices[i]);
    const double length = glm::length(n);
    if (length > 0) target.normals[i] = target.normals[i + 1] = target.normals[i + 2] = glm::vec3(n / length) - mesh.normals[i];
  }
}

/// Face normals: every corner becomes a vertex of its own (glTF 2.0, section 3.7.2.1: without normals, flat ones are
/// calculated).
void makeFlatNormals(Mesh& mesh) {
  unweld(mesh.positions, mesh.indices);
  unweld(mesh.uv0, mesh.indices);
  unweld(mesh.uv1, mesh.indices);
  unweld(mesh.colors, mesh.indices);
  unweld(mesh.joints, mesh.indices);
  unweld(mesh.weights, mesh.indices);
  for (MorphTarget& t : mesh.targets) unweld(t.positions, mesh.indices);
  mesh.tangents.clear();  // they belong to normals that the file does not have
  mesh.normals.resize(mesh.positions.size());
  for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = i;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 along = areaNormal(mesh, &mesh.indices[i]);
    const double length = glm::length(along);
    const glm::vec3 n = length > 0 ? glm::vec3(along / length) : glm::vec3(0, 1, 0);
    mesh.normals[i] = mesh.normals[i + 1] = mesh.normals[i + 2] = n;
  }
  for (MorphTarget& t : mesh.targets) morphFlatNormals(mesh, t);
}

/// Unit length; zero and non-finite ones become the geometric normal, the area-weighted mean of the triangles around
/// the vertex.
void mendNormals(Mesh& mesh, MeshFaults& faults) {
  std::vector<glm::dvec3> geometric;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    glm::vec3& n = mesh.normals[i];
    const double length = glm::length(glm::dvec3(n));
    if (std::isfinite(length) && length > 1e-12) {
      if (std::abs(length - 1) > 1e-6) n = glm::vec3(glm::dvec3(n) / length);
      continue;
    }
    if (geometric.empty()) {
      geometric.assign(mesh.positions.size(), glm::dvec3(0));
      for (std::size_t t = 0; t < mesh.indices.size(); t += 3)
        for (int k = 0; k < 3; ++k) geometric[mesh.indices[t + k]] += areaNormal(mesh, &mesh.indices[t]);
    }
    const double around = glm::length(geometric[i]);
    n = around > 0 ? glm::vec3(geometric[i] / around) : glm::vec3(0, 1, 0);
    ++faults.normals;
  }
}

void mendTangents(Mesh& mesh, MeshFaults& faults) {
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    glm::vec4& t = mesh.tangents[i];
    const double length = glm::length(glm::dvec3(t));
    if (!std::isfinite(length) || length < 1e-12 || !std::isfinite(t.w)) {
      t = glm::vec4(scene::perpendicular(mesh.normals[i]), 1);
      ++faults.tangents;
    } else if (std::abs(length - 1) > 1e-6) {
      t = glm::vec4(glm::vec3(glm::dvec3(t) / length), t.w);
    }
    t.w = t.w < 0 ? -1.0f : 1.0f;
  }
}

/// Weights that are finite, not negative and sum to 1; a vertex without any hangs on its first joint. Sums that are off by
/// no more than what 8-bit weights round to are no fault.
void mendWeights(Mesh& mesh, MeshFaults& faults) {
  constexpr double kRounding = 4 * 0.5 / 255;
  for (glm::vec4& w : mesh.weights) {
    bool good = true;
    for (int c = 0; c < 4; ++c)
      if (!std::isfinite(w[c]) || w[c] < 0) good = false, w[c] = 0;
    const double sum = double(w.x) + double(w.y) + double(w.z) + double(w.w);
    if (sum > 0)
      w = glm::vec4(glm::dvec4(w) / sum);
    else
      w = glm::vec4(1, 0, 0, 0);
    if (!good || std::abs(sum - 1) > kRounding) ++faults.weights;
  }
}

void mendTargets(Mesh& mesh, MeshFaults& faults) {
  const auto isFinite = [](const glm::vec3& v) { return finite(v); };
  for (MorphTarget& t : mesh.targets) {
    mendStream(t.positions, glm::vec3(0), faults.deltas, isFinite);
    mendStream(t.normals, glm::vec3(0), faults.deltas, isFinite);
    mendStream(t.tangents, glm::vec3(0), faults.deltas, isFinite);
  }
}

}  // namespace

namespace scene {

MeshFaults& MeshFaults::operator+=(const MeshFaults& o) {
  brokenTriangles += o.brokenTriangles;
  flatTriangles += o.flatTriangles;
  coordinates += o.coordinates;
  colors += o.colors;
  normals += o.normals;
  tangents += o.tangents;
  weights += o.weights;
  deltas += o.deltas;
  return *this;
}

void MeshFaults::report(const std::string& place, Report& report) const {
  const std::pair<std::size_t, const char*> lines[] = {
      {brokenTriangles, "triangles with a non-finite position were dropped"},
      {flatTriangles, "triangles without area were dropped"},
      {coordinates, "non-finite texture coordinates became 0"},
      {colors, "non-finite or negative vertex colours became white"},
      {normals, "zero or non-finite normals were replaced by geometric ones"},
      {tangents, "zero or non-finite tangents were replaced by ones that follow no texture"},
      {weights, "vertices whose joint weights were negative, not finite or did not sum to 1 had them scaled"},
      {deltas, "non-finite vectors of morph targets became 0"}};
  for (const auto& [count, what] : lines)
    if (count) report.warn(place, fmt::format("{} {}", count, what));
}

Result<Mesh> validated(Mesh mesh, MeshFaults& faults) {
  if (auto sizes = checkSizes(mesh); !sizes) return fail(sizes.error());
  dropTriangles(mesh, faults);
  const auto finiteUv = [](const glm::vec2& uv) { return finite(uv); };
  mendStream(mesh.uv0, glm::vec2(0), faults.coordinates, finiteUv);
  mendStream(mesh.uv1, glm::vec2(0), faults.coordinates, finiteUv);
  mendStream(mesh.colors, glm::vec4(1), faults.colors,
             [](const glm::vec4& c) { return finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0 && c.w >= 0; });
  mendWeights(mesh, faults);
  mendTargets(mesh, faults);
  if (mesh.normals.empty())
    makeFlatNormals(mesh);
  else
    mendNormals(mesh, faults);
  mendTangents(mesh, faults);
  return mesh;
}

}  // namespace scene

Result<Mesh> validated(Mesh mesh, Report& report) {
  const std::string place = placeOf(mesh);
  scene::MeshFaults faults;
  auto good = scene::validated(std::move(mesh), faults);
  if (good) faults.report(place, report);
  return good;
}

}  // namespace burnish
