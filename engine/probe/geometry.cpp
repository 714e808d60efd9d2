#include "probe/geometry.h"

#include <fmt/format.h>

#include <new>

#include "scene/deformed.h"
#include "scene/transparency.h"
#include "scene/visibility.h"

namespace burnish::probe {
namespace {

Look lookOf(const Material* m) { return !m ? kOpaque : scene::isTransparent(*m) ? kTransparent : m->alphaTest ? kCutout : kOpaque; }

reference::TriangleMesh placed(const scene::Placed& p, const Geometry::Surface& surface) {
  reference::TriangleMesh out{scene::deformedPositions(*p.mesh, p.pose), p.mesh->indices, surface.look, surface.twoSided};
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
