#include "pathtrace/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <utility>

#include "plan/variants.h"
#include "scene/deformed.h"
#include "scene/tangents.h"
#include "scene/transparency.h"

namespace burnish::pathtrace {
namespace {

MaterialInputs inputsOf(const Scene& scene, const Material& m, Maps& maps, Report& report) {
  MaterialInputs in;
  in.factors = scene::factorsOf(m);
  in.packed = plan::packsOcclusion(m);
  in.alphaTest = m.alphaTest;
  in.twoSided = m.twoSided;
  in.glass = scene::isGlass(m);
  in.emits = plan::emits(m);
  in.emissiveMap = bool(m.emissiveMap);
  for (int slot = 0; slot < 5; ++slot) in.maps[slot] = maps.of(scene, m, slot, in.packed, report);
  return in;
}

Look lookOf(const MaterialInputs& m) {
  if (m.glass) return m.factors.thickness > 0 ? kBody : kThin;
  return m.factors.blend ? kThin : m.alphaTest ? kHoles : kSolid;
}

// Zero stays zero, as in gbuffer.vert.
glm::vec3 unit(const glm::vec3& v) { return v / std::sqrt(std::max(glm::dot(v, v), 1e-30f)); }

// Normals by the cofactors times the determinant's sign, tangents by the matrix itself (scene::setPlacement, gbuffer.vert).
void turnFrames(const scene::Placed& p, Part& part, scene::DeformedFrames frames) {
  scene::VisibleInstance v;
  v.pose = p.pose;
  scene::setPlacement(v, p.placement, glm::dvec3(p.placement[3]));
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) part.model[c][r] = v.model[r][c];
  for (glm::vec3& n : frames.normals) n = unit({glm::dot(v.normal[0], n), glm::dot(v.normal[1], n), glm::dot(v.normal[2], n)});
  // A mirror keeps the bitangent's direction in the texture, which is what w stands for.
  const float mirrors = glm::determinant(glm::dmat3(p.placement)) < 0 ? -1.0f : 1.0f;
  for (glm::vec4& t : frames.tangents) t = glm::vec4(unit(part.model * glm::vec3(t)), t.w * mirrors);
  part.normals = std::move(frames.normals);
  part.tangents = std::move(frames.tangents);
  part.flipped = v.flipped;
}

// Vertices in one place are one: seams of texture coordinates are no edges.
bool isOpen(const Mesh& mesh) {
  std::map<std::array<float, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> weld(mesh.positions.size());
  for (std::size_t v = 0; v < weld.size(); ++v) {
    const glm::vec3 p = mesh.positions[v] + 0.0f;
    weld[v] = places.try_emplace({p.x, p.y, p.z}, std::uint32_t(v)).first->second;
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = weld[mesh.indices[t + c]], b = weld[mesh.indices[t + (c + 1) % 3]];
      if (a != b) ++edges[{std::min(a, b), std::max(a, b)}];
    }
  return std::any_of(edges.begin(), edges.end(), [](const auto& e) { return e.second < 2; });
}

class Builder {
 public:
  Builder(const Scene& scene, const scene::Derived& derived, Report& report) : scene_(scene), derived_(derived), report_(report) {}

  Result<Geometry> build() {
    materials();
    scene::eachPlaced(scene_, derived_, glm::dvec3(0), [&](const scene::Placed& p) { count_ += p.mesh->indices.size() / 3; });
    if (count_ > reference::RayScene::kMaxTriangles)
      return fail("reference", fmt::format("the scene's instances have {} triangles, at most {} can be traced", count_, reference::RayScene::kMaxTriangles), "hide what does not matter to the picture");
    scene::eachPlaced(scene_, derived_, glm::dvec3(0), [&](const scene::Placed& p) { add(p); });
    auto rays = reference::RayScene::create(meshes_);
    if (!rays) return fail(rays.error());
    Geometry g{std::move(*rays), std::move(parts_), std::move(inputs_), std::move(maps_)};
    if (g.rays.triangles() > 0) g.middle = (g.rays.low() + g.rays.high()) * 0.5;
    for (std::size_t i = 0; i < g.parts.size(); ++i) {
      g.parts[i].positions.reserve(meshes_[i].positions.size());
      for (const glm::dvec3& v : meshes_[i].positions) g.parts[i].positions.emplace_back(v - g.middle);
      g.holes |= g.parts[i].look == kHoles || g.materials[g.parts[i].material].alphaTest;
      g.thin |= g.parts[i].look == kThin;
      g.bodies |= g.parts[i].look == kBody;
    }
    return g;
  }

 private:
  void materials() {
    index_.assign(scene_.materials.capacity(), 0);
    scene_.materials.each([&](Id<Material> id, const Material& m) {
      index_[id.index] = std::uint32_t(inputs_.size());
      inputs_.push_back(inputsOf(scene_, m, maps_, report_));
    });
    inputs_.push_back(inputsOf(scene_, Material{}, maps_, report_));
  }

  // nullptr: it cannot be drawn, which has been said.
  std::shared_ptr<const Mesh> prepared(Id<Mesh> id, const Mesh& mesh, bool tangents) {
    const auto [place, fresh] = meshesMade_.try_emplace({id.index, tangents});
    if (!fresh) return place->second;
    auto made = scene::preparedMesh(mesh, tangents, report_);
    if (made) place->second = std::make_shared<const Mesh>(std::move(*made));
    else report_.warn(made.error().place, made.error().what + ": it is not traced");
    return place->second;
  }

  void add(const scene::Placed& p) {
    const Material* material = scene_.materials.get(p.instance->material);
    Part part;
    part.instance = p.id.index;
    part.material = material ? index_[p.instance->material.index] : std::uint32_t(inputs_.size() - 1);
    part.mesh = prepared(p.instance->mesh, *p.mesh, material && plan::wantsTangents(*material));
    if (!part.mesh || part.mesh->indices.empty()) return;
    const MaterialInputs& in = inputs_[part.material];
    part.look = lookOf(in);
    part.open = part.look == kBody && isOpen(*part.mesh);
    turnFrames(p, part, scene::deformedFrames(*part.mesh, p.pose));
    reference::TriangleMesh triangles{scene::deformedPositions(*part.mesh, p.pose), part.mesh->indices, std::uint32_t(part.look), in.twoSided};
    if (p.instance->castsShadow) triangles.mask |= part.look * std::uint32_t(kCasters);
    for (glm::dvec3& v : triangles.positions) v = glm::dvec3(p.placement * glm::dvec4(v, 1));
    if (part.flipped) {
      for (std::size_t t = 0; t + 2 < triangles.indices.size(); t += 3) std::swap(triangles.indices[t + 1], triangles.indices[t + 2]);
      part.turned = triangles.indices;
    }
    meshes_.push_back(std::move(triangles));
    parts_.push_back(std::move(part));
  }

  const Scene& scene_;
  const scene::Derived& derived_;
  Report& report_;
  std::size_t count_ = 0;
  Maps maps_;
  std::vector<MaterialInputs> inputs_;
  std::vector<std::uint32_t> index_;  // by material
  std::map<std::pair<std::uint32_t, bool>, std::shared_ptr<const Mesh>> meshesMade_;
  std::vector<Part> parts_;
  std::vector<reference::TriangleMesh> meshes_;
};

}  // namespace

Result<Geometry> Geometry::create(const Scene& scene, const scene::Derived& derived, Report& report) try {
  return Builder(scene, derived, report).build();
} catch (const std::bad_alloc&) {
  return fail("reference", "memory runs out", "hide what does not matter to the picture");
}

Corners cornersAt(const Part& part, std::size_t triangle, const glm::vec2& b) {
  Corners out;
  const std::uint32_t* i = part.indices().data() + triangle * 3;
  const float a = 1 - b.x - b.y;
  const Mesh& mesh = *part.mesh;
  if (!mesh.uv0.empty()) out.uv[0] = mesh.uv0[i[0]] * a + mesh.uv0[i[1]] * b.x + mesh.uv0[i[2]] * b.y;
  if (!mesh.uv1.empty()) out.uv[1] = mesh.uv1[i[0]] * a + mesh.uv1[i[1]] * b.x + mesh.uv1[i[2]] * b.y;
  if (!mesh.colors.empty()) {
    const auto color = [&](std::uint32_t k) { return glm::clamp(mesh.colors[k], glm::vec4(0), glm::vec4(1)); };
    out.color = color(i[0]) * a + color(i[1]) * b.x + color(i[2]) * b.y;
  }
  return out;
}

MapPlace placeOf(const MaterialInputs& material, int slot, const Corners& corners) {
  const UvMapping& m = material.factors.uv[slot];
  const std::size_t set = m.set == 1;
  const glm::mat2 turn(m.transform[0], m.transform[1]);
  return {m.transform * glm::vec3(corners.uv[set], 1), {turn * corners.footprint[set].x, turn * corners.footprint[set].y}};
}

bool solidAt(const MaterialInputs& material, const Corners& corners) {
  if (!material.alphaTest) return true;
  float opacity = lookUp(material, 2, corners).g * material.factors.opacity;
  if (material.factors.vertexColor) opacity *= corners.color.a;
  return !(opacity < material.factors.alphaCutoff);
}

float coverageAt(const MaterialInputs& material, const Corners& corners) {
  if (!material.factors.blend) return 1;
  float coverage = lookUp(material, 2, corners).g;
  if (material.factors.vertexColor) coverage *= corners.color.a;
  return material.glass ? coverage * material.factors.opacity : coverage;
}

glm::vec3 emissionAt(const MaterialInputs& material, const Corners& corners) {
  glm::vec3 sum = material.factors.emission;
  if (material.emissiveMap && sum != glm::vec3(0)) sum *= glm::vec3(lookUp(material, 4, corners));
  if (!material.factors.unlit) return sum;
  glm::vec3 color = glm::vec3(lookUp(material, 0, corners)) * material.factors.albedo;
  if (material.factors.vertexColor) color *= glm::vec3(corners.color);
  // A blended one's colour lies over what is behind by its opacity (forward/transparent.frag).
  return sum + color * (material.factors.blend ? material.factors.opacity : 1.0f);
}

}  // namespace burnish::pathtrace
