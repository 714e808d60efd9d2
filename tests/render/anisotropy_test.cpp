// What only the forward path has, against the double oracle: anisotropic Ward and the exact Fresnel equation of named conductors.
#include <fmt/format.h>

#include <iostream>

#include "plan/rungs.h"
#include "reference/oracle.h"
#include "render/scenes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{160, 160};
const View kView = lookAt({0.5, 0.6, 4}, {0, 0, 0}, {0, 1, 0}, 0.55f);
// Beside the eye, and from behind the sphere, where l·h is 0.5 and Fresnel's equations part from Schlick's fit.
const dvec3 kBeside = glm::normalize(dvec3(0.5, 0.6, 0.9)), kBehind = glm::normalize(dvec3(0.9, 0.3, -0.45));

/// The sphere of scenes.h: u runs along (-z, 0, x), around the poles' axis; v runs down, against the bitangent (glTF), so that w is -1.
dvec3 tangentOf(dvec3 n) { return glm::normalize(dvec3(-n.z, 0, n.x)); }

Mesh sphereWithTangents() {
  Mesh m = sphere(1, 192, 384);
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    const double p = 2 * kPi * m.uv0[i].x;
    m.tangents.emplace_back(vec3(dvec3(-std::sin(p), 0, std::cos(p))), -1.0f);
  }
  return m;
}

Scene lit(Mesh mesh, const Material& material, dvec3 toLight = kBeside) {
  Scene scene;
  place(scene, std::move(mesh), material);
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, -toLight);
  return scene;
}

/// Every pixel of the unit sphere away from silhouette, terminator and poles; errors as shares of the value plus half a percent of the brightest.
template <class Surface>
Errors againstOracle(const Picture& p, const Quality& quality, dvec3 toLight, Surface&& surfaceAt) {
  shading::Rungs rungs = plan::rungsOf(quality);
  rungs.anisotropic = 1;
  const reference::OracleLight sun{toLight, dvec3(100.0)};
  std::vector<std::pair<dvec3, dvec3>> pairs;
  double peak = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Ray r = rayThrough(kView, kSize, x + 0.5, y + 0.5);
      const double b = glm::dot(r.origin, r.direction), d = b * b - glm::dot(r.origin, r.origin) + 1;
      if (d <= 0) continue;
      const dvec3 n = r.origin + r.direction * (-b - std::sqrt(d));
      if (glm::dot(n, -r.direction) < 0.2 || glm::dot(n, toLight) < 0.1 || std::abs(n.y) > 0.95) continue;
      pairs.emplace_back(p.at(x, y), reference::shade(surfaceAt(n, -r.direction), {&sun, 1}, rungs));
      peak = std::max({peak, pairs.back().second.x, pairs.back().second.y, pairs.back().second.z});
    }
  Errors e;
  for (const auto& [got, wanted] : pairs)
    for (int c = 0; c < 3; ++c) e.add(std::abs(got[c] - wanted[c]) / (wanted[c] + 0.005 * peak), 0.01);
  return e;
}

double brightest(const Picture& p) {
  double peak = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) peak = std::max(peak, p.at(x, y).x);
  return peak;
}

void say(std::string_view what, const Errors& e) { std::cout << fmt::format("  {}: largest {:.3f} % of {} values\n", what, 100 * e.largest, e.count); }

Quality ward(Specular model) {
  Quality q;
  q.specular = model;
  return q;
}

Material brushed(float roughness, float anisotropy, float rotation = 0) {
  Material m;
  m.albedo = {0.9f, 0.7f, 0.4f};
  m.substance = 1;
  m.roughness = roughness;
  m.anisotropy = anisotropy;
  m.anisotropyRotation = rotation;
  return m;
}

}  // namespace

TEST_CASE("anisotropic Ward on the forward path equals the oracle") {
  Stage stage;
  for (Specular model : {Specular::WardAnisotropic, Specular::WardBounded})
    for (const auto& [strength, rotation] : {std::pair(0.6f, 0.0f), std::pair(0.8f, 0.7f), std::pair(0.8f, -2.0f), std::pair(1.0f, 1.5f)}) {
      Quality quality = ward(model);
      quality.path = Path::Forward;
      const Material m = brushed(0.35f, strength, rotation);
      const Picture p = stage.linear(lit(sphereWithTangents(), m), kView, kSize, quality);
      const Errors e = againstOracle(p, quality, kBeside, [&](dvec3 n, dvec3 v) {
        reference::OracleSurface s{n, v, dvec3(m.albedo), 1, 0.35 * 0.35};
        const dvec3 t = tangentOf(n), b = glm::cross(t, n);
        s.tangent = t * std::cos(double(rotation)) + b * std::sin(double(rotation));
        s.anisotropy = strength;
        return s;
      });
      say(fmt::format("{}, strength {}, turned by {}", terms()[0].rungs[std::size_t(model)].name, strength, rotation), e);
      CHECK(e.count > 20000);
      CHECK(e.largest < 0.015);
    }
}

TEST_CASE("anisotropy: none is isotropic, some is not; tangents are made where the mesh brings none; a turn by pi is none") {
  Stage stage;
  const Quality quality = ward(Specular::WardAnisotropic);
  const auto draw = [&](Mesh mesh, const Material& m, const Quality& q) { return stage.linear(lit(std::move(mesh), m), kView, kSize, q); };
  Quality isotropic = ward(Specular::Ward);
  isotropic.path = Path::Forward;
  const Picture plain = draw(sphereWithTangents(), brushed(0.35f, 0), isotropic);
  const double peak = brightest(plain);
  CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0), quality), plain, 0).largest < 1e-5 * peak);
  CHECK(stage.renderer->lastPlan().on("forward_reference"));
  CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0.7f), isotropic), plain, 0).largest < 1e-5 * peak);  // this rung has one width
  const Picture brushedPicture = draw(sphereWithTangents(), brushed(0.35f, 0.7f, 0.4f), quality);
  CHECK(difference(brushedPicture, plain, 0).largest > 0.1 * peak);
  // At the poles all tangents meet: away from them the made ones are u's direction too.
  const Errors made = difference(draw(sphere(1, 192, 384), brushed(0.35f, 0.7f, 0.4f), quality), brushedPicture, 0.01 * peak);
  say("tangents made, against tangents given", made);
  CHECK(made.share() > 0.998);
  CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0.7f, 0.4f + float(kPi)), quality), brushedPicture, 0).largest < 0.001 * peak);
  // Without uv there is no direction: isotropic.
  Mesh bare = sphere(1, 192, 384);
  bare.uv0.clear();
  CHECK(difference(draw(std::move(bare), brushed(0.35f, 0.7f), quality), plain, 0).largest < 1e-5 * peak);
}

TEST_CASE("named conductors: the exact equation on the forward path equals the oracle") {
  Stage stage;
  Quality quality;
  quality.fresnel = Fresnel::Conductor;
  for (std::string_view name : {"gold", "iron", "tungsten"}) {
    const Substance* s = findSubstance(name);
    REQUIRE(s);
    Material m = brushed(0.5f, 0);
    m.albedo = s->f0;
    m.conductorEta = s->eta;
    m.conductorK = s->k;
    const Picture p = stage.linear(lit(sphere(1, 192, 384), m, kBehind), kView, kSize, quality);
    CHECK(stage.renderer->lastPlan().on("forward_reference"));
    const Errors e = againstOracle(p, quality, kBehind, [&](dvec3 n, dvec3 v) {
      reference::OracleSurface o{n, v, dvec3(m.albedo), 1, 0.25};
      o.eta = dvec3(s->eta);
      o.k = dvec3(s->k);
      return o;
    });
    say(name, e);
    CHECK(e.largest < 0.015);
    // Not the same as Schlick's, and of an unnamed metal the exact equation takes its index from F0.
    Quality schlick;
    schlick.path = Path::Forward;
    CHECK(difference(stage.linear(lit(sphere(1, 192, 384), m, kBehind), kView, kSize, schlick), p, 0).largest > 0.01 * brightest(p));
    m.conductorEta = m.conductorK = vec3(0);
    const Errors unnamed = againstOracle(stage.linear(lit(sphere(1, 192, 384), m, kBehind), kView, kSize, quality), quality, kBehind,
                                         [&](dvec3 n, dvec3 v) { return reference::OracleSurface{n, v, dvec3(m.albedo), 1, 0.25}; });
    CHECK(unnamed.largest < 0.015);
  }
}

TEST_CASE("named conductors reflect F0 at normal incidence") {
  Stage stage;
  const Substance* gold = findSubstance("gold");
  REQUIRE(gold);
  Scene scene;
  Material m = brushed(0.5f, 0);
  m.albedo = gold->f0;
  m.conductorEta = gold->eta;
  m.conductorK = gold->k;
  place(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), m);
  addLight(scene, light(LightKind::Directional, vec3(1), 100), {0, 0, 0}, {0, 0, -1});
  Quality quality;
  quality.fresnel = Fresnel::Conductor;
  const dvec3 got = stage.linear(scene, lookAt({0, 0, 8}, {0, 0, 0}, {0, 1, 0}, 0.1f), {3, 3}, quality).at(1, 1);
  // n = l = v: D V = (p + 2)/2pi / 4 with p = 2/alpha² - 2.
  const double lobe = 100 * (2 / (0.25 * 0.25)) / (2 * kPi) / 4;
  for (int c = 0; c < 3; ++c) CHECK(got[c] / lobe == Approx(double(gold->f0[c])).epsilon(0.003));
}
