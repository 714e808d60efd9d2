// Instances that a transform mirrors: their normal maps are mirrored with them.
#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize(48, 48);

/// A square of a normal map that leans to one side along both of its axes, seen from the front.
struct Leaning {
  Scene scene;
  Id<Mesh> mesh;
  Id<Material> material;
  View view = lookAt({0, 0, 5}, {0, 0, 0});
  Leaning() {
    view.orthographic = true;
    view.height = 2;
    Material m;
    m.mapB = scene.textures.add(painted(MapKind::NormalRoughness, 4, [](float, float) { return vec4(168, 188, 232, 255) / 255.0f; }));
    material = scene.materials.add(std::move(m));
    mesh = scene.meshes.add(quad({0, 0, 0}, {0.8f, 0, 0}, {0, 0.8f, 0}));
  }
  void add(const glm::dmat4& at) {
    Instance i;
    i.mesh = mesh, i.material = material, i.node = addNode(scene, at);
    scene.instances.add(std::move(i));
  }
};

/// The normal in the middle, from the debug view: -1..1.
dvec3 normalOf(Stage& stage, const Leaning& s) {
  RenderRequest request;
  request.debugView = DebugView::Normal;
  return stage.draw(s.scene, {&s.view, 1}, kSize, {}, request).at(kSize.x / 2, kSize.y / 2) * 2.0 - 1.0;
}

glm::dmat4 scaledBy(dvec3 k) {
  glm::dmat4 m(1);
  for (int i = 0; i < 3; ++i) m[i][i] = k[i];
  return m;
}

}  // namespace

TEST_CASE("normal maps of mirrored instances are mirrored with them, drawn one by one and instanced") {
  Stage stage;
  Leaning plain;
  plain.add(glm::dmat4(1));
  const dvec3 n = normalOf(stage, plain);
  // (40, 60, 104)/127, of unit length: along the square's own axes, whichever way they point.
  const double length = std::sqrt(40.0 * 40 + 60 * 60 + 104 * 104), step = 1.5 / 127;
  CHECK(std::abs(std::abs(n.x) - 40 / length) < step);
  CHECK(std::abs(std::abs(n.y) - 60 / length) < step);
  CHECK(std::abs(n.z - 104 / length) < step);
  for (const dvec3 mirror : {dvec3(-1, 1, 1), dvec3(1, -1, 1), dvec3(-1, -1, 1)})
    for (const int copies : {1, 12}) {
      Leaning s;
      for (int i = 0; i < copies; ++i) s.add(glm::translate(glm::dmat4(1), dvec3(0, 0, -0.1 * i)) * scaledBy(mirror));
      const dvec3 m = normalOf(stage, s);
      INFO(mirror.x << " " << mirror.y << ", " << copies << ": " << m.x << " " << m.y << " " << m.z);
      CHECK(glm::length(m - n * mirror) < 2 * step);
    }
}
