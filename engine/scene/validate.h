// Mesh validation with the faults counted, for whoever validates many.
#pragma once
#include <burnish/scene.h>

namespace burnish::scene {

/// How many things of each kind validation dropped or replaced.
struct MeshFaults {
  std::size_t brokenTriangles = 0, flatTriangles = 0, coordinates = 0, colors = 0, normals = 0, tangents = 0, weights = 0,
              deltas = 0;
  MeshFaults& operator+=(const MeshFaults& o);
  /// One warning for each kind that occurred.
  void report(const std::string& place, Report& report) const;
};

/// burnish::validated, adding to `faults`.
Result<Mesh> validated(Mesh mesh, MeshFaults& faults);

}  // namespace burnish::scene
