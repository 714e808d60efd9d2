// The path tracer sees the materials, lights and camera that the renderer draws: its direct light through pixel centres against the forward path, for every kind of material input.
//
// Both evaluate one shading text, in float: what differs is how 8-bit maps are filtered (llvmpipe weighs texels with 8 bits: up to 1/255 of the span between two texels), normals in 16 bits (2e-5 rad) and derivatives over pixel quads. A byte's step of a linear albedo of 0.3 is 1.0 %; of roughness 0.5 it is 0.8 % in
// roughness, 1.6 % in alpha and 3.1 % in the lobe's peak. So as in forward_test.cpp: 2 % where albedo rules, 3 % with mapped normals, 6 % on lobes, half of it for 97 % of the pixels (edges of triangles
// fall on other sides of a pixel's centre for a few), beyond four standard errors of the path tracer's choice among the lights. Emission is left out: emissive surfaces light others there. Each case once more without its field must be out of bounds.
#include <burnish/measure.h>
#include <fmt/format.h>

#include <iostream>

#include "render/workshop.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{64, 48};
using Change = std::function<void(Material&)>;

/// Direct light alone, without surroundings, which the renderer only approximates.
struct Bare : Workshop {
  Bare() {
    scene.environment = {};
    ++scene.environment.revision;
    // Level 0 alone: llvmpipe picks levels by approximated derivatives, and blends fewer of them (test_pathtrace holds the levels against GL's own equations).
    for (std::uint32_t i = 0; i < scene.textures.capacity(); ++i)
      if (Texture* t = scene.textures.edit(scene.textures.at(i))) t->sampler.mips = false;
  }
};

Quality direct(Path path) {
  Quality q;
  q.path = path;
  q.exposureEv = 3.5f;
  q.lightThreshold = 0;  // the path tracer's lights have no end
  q.occlusion = Occlusion::None;
  return q;
}

Errors compare(const Picture& drawn, const ReferencePicture& traced, double bound) {
  const Image& image = traced.radiance;
  double mean = 0;
  for (std::size_t i = 0; i < image.pixelCount(); ++i) mean += double(image.f32()[i * 3 + 1]) / double(image.pixelCount());
  Errors e;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* t = image.f32() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 3;
      const dvec3 p = drawn.at(x, y), q(t[0], t[1], t[2]), d = glm::abs(p - q);
      const float* v = traced.variance.f32() + (t - image.f32());
      const double noise = 4 * std::sqrt(double(std::max({v[0], v[1], v[2]})));
      if (p != dvec3(0) || q != dvec3(0)) e.add(std::max(std::max({d.x, d.y, d.z}) - noise, 0.0) / (std::max({q.x, q.y, q.z}) + 0.02 * mean), bound);
    }
  return e;
}

ReferencePicture traced(const Scene& scene, const View& view, const Quality& quality) {
  ReferenceOptions options;
  options.size = kSize;
  options.bounces = 0;
  options.pixelArea = false;
  options.samples = 64;  // one of the lights near a point is chosen by chance
  Report report;
  auto made = traceReference(scene, view, quality, options, report);
  if (!made) FAIL(made.error().message());
  return std::move(*made);
}

}  // namespace

TEST_CASE("the path tracer's direct light is the forward path's: material inputs") {
  Stage stage;
  Bare w;
  const auto nothing = [](Material&) {};
  const auto wider = [](UvMapping& uv) { uv.transform = {1.3f, 0.4f, -0.5f, 1.1f, 0.2f, 0.7f}; };
  struct Field {
    const char* name;
    double usual;
    Change with, without;
  };
  const Field fields[] = {
      {"albedo map, uv transform", 0.01, [&](Material& m) { m.mapA = w.albedo, wider(m.uvA); }, [&](Material& m) { m.mapA = w.albedo; }},
      {"vertex colour times map", 0.01, [&](Material& m) { m.mapA = w.albedo, m.useVertexColor = true; }, [&](Material& m) { m.mapA = w.albedo; }},
      {"substance map", 0.015, [&](Material& m) { m.mapA = w.substance; }, [&](Material& m) { m.mapA = w.plastic; }},
      {"roughness map, metal", 0.03, [&](Material& m) { m.mapB = w.roughness, m.substance = 1; }, [](Material& m) { m.substance = 1; }},
      {"normal map", 0.015, [&](Material& m) { m.mapB = w.normals; }, nothing},
      {"normal map packed with occlusion", 0.015, [&](Material& m) { m.mapB = w.normals, m.mapC = w.occlusion; }, [&](Material& m) { m.mapC = w.occlusion; }},
      {"metal-rough apart, own uv", 0.03, [&](Material& m) { m.metalRoughMap = w.metalRough, m.metalness = 1, wider(m.uvMetalRough); }, [&](Material& m) { m.metalRoughMap = w.metalRough, m.metalness = 1; }},
      {"metal-rough apart, normals, set 1", 0.03, [&](Material& m) { m.metalRoughMap = w.metalRough, m.metalness = 1, m.mapB = w.normals, m.uvB.set = 1; }, [&](Material& m) { m.mapB = w.normals, m.uvB.set = 1; }},
      {"alpha test, two-sided", 0.01, [&](Material& m) { m.mapC = w.occlusion, m.alphaTest = m.twoSided = true; }, [&](Material& m) { m.mapC = w.occlusion; }},
      {"anisotropy, turned", 0.045, [](Material& m) { m.anisotropy = 0.7f, m.anisotropyRotation = 0.8f, m.substance = 1; }, [](Material& m) { m.anisotropy = 0.7f, m.substance = 1; }},
      {"diffuse roughness", 0.01, [](Material& m) { m.diffuseRoughness = 0.6f; }, nothing},
  };
  for (const Field& field : fields) {
    INFO(field.name);
    w.setMaterial(field.with);
    const Picture drawn = stage.linear(w.scene, w.view, kSize, direct(Path::Forward));
    const Errors e = compare(drawn, traced(w.scene, w.view, direct(Path::Forward)), field.usual);
    w.setMaterial(field.without);
    const Errors dropped = compare(drawn, traced(w.scene, w.view, direct(Path::Forward)), field.usual);
    std::cout << fmt::format("  {:<36} largest {:6.2f} %, {:6.2f} % of {} pixels within {:.1f} %; without it {:6.2f} %\n", field.name, 100 * e.largest, 100 * e.share(), e.count, 100 * field.usual, 100 * dropped.share());
    CHECK(e.count > 1000);
    CHECK(e.share() > 0.97);
    CHECK(dropped.share() < 0.97);
  }
}
