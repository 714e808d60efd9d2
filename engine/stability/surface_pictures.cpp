// The hard cases of tables, of transparent surfaces and of missing tangents as pictures.
#include <fmt/format.h>

#include <cmath>

#include "plan/rungs.h"
#include "reference/energy.h"
#include "stability/cases.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

// H14: tiles that are turned by known angles in a white furnace, on the forward path, which rounds neither normal nor roughness: each shows F0 · scale + bias as GL filters it from the table.
Result<Finding> tableThroughGl(Studio& studio) {
  constexpr double kCosines[] = {0.04, 0.1, 0.2, 0.4, 0.7, 1.0}, kRoughness[] = {0.03, 0.1, 0.25, 0.5, 0.8, 1.0};
  constexpr int kCell = 8;
  Finding worst;
  for (const bool metal : {true, false}) {
    Scene scene;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        Material m;
        m.albedo = vec3(metal ? 1 : 0);  // black plastic: no diffuse light
        m.substance = metal ? 1 : 1.0f / 3;
        m.roughness = float(kRoughness[j]);
        // As long as it must be to fill most of its cell.
        const double c = kCosines[i], s = std::sqrt(1 - c * c), length = 0.4 / c;
        place(scene, quad({float(i), float(j), 0}, {0.4f, 0, 0}, vec3(dvec3(0, c, s) * length)), m);
      }
    scene.environment.color = vec3(1);
    View view = lookAt({2.5, 2.5, 50}, {2.5, 2.5, 0});
    view.orthographic = true;
    view.height = 6;
    view.far = 100;
    Quality q;
    q.path = Path::Forward;
    const auto p = draw(studio, scene, view, {6 * kCell, 6 * kCell}, {}, q);
    if (!p) return fail(p.error());
    const shading::Rungs k = plan::rungsOf(q);
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const glm::dvec2 e = reference::lobeAlbedo(k, kCosines[i], kRoughness[j] * kRoughness[j], true);
        const double truth = metal ? e.x + e.y : 0.04 * e.x + e.y, shown = p->at(i * kCell + kCell / 2, (5 - j) * kCell + kCell / 2).x;
        worst.worse(std::abs(shown - truth), fmt::format("{}, n.v {:g}, roughness {:g}", metal ? "metal" : "plastic", kCosines[i], kRoughness[j]));
      }
  }
  return worst;
}

/// A sphere in lights and uneven surroundings.
template <class F>
Result<Picture> ball(Studio& studio, const Quality& quality, const F& change) {
  Scene scene;
  Mesh mesh = sphere(48, 96);
  Material m;
  m.albedo = {0.7f, 0.5f, 0.3f};
  m.roughness = 0.4f;
  change(scene, mesh, m);
  place(scene, std::move(mesh), m);
  addLight(scene, LightKind::Directional, 3, {0, 0, 0}, {-0.4, -1, -0.6});
  addLight(scene, LightKind::Point, 5, {1, 1, 2});
  scene.environment.map = makeImage(32, 16, 3, PixelType::F32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 3; ++c) scene.environment.map.f32()[(y * 32 + x) * 3 + c] = float(1 + 0.8 * std::cos(0.4 * (x - 5)) + (y < 8 ? 1 - 0.3 * c : 0.1 * c));
  return draw(studio, scene, lookAt({0, 0.5, 4}, {0, 0, 0}, {0, 1, 0}, 0.7f), {64, 64}, {}, quality);
}
Quality onPath(Path path) {
  Quality q;
  q.path = path;
  return q;
}

// H25: a blended surface whose pigment covers all is the opaque one; both are shaded as the forward path shades.
Result<Finding> blendedAsOpaque(Studio& studio) {
  const auto opaque = ball(studio, onPath(Path::Forward), [](Scene&, Mesh&, Material&) {});
  if (!opaque) return fail(opaque.error());
  Finding worst;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    const auto blended = ball(studio, onPath(path), [](Scene&, Mesh&, Material& m) { m.blend = true; });
    if (!blended) return fail(blended.error());
    worst.worse(largestShare(*blended, *opaque), path == Path::Forward ? "forward path" : "deferred path");
  }
  return worst;
}
// H25: what is behind counts by 1 - opacity of what the surface does not reflect (0.04 at normal incidence; a narrow lobe in the dark).
Result<Finding> behind(Studio& studio) {
  Finding worst;
  const dvec3 wall(3, 2, 1);
  for (const float opacity : {0.0f, 0.3f, 1.0f}) {
    Scene scene;
    Material shining, pane;
    shining.unlit = true;
    shining.albedo = vec3(0);
    shining.emission = vec3(wall);
    place(scene, quad({0, 0, -3}, {20, 0, 0}, {0, 20, 0}), shining);
    pane.blend = true;
    pane.opacity = opacity;
    pane.roughness = 0.05f;
    place(scene, quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0.5f, 0}), pane);
    const auto p = draw(studio, scene, lookAt({0, 0, 3}, {0, 0, 0}), {64, 48}, {});
    if (!p) return fail(p.error());
    worst.worse(glm::length(p->at(32, 24) - wall * double(1 - opacity) * 0.96) / glm::length(wall), fmt::format("opacity {:g}", opacity));
    worst.worse(glm::length(p->at(2, 24) - wall) / glm::length(wall), "beside the pane");
  }
  return worst;
}
// H25: clear glass in a white furnace is white: what it reflects and what crosses it add up.
Result<Finding> glassFurnace(Studio& studio) {
  Finding worst;
  for (const float roughness : {0.0f, 0.3f, 0.8f})
    for (const float thickness : {0.0f, 1.0f}) {
      Scene scene;
      Material m;
      m.transmission = 1;
      m.ior = 1.5f;
      m.albedo = vec3(1);
      m.roughness = roughness;
      m.thickness = thickness;
      place(scene, sphere(48, 96), m);
      scene.environment.color = vec3(1);
      const auto p = draw(studio, scene, lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.9f), {48, 48}, {});
      if (!p) return fail(p.error());
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x) worst.worse(std::abs(p->at(x, y).y - 1), fmt::format("roughness {:g}, thickness {:g} m", roughness, thickness));
    }
  return worst;
}

// H18: a normal map on a mesh whose tangents are zero: its own normals stay. The flat map's bytes are exact.
Result<Finding> ownNormals(Studio& studio) {
  Finding worst;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    const auto plain = ball(studio, onPath(path), [](Scene&, Mesh&, Material&) {});
    const auto mapped = ball(studio, onPath(path), [](Scene& scene, Mesh& mesh, Material& m) {
      mesh.tangents.assign(mesh.positions.size(), glm::vec4(0));
      m.mapB = scene.textures.add(flatNormals());
    });
    if (!plain || !mapped) return fail(plain ? mapped.error() : plain.error());
    worst.worse(largestShare(*mapped, *plain), path == Path::Forward ? "forward path" : "deferred path");
  }
  return worst;
}

}  // namespace

std::vector<PictureCase> surfacePictureCases() {
  return {{"H14", "DFG table as GL filters it, tiles at known angles in a white furnace: off quadrature", 1.5e-3, tableThroughGl},
          {"H18", "a normal map on a mesh with zero tangents: off the mesh's own normals, share of the pixel", 1e-3, ownNormals},
          {"H25", "a blended surface with opacity 1 against the opaque one: largest difference, share of the pixel", 1e-4, blendedAsOpaque},
          {"H25", "a wall behind a blended pane of opacity 0 to 1: off the closed form, share of the wall", 1e-3, behind},
          {"H25", "clear glass in a white furnace: off white", 0.01, glassFurnace, true}};
}

}  // namespace burnish::stability
