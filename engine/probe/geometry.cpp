#include "probe/geometry.h"

#include <fmt/format.h>

#include <new>

#include "scene/transparency.h"
#include "scene/visibility.h"

namespace burnish::probe {
namespace {

/// The vertices in the pose's space: target weights first, then the joints.
std::vector<glm::dvec3> posed(const Mesh& mesh, const scene::Pose* pose) {
  std::vector<glm::dvec3> out(mesh.positions.begin(), mesh.positions.end());
  if (!pose) return out;
  for (const auto& [target, weight] : pose->targets) {
    const std::vector<glm::vec3>& deltas = mesh.targets[target].positions;
    for (std::size_t v = 0; v < std::min(deltas.size(), out.size()); ++v) out[v] += double(weight) * glm::dvec3(deltas[v]);
  }
  if (!pose->skinned) return out;
  for (std::size_t v = 0; v < out.size(); ++v) {
    glm::dmat4 m(0);
    for (int c = 0; c < 4; ++c) m += double(mesh.weights[v][c]) * glm::dmat4(pose->joints[mesh.joints[v][c]]);
    out[v] = glm::dvec3(m * glm::dvec4(out[v], 1));
  }
  return out;
}

Look lookOf(const Material* m) { return !m ? kOpaque : scene::isTransparent(*m) ? kTransparent : m->alphaTest ? kCutout : kOpaque; }

reference::TriangleMesh placed(const scene::Placed& p, const Geometry::Surface& surface) {
  reference::TriangleMesh out{posed(*p.mesh, p.pose), p.mesh->indices, surface.look, surface.twoSided};
  for (glm::dvec3& v : out.positions) v = glm::dvec3(p.placement * glm::dvec4(v, 1));
  const bool flipped = (glm::determinant(glm::dmat3(p.placement)) < 0) != (p.pose && p.pose->flipped);
  if (flipped)
    for (std::size_t t = 0; t + 2 < out.indices.size(); t += 3) std::swap(out.indices[t + 1], out.indices[t + 2]);
  return out;
}

}  // namespace

Result<Geometry> Geometry::create(const Scene& scene, Report* report) try {
  scene::Derived derived;
  derived.update(scene, report);
  std::size_t triangles = 0;
  scene::eachPlaced(scene, derived, glm::dvec3(0), [&](const scene::Placed& p) { triangles += p.mesh->indices.size() / 3; });
  if (triangles > reference::RayScene::kMaxTriangles)
    return fail("probes", fmt::format("the scene's instances have {} triangles, at most {} can be taken", triangles, reference::RayScene::kMaxTriangles), "hide what does not matter to the light");
  std::vector<Surface> surfaces;
  std::vector<reference::TriangleMesh> meshes;
  scene::eachPlaced(scene, derived, glm::dvec3(0), [&](const scene::Placed& p) {
    const Material* material = scene.materials.get(p.instance->material);
    surfaces.push_back({p.id, material && material->twoSided, lookOf(material)});
    meshes.push_back(placed(p, surfaces.back()));
  });
  auto rays = reference::RayScene::create(meshes);
  if (!rays) return fail(rays.error());
  return Geometry{std::move(*rays), std::move(surfaces)};
} catch (const std::bad_alloc&) {
  return fail("probes", "memory runs out", "hide what does not matter to the light");
}

}  // namespace burnish::probe
