// The hard cases that are pictures: scenes made through the API, drawn, and looked at.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "stability/cases.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

// On both paths: the deferred one stops at the G-buffer what is no number, the forward one must not need that.
Result<Finding> nonfinite(Studio& studio, const Scene& scene, const std::string& where, Shadow shadow = Shadow::Pcf) {
  Finding found;
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Quality quality;
    quality.path = path;
    quality.shadow = shadow;
    const auto p = draw(studio, scene, lookAt({0, 0.5, 4}, {0, 0, 0}, {0, 1, 0}, 0.7f), {64, 64}, {}, quality);
    if (!p) return fail(p.error());
    if (p->nonfinite && found.value == 0) found.where = where + (path == Path::Forward ? ", forward path" : "");
    found.value += double(p->nonfinite);
  }
  return found;
}

/// The sum over scenes, each with a name.
struct Sum {
  Finding total;
  std::optional<Error> error;
  void add(Result<Finding> f) {
    if (!f) {
      if (!error) error = f.error();
      return;
    }
    if (total.value == 0) total.where = f->where;
    total.value += f->value;
  }
  Result<Finding> result() { return error ? Result<Finding>(fail(*error)) : Result<Finding>(total); }
};

// H13 through the renderer: G-buffer, tables and filtered cube included.
Result<Finding> furnace(Studio& studio) {
  Finding worst;
  for (const float substance : {0.0f, 1.0f / 3, 0.4f, 0.5f, 0.7f, 1.0f})
    for (const float roughness : {0.05f, 0.3f, 1.0f}) {
      Scene scene;
      Material m;
      m.albedo = vec3(1);
      m.substance = substance;
      m.roughness = roughness;
      place(scene, sphere(48, 96), m);
      scene.environment.color = vec3(1);
      const auto p = draw(studio, scene, lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.5f), {48, 48}, {});
      if (!p) return fail(p.error());
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
          for (int c = 0; c < 3; ++c)
            if (const double value = p->at(x, y)[c]; !(value <= worst.value)) worst = {value, fmt::format("substance {:.2f}, roughness {:g}", substance, roughness)};
    }
  return worst;
}

// H16: what passes 65504 in a half-float target is held there, not infinite and not black.
Result<Finding> overflow(Studio& studio) {
  Sum sum;
  for (const float lux : {1e5f, 1e9f, 3e38f}) {
    Scene scene;
    Material mirror;
    mirror.albedo = vec3(1);
    mirror.substance = 1;
    mirror.roughness = 0;
    place(scene, sphere(48, 96), mirror);
    Material lamp;
    lamp.emission = vec3(lux);
    place(scene, quad({0, -1.5, 0}, {1, 0, 0}, {0, 0.2, 0}), lamp);
    addLight(scene, LightKind::Directional, lux, {0, 0, 0}, {-0.2, -0.3, -1});
    addLight(scene, LightKind::Point, lux, {0, 0.9, 1.2});
    scene.environment.color = vec3(lux);
    // Exposed for a dim room, so that everything overflows.
    Quality quality;
    quality.exposureEv = -4.0f;
    RenderRequest request;
    const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.9f);
    const auto p = draw(studio, scene, view, {64, 64}, request, quality);
    if (!p) return fail(p.error());
    Finding f{double(p->nonfinite), fmt::format("{:g} lux", lux)};
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) f.value += p->at(x, y).x < 0.5;
    sum.add(f);
  }
  return sum.result();
}

// H17: one value that is no number in each input that a scene has.
Result<Finding> planted(Studio& studio) {
  struct Plant {
    const char* name;
    std::function<void(Scene&, Mesh&, Material&, Light&)> change;
  };
  const Plant plants[] = {
      {"a position", [](Scene&, Mesh& m, Material&, Light&) { m.positions[700].y = kNan; }},
      {"an infinite position", [](Scene&, Mesh& m, Material&, Light&) { m.positions[700].y = kInfinity; }},
      {"a normal", [](Scene&, Mesh& m, Material&, Light&) { m.normals[700] = vec3(kNan); }},
      {"a texture coordinate", [](Scene&, Mesh& m, Material&, Light&) { m.uv0[700].x = kNan; }},
      {"a vertex colour", [](Scene&, Mesh& m, Material&, Light&) { m.colors.assign(m.positions.size(), glm::vec4(1)), m.colors[700].g = kNan; }},
      {"albedo", [](Scene&, Mesh&, Material& m, Light&) { m.albedo.g = kNan; }},
      {"roughness", [](Scene&, Mesh&, Material& m, Light&) { m.roughness = kNan; }},
      {"substance", [](Scene&, Mesh&, Material& m, Light&) { m.substance = kNan; }},
      {"emission", [](Scene&, Mesh&, Material& m, Light&) { m.emission.b = kInfinity; }},
      {"a light's intensity", [](Scene&, Mesh&, Material&, Light& l) { l.intensity = kNan; }},
      {"a light's colour", [](Scene&, Mesh&, Material&, Light& l) { l.color.r = kInfinity; }},
      {"a light's range", [](Scene&, Mesh&, Material&, Light& l) { l.range = kNan; }},
      {"a light's cone", [](Scene&, Mesh&, Material&, Light& l) { l.outerCone = kNan; }},
      {"the environment's colour", [](Scene& s, Mesh&, Material&, Light&) { s.environment.color.g = kNan; }},
      {"the environment's scale", [](Scene& s, Mesh&, Material&, Light&) { s.environment.scale = kInfinity; }},
  };
  Sum sum;
  for (const Plant& plant : plants) {
    Scene scene;
    Mesh mesh = sphere(32, 64);
    Material material;
    material.roughness = 0.3f;
    Light light;
    light.kind = LightKind::Spot;
    light.intensity = 100;
    scene.environment.color = vec3(0.5f);
    plant.change(scene, mesh, material, light);
    place(scene, std::move(mesh), material);
    addLight(scene, light, {0, 2, 2}, {0, -1, -1});
    addLight(scene, LightKind::Directional, 1, {0, 0, 0}, {0, -1, -1});
    sum.add(nonfinite(studio, scene, plant.name));
  }
  return sum.result();
}

// H18: normals and tangents that are no directions, collapsed coordinates, mirrored and singular transforms.
Result<Finding> directions(Studio& studio) {
  Sum sum;
  const auto add = [&](const char* name, const std::function<void(Mesh&, glm::dmat4&)>& change, bool mapped = false) {
    Scene scene;
    Mesh mesh = sphere(32, 64);
    glm::dmat4 local(1);
    change(mesh, local);
    Material material;
    material.roughness = 0.4f;
    if (mapped) material.mapB = scene.textures.add(flatNormals());
    place(scene, std::move(mesh), material, local);
    addLight(scene, LightKind::Directional, 1, {0, 0, 0}, {0, -1, -1});
    scene.environment.color = vec3(0.5f);
    sum.add(nonfinite(studio, scene, name));
  };
  add("zero normals", [](Mesh& m, glm::dmat4&) { m.normals.assign(m.positions.size(), vec3(0)); });
  add("zero tangents under a normal map", [](Mesh& m, glm::dmat4&) { m.tangents.assign(m.positions.size(), glm::vec4(0)); }, true);
  add("collapsed texture coordinates", [](Mesh& m, glm::dmat4&) { m.uv0.assign(m.positions.size(), glm::vec2(0.5f)); }, true);
  add("a mirroring transform", [](Mesh&, glm::dmat4& t) { t[0][0] = -1; });
  add("a singular transform", [](Mesh&, glm::dmat4& t) { t[1][1] = 0; });
  add("a transform of 1e-20", [](Mesh&, glm::dmat4& t) { t = glm::dmat4(1e-20); t[3][3] = 1; });
  add("degenerate triangles", [](Mesh& m, glm::dmat4&) { for (std::size_t i = 0; i + 2 < m.indices.size(); i += 6) m.indices[i + 2] = m.indices[i]; });
  return sum.result();
}

// H21: lights with hard numbers.
Result<Finding> hardLights(Studio& studio) {
  Sum sum;
  for (const float inner : {0.0f, 0.5f, 1.5707963f})
    for (const float outer : {0.0f, 0.5f, 1.5707963f, 3.0f})
      for (const float range : {0.0f, 1e-6f, 5.0f}) {
        Scene scene;
        Material m;
        m.roughness = 0.2f;
        place(scene, sphere(32, 64), m);
        Light light;
        light.kind = LightKind::Spot;
        light.intensity = 50;
        light.innerCone = inner;
        light.outerCone = outer;
        light.range = range;
        addLight(scene, light, {0, 0, 1}, {0, 0, -1});  // on the surface
        addLight(scene, light, {0, 1, 2}, {0, -1, -2});
        addLight(scene, light, {0, 0, 0}, {0, 0, 1});   // inside
        sum.add(nonfinite(studio, scene, fmt::format("cone {:g} to {:g}, range {:g}", inner, outer, range)));
        if (inner != 0.5f) continue;
        std::vector<Id<Light>> lights;
        scene.lights.each([&](Id<Light> id, const Light&) { lights.push_back(id); });
        for (const Id<Light> id : lights) scene.lights.edit(id)->castsShadow = true;
        for (const Shadow shadow : {Shadow::Tap, Shadow::Pcf, Shadow::Pcss}) sum.add(nonfinite(studio, scene, fmt::format("shadows, cone {:g} to {:g}, range {:g}", inner, outer, range), shadow));
      }
  return sum.result();
}

// H24: the deferred picture against the forward one.
Result<Finding> forward(Studio& studio) {
  Scene scene;
  for (int i = 0; i < 4; ++i) {
    Material m;
    m.albedo = vec3(0.8f, 0.5f, 0.2f);
    m.substance = i == 3 ? 1.0f : i == 2 ? 0.7f : 1.0f / 3;
    m.roughness = 0.35f + 0.2f * float(i);
    glm::dmat4 local(0.5);
    local[3] = glm::dvec4(-1.5 + i, 0, 0, 1);
    place(scene, sphere(48, 96), m, local);
  }
  addLight(scene, LightKind::Directional, 2, {0, 0, 0}, {-0.4, -1, -0.6});
  for (int i = 0; i < 6; ++i) addLight(scene, LightKind::Point, 3, {-1.5 + 0.6 * i, 0.8, 0.9});
  scene.environment.color = vec3(0.3f, 0.4f, 0.5f);
  const View view = lookAt({0, 0.3, 4}, {0, 0, 0}, {0, 1, 0}, 0.8f);
  Quality quality;
  quality.exposureEv = 1.0f;
  const auto deferred = draw(studio, scene, view, {160, 80}, {}, quality);
  if (!deferred) return fail(deferred.error());
  quality.path = Path::Forward;
  const auto reference = draw(studio, scene, view, {160, 80}, {}, quality);
  if (!reference) return fail(reference.error());
  Finding worst;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 160; ++x) {
      const dvec3 d = glm::abs(deferred->at(x, y) - reference->at(x, y)) * 255.0;
      if (const double e = std::max({d.x, d.y, d.z}); !(e <= worst.value)) worst = {e, fmt::format("pixel {}, {}", x, y)};
    }
  return worst;
}

// H28: nothing to draw, nothing to draw on.
Result<Finding> nothing(Studio& studio) {
  Sum sum;
  Scene empty;
  sum.add(nonfinite(studio, empty, "an empty scene"));
  Scene dark;
  place(dark, sphere(16, 32), {});
  sum.add(nonfinite(studio, dark, "no lights"));
  const auto one = draw(studio, dark, lookAt({0, 0, 3}, {0, 0, 0}), {1, 1}, {});
  if (!one) return fail(one.error());
  Target none;
  const View view = lookAt({0, 0, 3}, {0, 0, 0});
  if (studio.renderer.render(dark, {&view, 1}, none, {})) sum.add(Finding{1, "a target of 0 x 0 pixels was not refused"});
  return sum.result();
}

}  // namespace

std::vector<PictureCase> pictureCases() {
  return {{"H13", "white furnace through the renderer, default rungs: largest radiance over white", 1.005, furnace},
          {"H16", "sun, lamp and sky of 1e5 to 3e38 on a mirror into half floats: pixels that are not finite, or dark", 0, overflow},
          {"H17", "NaN or infinity in each input of a scene: pixels that are not finite", 0, planted},
          {"H18", "zero normals and tangents, collapsed coordinates, mirrored and singular transforms: pixels that are not finite", 0, directions},
          {"H21", "spot cones, ranges and lights on the surface: pixels that are not finite", 0, hardLights},
          {"H24", "deferred against forward picture: largest difference, of 255", 4, forward},
          {"H28", "no scene, no lights, a target of 1 x 1 and of 0 x 0 pixels: faults", 0, nothing}};
}

}  // namespace burnish::stability
