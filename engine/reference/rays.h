// Rays against triangles. Coordinates go in and come out in double; inside they are floats relative to the middle of the geometry, which costs 6e-8 of its extent.
// The same geometry and rays give the same hits on every machine, whatever the number of threads.
#pragma once
#include <burnish/result.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace burnish::reference {

struct TriangleMesh {
  std::vector<glm::dvec3> positions;   ///< metres, world
  std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from its front; triangles with a corner that is missing or not finite are never hit
  std::uint32_t mask = 1;              ///< a ray meets it if their masks share a bit
  bool twoSided = false;               ///< its backs are seen too
};

/// The points origin + t · direction with from <= t <= to.
struct Ray {
  glm::dvec3 origin{0};               ///< metres, world
  glm::dvec3 direction{0, 0, -1};     ///< any length above 0; a zero or non-finite ray hits nothing
  double from = 0, to = std::numeric_limits<double>::infinity();
  std::uint32_t mask = ~0u;
  bool cull = false;                  ///< passes the backs of one-sided meshes, as a picture does
};

/// The nearest surface on a ray. Where two lie at the same distance it is always the same one of them.
struct Hit {
  static constexpr std::uint32_t kNone = ~0u;
  double distance = std::numeric_limits<double>::infinity();  ///< in lengths of the direction
  std::uint32_t mesh = kNone, triangle = kNone;               ///< triangle: of that mesh, counting from 0
  glm::vec2 barycentric{0};                                   ///< shares of corners 1 and 2
  glm::dvec3 normal{0};                                       ///< of the triangle's front, unit
  bool back = false;                                          ///< met from behind
  [[nodiscard]] explicit operator bool() const { return mesh != kNone; }
};

/// Triangles in an order in which rays find them fast (Embree, robust mode: no ray slips between triangles that share an edge). Threads may ask it at once.
class RayScene {
 public:
  static constexpr std::size_t kMaxTriangles = 30'000'000;  ///< some gigabytes
  /// Copies the meshes. Errors: more than kMaxTriangles, memory runs out.
  static Result<RayScene> create(std::span<const TriangleMesh> meshes);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  [[nodiscard]] Hit nearest(const Ray& ray) const;
  /// All surfaces on the ray into `hits`, nearest first; at one distance in order of mesh and triangle.
  void all(const Ray& ray, std::vector<Hit>& hits) const;
  /// Anything on the ray.
  [[nodiscard]] bool occluded(const Ray& ray) const;
  /// Anything between two points; what is within `gap` metres of either does not count.
  [[nodiscard]] bool occluded(glm::dvec3 a, glm::dvec3 b, double gap = 0, std::uint32_t mask = ~0u) const;
  /// hits[i] of rays[i], which are as many. `threads`: 0 is one for each core.
  void nearest(std::span<const Ray> rays, std::span<Hit> hits, int threads) const;

  [[nodiscard]] std::size_t triangles() const;
  /// Around what can be hit, world; low > high without any.
  [[nodiscard]] glm::dvec3 low() const;
  [[nodiscard]] glm::dvec3 high() const;
  /// Metres: how far a surface may lie from where the double coordinates put it.
  [[nodiscard]] double rounding() const;

 private:
  struct Parts;
  explicit RayScene(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace burnish::reference
