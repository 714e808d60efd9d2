// The MikkTSpace basis, written from its published description: M. S. Mikkelsen, "Simulation of Wrinkled Surfaces
// Revisited" (2008), chapter 3, and the tangent space that glTF 2.0 asks for (section 3.7.2.1). The rules:
//  1. Corners with equal position, normal and texture coordinates are one vertex, whatever the file's indices say.
//  2. A triangle's tangent is dP/du. Its orientation is the sign of its area in the texture; mirrored and unmirrored
//  triangles are never mixed.
//  3. At a vertex, triangles of one orientation that are connected by shared edges form a group and share one tangent:
//  the mean of their tangents, each
//     projected to the plane of the vertex normal and made unit length, weighted by the triangle's angle at the vertex
//     in that plane.
//  4. Triangles without area in the texture have no tangent of their own; they join a neighbouring group. Vertices in
//  several groups are split.
#include "scene/tangents.h"

#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "scene/basis.h"

namespace burnish {
namespace scene {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::size_t mix(std::size_t seed, std::uint32_t v) { return (seed ^ v) * 0x9e3779b97f4a7c15ull + (seed >> 29); }
std::uint32_t bits(float f) { return std::bit_cast<std::uint32_t>(f + 0.0f); }  // -0 and 0 are one

/// Rule 1: for each vertex of the mesh the first vertex that equals it.
struct VertexKey {
  glm::vec3 position, normal;
  glm::vec2 uv;
  friend bool operator==(const VertexKey&, const VertexKey&) = default;
};
struct VertexHash {
  std::size_t operator()(const VertexKey& k) const {
    std::size_t h = 0;
    for (const float f : {k.position.x, k.position.y, k.position.z, k.normal.x, k.normal.y, k.normal.z, k.uv.x, k.uv.y})
      h = mix(h, bits(f));
    return h ^ (h >> 32);
  }
};

struct Face {
  glm::vec3 tangent{0};     ///< dP/du, unit; zero when the face has no area in the texture
  bool preserving = false;  ///< (u, v) turn the same way round as the triangle
  bool oriented = false;    ///< `preserving` is known: its own or taken from a neighbour
};

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

class Builder {
 public:
  Builder(Mesh& mesh, const UvMapping& mapping) : mesh_(mesh) {
    const std::vector<glm::vec2>& set = mapping.set == 1 ? mesh.uv1 : mesh.uv0;
    uv_.reserve(set.size());
    for (const glm::vec2& uv : set) uv_.push_back(mapping.transform * glm::vec3(uv, 1));
  }

  std::size_t build() {
    weld();
    makeFaces();
    findNeighbours();
    orientDegenerates();
    groupCorners();
    sumGroups();
    return assign();
  }

 private:
  [[nodiscard]] std::size_t faceCount() const { return mesh_.indices.size() / 3; }
  [[nodiscard]] std::uint32_t welded(std::size_t corner) const { return weld_[mesh_.indices[corner]]; }

  void weld() {
    std::unordered_map<VertexKey, std::uint32_t, VertexHash> first;
    first.reserve(mesh_.positions.size());
    weld_.resize(mesh_.positions.size());
    for (std::uint32_t i = 0; i < weld_.size(); ++i)
      weld_[i] = first.try_emplace({mesh_.positions[i], mesh_.normals[i], uv_[i]}, i).first->second;
  }

  void makeFaces() {
    faces_.resize(faceCount());
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const std::uint32_t* t = &mesh_.indices[3 * f];
      const glm::dvec3 d1 = glm::dvec3(mesh_.positions[t[1]]) - glm::dvec3(mesh_.positions[t[0]]);
      const glm::dvec3 d2 = glm::dvec3(mesh_.positions[t[2]]) - glm::dvec3(mesh_.positions[t[0]]);
      const glm::dvec2 u1 = glm::dvec2(uv_[t[1]]) - glm::dvec2(uv_[t[0]]),
                       u2 = glm::dvec2(uv_[t[2]]) - glm::dvec2(uv_[t[0]]);
      const double area = u1.x * u2.y - u1.y * u2.x;
      const glm::dvec3 t0 = (u2.y * d1 - u1.y * d2) * (area < 0 ? -1.0 : 1.0);  // dP/du times |area|
      const double length = glm::length(t0);
      if (!(std::abs(area) > 1e-30) || !(length > 1e-30) || !std::isfinite(length)) continue;
      faces_[f] = {glm::vec3(t0 / length), area > 0, true};
    }
  }

  /// For each corner c of a face, the face's edge from corner c to the next: the corner that starts the same edge, run
  /// the other way, in another face. An edge with more than two triangles pairs them in order.
  void findNeighbours() {
    neighbour_.assign(mesh_.indices.size(), kNone);
    std::unordered_multimap<std::uint64_t, std::uint32_t> open;
    open.reserve(mesh_.indices.size());
    for (std::uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const std::uint32_t a = welded(c), b = welded(next(c));
      const auto match = open.find(std::uint64_t(b) << 32 | a);
      if (match == open.end()) {
        open.emplace(std::uint64_t(a) << 32 | b, c);
        continue;
      }
      neighbour_[c] = match->second;
      neighbour_[match->second] = c;
      open.erase(match);
    }
  }
  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  /// Rule 4: faces without area in the texture take the orientation of the nearest oriented neighbour.
  void orientDegenerates() {
    std::vector<std::uint32_t> queue;
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      if (faces_[f].oriented) queue.push_back(f);
    if (queue.size() == faces_.size()) return;
    for (std::size_t i = 0; i < queue.size(); ++i)
      for (std::uint32_t c = 3 * queue[i]; c < 3 * queue[i] + 3; ++c) {
        if (neighbour_[c] == kNone) continue;
        Face& other = faces_[neighbour_[c] / 3];
        if (other.oriented) continue;
        other.oriented = true;
        other.preserving = faces_[queue[i]].preserving;
        queue.push_back(neighbour_[c] / 3);
      }
  }

  /// Rule 3: corners at one vertex whose faces share an edge at it and have one orientation are one group.
  void groupCorners() {
    UnionFind groups(mesh_.indices.size());
    for (std::uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const std::uint32_t other = neighbour_[c];
      if (other == kNone || faces_[c / 3].preserving != faces_[other / 3].preserving) continue;
      groups.unite(c, next(other));  // the edge runs a → b here and b → a there
      groups.unite(next(c), other);
    }
    group_.resize(mesh_.indices.size());
    for (std::uint32_t c = 0; c < group_.size(); ++c) group_[c] = groups.find(c);
  }

  void sumGroups() {
    sum_.assign(mesh_.indices.size(), glm::vec3(0));
    for (std::uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const Face& face = faces_[c / 3];
      if (face.tangent == glm::vec3(0)) continue;
      const std::uint32_t v = mesh_.indices[c], b = mesh_.indices[next(c)], a = mesh_.indices[next(next(c))];
      const glm::vec3 n = mesh_.normals[v];
      const glm::vec3 tangent = projected(face.tangent, n);
      const glm::vec3 e1 = projected(mesh_.positions[b] - mesh_.positions[v], n),
                      e2 = projected(mesh_.positions[a] - mesh_.positions[v], n);
      sum_[group_[c]] += std::acos(std::clamp(glm::dot(e1, e2), -1.0f, 1.0f)) * tangent;
    }
    // What a corner without a tangent of its own group falls back on: any tangent at the same vertex.
    for (std::uint32_t c = 0; c < mesh_.indices.size(); ++c)
      if (hasTangent(group_[c])) anyAt_.try_emplace(welded(c), group_[c]);
  }
  /// Sums that cancel out leave rounding, which points anywhere.
  [[nodiscard]] bool hasTangent(std::uint32_t group) const { return glm::dot(sum_[group], sum_[group]) > 1e-8f; }
  /// The unit vector along the part of `v` at right angles to `n`; zero when there is none but rounding (n is unit to
  /// 1e-7).
  static glm::vec3 projected(const glm::vec3& v, const glm::vec3& n) {
    const glm::dvec3 p = glm::dvec3(v) - glm::dvec3(n) * glm::dot(glm::dvec3(n), glm::dvec3(v));
    const double length = glm::length(p);
    return length > 1e-5 * glm::length(glm::dvec3(v)) ? glm::vec3(p / length) : glm::vec3(0);
  }

  /// glTF's bitangent w · n × t points up the texture, against v; where (u, v) turn with the triangle, n × dP/du points
  /// along v.
  [[nodiscard]] glm::vec4 tangentOf(std::uint32_t corner) const {
    std::uint32_t group = group_[corner];
    bool preserving = faces_[corner / 3].preserving;
    const glm::vec3 n = mesh_.normals[mesh_.indices[corner]];
    if (!hasTangent(group)) {
      const auto any = anyAt_.find(welded(corner));
      if (any == anyAt_.end()) return {perpendicular(n), 1};
      group = any->second;
      preserving = faces_[group / 3].preserving;  // a group is named after one of its corners
    }
    return {projected(sum_[group], n), preserving ? -1.0f : 1.0f};
  }

  /// Writes the corners' tangents to the vertices; a vertex whose corners differ is split.
  std::size_t assign() {
    const std::size_t before = mesh_.positions.size();
    mesh_.tangents.assign(before, glm::vec4(0));
    std::vector<std::uint32_t> nextCopy(before, kNone);  // further copies of a vertex, as a linked list
    for (std::uint32_t c = 0; c < mesh_.indices.size(); ++c) {
      const glm::vec4 tangent = tangentOf(c);
      std::uint32_t v = mesh_.indices[c];
      while (mesh_.tangents[v].w != 0 && mesh_.tangents[v] != tangent) {
        if (nextCopy[v] == kNone) {
          nextCopy[v] = copyVertex(v);
          nextCopy.push_back(kNone);
        }
        v = nextCopy[v];
      }
      mesh_.tangents[v] = tangent;
      mesh_.indices[c] = v;
    }
    for (std::size_t v = 0; v < mesh_.tangents.size(); ++v)
      if (mesh_.tangents[v].w == 0)
        mesh_.tangents[v] = glm::vec4(perpendicular(mesh_.normals[v]), 1);  // no triangle uses it
    return mesh_.positions.size() - before;
  }
  std::uint32_t copyVertex(std::uint32_t v) {
    const auto copy = [v](auto& stream) {
      if (stream.empty()) return;
      const auto value = stream[v];
      stream.push_back(value);
    };
    copy(mesh_.positions);
    copy(mesh_.normals);
    copy(mesh_.uv0);
    copy(mesh_.uv1);
    copy(mesh_.colors);
    copy(mesh_.joints);
    copy(mesh_.weights);
    for (MorphTarget& t : mesh_.targets) {
      copy(t.positions);
      copy(t.normals);
      copy(t.tangents);
    }
    weld_.push_back(weld_[v]);
    mesh_.tangents.push_back(glm::vec4(0));
    return std::uint32_t(mesh_.positions.size() - 1);
  }

  Mesh& mesh_;
  std::vector<glm::vec2> uv_;
  std::vector<std::uint32_t> weld_;  ///< vertex → first equal vertex
  std::vector<Face> faces_;
  std::vector<std::uint32_t> neighbour_;  ///< corner → corner
  std::vector<std::uint32_t> group_;      ///< corner → least corner of its group
  std::vector<glm::vec3> sum_;            ///< by group
  std::unordered_map<std::uint32_t, std::uint32_t> anyAt_;
};

}  // namespace

std::size_t makeTangents(Mesh& mesh, const UvMapping& mapping) {
  const std::size_t n = mesh.positions.size();
  if (n == 0 || mesh.normals.size() != n || (mapping.set == 1 ? mesh.uv1 : mesh.uv0).size() != n ||
      mesh.indices.size() % 3 != 0)
    return 0;
  for (const std::uint32_t i : mesh.indices)
    if (i >= n) return 0;
  return Builder(mesh, mapping).build();
}

Result<Mesh> preparedMesh(const Mesh& mesh, bool tangents, Report& report) {
  Result<Mesh> valid = validated(mesh, report);
  if (valid && tangents && valid->tangents.empty() && !valid->uv0.empty()) burnish::makeTangents(*valid);
  return valid;
}

}  // namespace scene

void makeTangents(Mesh& mesh) { scene::makeTangents(mesh, UvMapping{}); }

}  // namespace burnish
