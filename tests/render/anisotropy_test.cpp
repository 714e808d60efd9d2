// Brushed surfaces and rough diffuse on both paths, and the exact Fresnel equation of named conductors on the forward one, against the double oracle.
#include <fmt/format.h>

#include <algorithm>
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
  rungs.anisotropic = rungs.roughDiffuse = 1;
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

namespace {

/// Specular models with two widths, the default first.
std::vector<std::pair<const char*, Quality>> twoWidthModels() {
  Quality ggx = ward(Specular::GgxSmith), beckmann, rough;
  beckmann.distribution = Distribution::Beckmann;
  beckmann.geometry = Geometry::Smith;
  rough.geometry = Geometry::SchlickSmith;
  return {{"default", {}}, {"ggx-smith", ggx}, {"beckmann, smith", beckmann}, {"schlick-smith", rough}, {"ward-anisotropic", ward(Specular::WardAnisotropic)}, {"ward-bounded", ward(Specular::WardBounded)}};
}

reference::OracleSurface brushedAt(const Material& m, dvec3 n, dvec3 v) {
  reference::OracleSurface s{n, v, dvec3(m.albedo), double(m.substance), double(m.roughness) * double(m.roughness)};
  const dvec3 t = tangentOf(n), b = glm::cross(t, n);
  s.tangent = t * std::cos(double(m.anisotropyRotation)) + b * std::sin(double(m.anisotropyRotation));
  s.anisotropy = double(m.anisotropy);
  s.sigma = double(m.diffuseRoughness);
  return s;
}

}  // namespace

TEST_CASE("two widths on the forward path equal the oracle, every model that has them") {
  Stage stage;
  for (auto [name, quality] : twoWidthModels())
    for (const auto& [strength, rotation] : {std::pair(0.6f, 0.0f), std::pair(0.8f, -2.0f), std::pair(1.0f, 1.5f)}) {
      quality.path = Path::Forward;
      const Material m = brushed(0.35f, strength, rotation);
      const Picture p = stage.linear(lit(sphereWithTangents(), m), kView, kSize, quality);
      const Errors e = againstOracle(p, quality, kBeside, [&](dvec3 n, dvec3 v) { return brushedAt(m, n, v); });
      say(fmt::format("{}, strength {}, turned by {}", name, strength, rotation), e);
      CHECK(e.count > 20000);
      CHECK(e.largest < 0.015);
    }
}

namespace {

/// A highlight's shape in the slopes of the half vector: log L = c - xx x² - xy x y - yy y².
struct Shape {
  double angle = 0, along = 0, across = 0;  ///< of the longer axis from the given tangent (radians); slopes of half of the peak
};

/// Solves the weighted least squares of four unknowns by elimination.
Shape shapeOf(const std::vector<glm::dvec2>& slopes, const std::vector<double>& radiance, const std::vector<double>& weight) {
  double a[4][5] = {};
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const double x = slopes[i].x, y = slopes[i].y, row[4] = {1, x * x, x * y, y * y}, value = std::log(std::max(radiance[i], 1e-12));
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) a[r][c] += weight[i] * row[r] * row[c];
      a[r][4] += weight[i] * row[r] * value;
    }
  }
  for (int p = 0; p < 4; ++p)
    for (int r = 0; r < 4; ++r) {
      if (r == p) continue;
      const double f = a[r][p] / a[p][p];
      for (int c = p; c < 5; ++c) a[r][c] -= f * a[p][c];
    }
  const double xx = -a[1][4] / a[1][1], xy = -a[2][4] / a[2][2], yy = -a[3][4] / a[3][3];
  const double mean = 0.5 * (xx + yy), part = std::hypot(0.5 * (xx - yy), 0.5 * xy);
  return {0.5 * std::atan2(-xy, yy - xx), std::sqrt(std::log(2.0) / (mean - part)), std::sqrt(std::log(2.0) / (mean + part))};
}

}  // namespace

// The tangent's code errs by 3.1e-5 radians, each width's by 1.6 %, the normal by 1e-3 radians at most, which moves slopes by 1/100 of the narrow width here.
TEST_CASE("a brushed highlight through the G-buffer: direction within half a degree, widths within 4 %") {
  Stage stage;
  View view = kView;
  view.orthographic = true;
  view.height = 1.0f;
  view.far = 10;
  const dvec3 toEye = view.axes[2], h = glm::normalize(toEye + kBeside);
  for (const auto& [name, quality] : {std::pair("default", Quality{}), std::pair("ward-bounded", ward(Specular::WardBounded))})
    for (const auto& [roughness, strength, rotation] : {std::tuple(0.3f, 0.35f, 0.4f), std::tuple(0.3f, 0.5f, 1.9f), std::tuple(0.4f, 0.45f, -0.7f)}) {
      const Material m = brushed(roughness, strength, rotation);
      const Picture p = stage.linear(lit(sphereWithTangents(), m), view, kSize, quality);
      CHECK(stage.renderer->lastPlan().target("gbuffer_d"));
      CHECK(!stage.renderer->lastPlan().on("forward_reference"));
      shading::Rungs rungs = plan::rungsOf(quality);
      rungs.anisotropic = 1;
      const reference::OracleLight sun{kBeside, dvec3(100.0)};
      std::vector<glm::dvec2> slopes;
      std::vector<double> drawn, oracle, weight;
      double peak = 0;
      for (int y = 0; y < kSize.y; ++y)
        for (int x = 0; x < kSize.x; ++x) {
          const Ray r = rayThrough(view, kSize, x + 0.5, y + 0.5);
          const double b = glm::dot(r.origin, r.direction), d = b * b - glm::dot(r.origin, r.origin) + 1;
          if (d <= 0) continue;
          const dvec3 n = r.origin + r.direction * (-b - std::sqrt(d)), t = tangentOf(n), s = glm::cross(t, n);
          slopes.emplace_back(glm::dot(h, t) / glm::dot(h, n), glm::dot(h, s) / glm::dot(h, n));
          drawn.push_back(p.at(x, y).x);
          oracle.push_back(reference::shade(brushedAt(m, n, -r.direction), {&sun, 1}, rungs).x);
          peak = std::max(peak, oracle.back());
        }
      for (double value : oracle) weight.push_back(value > 0.25 * peak ? value * value : 0);
      const Shape got = shapeOf(slopes, drawn, weight), wanted = shapeOf(slopes, oracle, weight);
      const double turned = std::remainder(got.angle - wanted.angle, kPi), given = std::remainder(wanted.angle - double(rotation), kPi);
      std::cout << fmt::format("  {}, roughness {}, strength {}: turned by {:+.4f} degrees, length off by {:+.2f} %, width by {:+.2f} % (slopes {:.3f} and {:.3f}; axis {:+.2f} degrees off the material's)\n", name,
                               roughness, strength, glm::degrees(turned), 100 * (got.along / wanted.along - 1), 100 * (got.across / wanted.across - 1), wanted.along, wanted.across, glm::degrees(given));
      CHECK(std::abs(glm::degrees(given)) < 5);  // the fit measures what it is meant to
      CHECK(wanted.along > 1.3 * wanted.across);
      CHECK(std::abs(glm::degrees(turned)) < 0.5);
      CHECK(std::abs(got.along / wanted.along - 1) < 0.04);
      CHECK(std::abs(got.across / wanted.across - 1) < 0.04);
    }
}

TEST_CASE("anisotropy: none is isotropic, some is not; tangents are made where the mesh brings none; a turn by pi is none") {
  Stage stage;
  const auto draw = [&](Mesh mesh, const Material& m, const Quality& q) { return stage.linear(lit(std::move(mesh), m), kView, kSize, q); };
  for (const Path path : {Path::Deferred, Path::Forward}) {
    Quality quality = ward(Specular::WardAnisotropic), isotropic = ward(Specular::Ward);
    quality.path = isotropic.path = path;
    CAPTURE(int(path));
    const Picture plain = draw(sphereWithTangents(), brushed(0.35f, 0), isotropic);
    const double peak = brightest(plain);
    CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0), quality), plain, 0).largest < 1e-5 * peak);
    CHECK(!stage.renderer->lastPlan().on("anisotropy"));
    CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0.7f), isotropic), plain, 0).largest < 1e-5 * peak);  // this rung has one width
    CHECK(!stage.renderer->lastPlan().on("anisotropy"));
    const Picture brushedPicture = draw(sphereWithTangents(), brushed(0.35f, 0.7f, 0.4f), quality);
    CHECK(stage.renderer->lastPlan().on("anisotropy"));
    CHECK(difference(brushedPicture, plain, 0).largest > 0.1 * peak);
    // At the poles all tangents meet: away from them the made ones are u's direction too.
    const Errors made = difference(draw(sphere(1, 192, 384), brushed(0.35f, 0.7f, 0.4f), quality), brushedPicture, 0.01 * peak);
    say("tangents made, against tangents given", made);
    CHECK(made.share() > 0.998);
    CHECK(difference(draw(sphereWithTangents(), brushed(0.35f, 0.7f, 0.4f + float(kPi)), quality), brushedPicture, 0).largest < 0.001 * peak);
    // Without uv there is no direction: isotropic. (Another program may round a normal's code the other way: a step of it is 5e-4 radians, which moves this flank by 0.4 % of the peak.)
    Mesh bare = sphere(1, 192, 384);
    bare.uv0.clear();
    const Errors none = difference(draw(std::move(bare), brushed(0.35f, 0.7f), quality), plain, 1e-5 * peak);
    CHECK(none.largest < 0.005 * peak);
    CHECK(none.share() > 0.999);
  }
}

namespace {

/// Surroundings with a bright window, a dark floor and broad bands.
void surround(Scene& scene) {
  Image& map = scene.environment.map;
  map = makeImage(128, 64, 3, PixelType::F32);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {
      const bool window = x > 68 && x < 84 && y > 14 && y < 30;
      for (int c = 0; c < 3; ++c) map.f32()[(y * 128 + x) * 3 + c] = window ? 30.0f : float(y > 36 ? 0.2 : 1.5 + std::cos(0.3 * x + 0.6 * c));
    }
  ++scene.environment.revision;
}

/// Mean of |a - b| over the sphere's pixels away from its edge and poles, as a share of b's mean.
double apart(const Picture& a, const Picture& b) {
  double off = 0, mean = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const Ray r = rayThrough(kView, kSize, x + 0.5, y + 0.5);
      const double q = glm::dot(r.origin, r.direction), d = q * q - glm::dot(r.origin, r.origin) + 1;
      if (d <= 0.1) continue;
      if (std::abs((r.origin + r.direction * (-q - std::sqrt(d))).y) > 0.9) continue;
      off += std::abs(a.at(x, y).y - b.at(x, y).y);
      mean += b.at(x, y).y;
    }
  return off / mean;
}

}  // namespace

TEST_CASE("the surroundings in brushed metal: prefiltered lookups along the tangent, against 256 samples of the lobe", "[sweep]") {
  Stage stage;
  for (const auto& [roughness, strength] : {std::pair(0.2f, 0.6f), std::pair(0.35f, 0.5f), std::pair(0.35f, 0.9f), std::pair(0.5f, 0.8f)}) {
    Quality sampled, dfg;
    sampled.environmentSpecular = EnvironmentSpecular::Sampled;
    const auto draw = [&](float r, float s, const Quality& quality) {
      Scene scene;
      place(scene, sphereWithTangents(), brushed(r, s, 0.5f));
      surround(scene);
      return stage.linear(scene, kView, kSize, quality);
    };
    // What the method adds is what it errs by over the round lobe's own error.
    const double alpha = double(roughness) * double(roughness), along = alpha + (1 - alpha) * double(strength) * double(strength);
    const float round = float(std::sqrt(std::sqrt(0.5 * (alpha * alpha + along * along))));
    const Picture truth = draw(roughness, strength, sampled);
    const double with = apart(draw(roughness, strength, dfg), truth), without = apart(draw(round, 0, dfg), truth), own = apart(draw(round, 0, dfg), draw(round, 0, sampled));
    std::cout << fmt::format("  roughness {}, strength {}: off by {:.1f} % of the mean; as a round lobe {:.1f} %; a round lobe's own error {:.1f} %\n", roughness, strength, 100 * with, 100 * without, 100 * own);
    CHECK(with < 0.6 * without);
  }
}

TEST_CASE("rough diffuse on both paths equals the oracle") {
  Stage stage;
  for (const Path path : {Path::Forward, Path::Deferred})
    for (const auto diffuse : {Diffuse::Lambert, Diffuse::CoupledFit, Diffuse::OrenNayarQualitative})
      for (const float sigma : {0.2f, 0.7f}) {
        Quality quality;
        quality.path = path;
        quality.diffuse = diffuse;
        Material m = brushed(0.8f, 0);
        m.substance = 1.0f / 3;
        m.diffuseRoughness = sigma;
        const Picture p = stage.linear(lit(sphere(1, 192, 384), m, kBehind), kView, kSize, quality);
        CHECK(stage.renderer->lastPlan().on("rough_diffuse"));
        const Errors e = againstOracle(p, quality, kBehind, [&](dvec3 n, dvec3 v) { return brushedAt(m, n, v); });
        say(fmt::format("{}, diffuse {}, sigma {}", path == Path::Forward ? "forward" : "deferred", terms()[6].rungs[std::size_t(diffuse)].name, sigma), e);
        CHECK(e.count > 4000);
        // Deferred: half a step of albedo's square root is 1.2 % of what is left of the albedo, of sigma 0.002.
        CHECK(e.largest < (path == Path::Forward ? 0.015 : 0.03));
        Material smooth = m;
        smooth.diffuseRoughness = 0;
        CHECK(difference(stage.linear(lit(sphere(1, 192, 384), smooth, kBehind), kView, kSize, quality), p, 0).largest > 0.04 * brightest(p));
      }
}

namespace {

/// A round sphere inside a ring of thin brushed and rough bars, whose boxes cover it.
Scene behindBars(bool bars) {
  Scene scene;
  Material plain;
  plain.albedo = {0.8f, 0.5f, 0.3f};
  plain.substance = 0.8f;
  plain.roughness = 0.4f;
  place(scene, sphere(0.8f, 64, 128), plain);
  Material detail = brushed(0.3f, 0.8f);
  detail.substance = 0.45f;
  detail.diffuseRoughness = 0.5f;
  if (bars)
    for (int i = 0; i < 2; ++i) {
      const float c = 0.7071f, s = i ? 0.7071f : -0.7071f;
      Mesh bar = box({-1.6f, -0.02f, -0.9f}, {1.6f, 0.02f, -0.86f});
      for (vec3& p : bar.positions) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.x > 0 ? p.z + 1.9f : p.z};
      for (vec3& n : bar.normals) n = {c * n.x - s * n.y, s * n.x + c * n.y, n.z};
      place(scene, std::move(bar), detail);
    }
  addLight(scene, light(LightKind::Directional, vec3(1), 20), {0, 0, 0}, {-0.5, -0.6, -0.7});
  addLight(scene, light(LightKind::Point, vec3(1, 0.6f, 0.4f), 10, 5), {1.2, 0.8, 1.6});
  scene.environment.color = vec3(1, 2, 3);
  return scene;
}

}  // namespace

TEST_CASE("round surfaces in tiles that may show brushed or rough ones: the same picture within 1/255") {
  Stage stage;
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.55f);
  Quality quality;
  quality.exposureEv = 3.0f;
  const Picture with = stage.display(behindBars(true), view, kSize, quality);
  CHECK(stage.renderer->lastPlan().target("gbuffer_d"));
  const Picture without = stage.display(behindBars(false), view, kSize, quality);
  CHECK(!stage.renderer->lastPlan().target("gbuffer_d"));
  std::size_t same = 0, off = 0, bars = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      // The bars lie on the picture's diagonals, 0.02 to either side and nearer at one end: 8 pixels around them are left out.
      const double u = x + 0.5 - kSize.x / 2.0, v = y + 0.5 - kSize.y / 2.0;
      if (std::min(std::abs(u - v), std::abs(u + v)) * 0.7071 < 8) {
        ++bars;
        continue;
      }
      const dvec3 d = glm::abs(with.at(x, y) - without.at(x, y));
      (std::max({d.x, d.y, d.z}) < 1.5 / 255 ? same : off) += 1;
    }
  std::cout << fmt::format("  {} pixels alike, {} off, {} around the bars left out\n", same, off, bars);
  CHECK(off == 0);
  CHECK(same > 15000);
  CHECK(difference(with, without, 0).largest > 0.05);  // the bars are there
}

TEST_CASE("the plan of brushed and rough surfaces: a target and programs only while one is in view, and a setting may refuse") {
  Scene scene = behindBars(true);
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.55f), away = lookAt({0, 0, 4}, {0, 0, 8}, {0, 1, 0}, 0.55f);
  const auto planOf = [&](const Scene& s, const View& v, const Quality& q = {}, PlanOptions options = {}) {
    options.size = kSize;
    return makePlan(s, {&v, 1}, q, Capabilities{}, options);
  };
  const auto detailed = [](const FramePlan& p) {
    return std::count_if(p.programs.begin(), p.programs.end(), [](const ProgramPlan& q) { return q.name.find("+brushed") != std::string::npos || q.name.find("+rough") != std::string::npos; });
  };
  const auto reason = [](const FramePlan& p, std::string_view effect) {
    return std::find_if(p.effects.begin(), p.effects.end(), [&](const EffectPlan& e) { return e.name == effect; })->reason;
  };
  const FramePlan on = planOf(scene, view);
  CHECK((on.on("anisotropy") && on.on("rough_diffuse")));
  REQUIRE(on.target("gbuffer_d"));
  CHECK(on.target("gbuffer_d")->format == "RGBA8");
  CHECK(on.gbufferBytesPerPixel == 12);
  CHECK(detailed(on) >= 3);
  const FramePlan out = planOf(scene, away);
  CHECK((!out.on("anisotropy") && !out.on("rough_diffuse") && !out.target("gbuffer_d")));
  CHECK(detailed(out) == 0);
  CHECK(reason(out, "anisotropy").starts_with("out of view: "));
  const FramePlan plain = planOf(behindBars(false), view);
  CHECK((detailed(plain) == 0 && !plain.target("gbuffer_d") && plain.gbufferBytesPerPixel == 8));
  // Settings refuse one or the other.
  Quality round, phong = ward(Specular::Phong), smooth;
  round.anisotropy = Anisotropy::None;
  smooth.roughDiffuse = RoughDiffuse::None;
  CHECK((!planOf(scene, view, round).on("anisotropy") && planOf(scene, view, round).target("gbuffer_d")));
  CHECK(reason(planOf(scene, view, round), "anisotropy") == "the quality turns it off");
  CHECK(reason(planOf(scene, view, phong), "anisotropy") == "the specular model has one width");
  smooth.anisotropy = Anisotropy::None;
  CHECK((!planOf(scene, view, smooth).on("rough_diffuse") && !planOf(scene, view, smooth).target("gbuffer_d")));
  for (const ProgramPlan& p : planOf(scene, view, round).programs) CHECK(p.name.find("brushed") == std::string::npos);
  // Taken off the list.
  PlanOptions removed;
  removed.removed = {"anisotropy", "rough_diffuse"};
  CHECK((detailed(planOf(scene, view, {}, removed)) == 0 && !planOf(scene, view, {}, removed).target("gbuffer_d")));
  // Views of the fields.
  for (const auto& [shown, effect] : {std::pair(DebugView::Anisotropy, "anisotropy"), std::pair(DebugView::DiffuseRoughness, "rough_diffuse")}) {
    PlanOptions options;
    options.debugView = shown;
    const FramePlan p = planOf(scene, view, {}, options);
    CHECK((p.on(effect) && p.target("gbuffer_d")));
  }
  PlanOptions albedo;
  albedo.debugView = DebugView::Albedo;
  CHECK(!planOf(scene, view, {}, albedo).target("gbuffer_d"));
  // What is shaded where it is drawn needs no target.
  Scene glass = behindBars(false);
  Material pane = brushed(0.4f, 0.7f);
  pane.substance = 1.0f / 3;
  pane.blend = true;
  pane.opacity = 0.5f;
  place(glass, quad({0, 0, 1}, {0.5f, 0, 0}, {0, 0.5f, 0}), pane);
  const FramePlan over = planOf(glass, view);
  CHECK((over.on("anisotropy") && over.on("alpha_blend") && !over.target("gbuffer_d")));
  CHECK(detailed(over) == 1);
}

TEST_CASE("anisotropy and rough diffuse forced on without a surface that has them: the same picture") {
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.55f);
  RendererOptions forced;
  forced.forcedEffects = {"anisotropy", "rough_diffuse"};
  Stage usual, with(forced);
  Quality quality;
  quality.exposureEv = 3.0f;
  const Picture a = usual.display(behindBars(false), view, kSize, quality), b = with.display(behindBars(false), view, kSize, quality);
  CHECK(with.renderer->lastPlan().target("gbuffer_d"));
  CHECK(same(a, b));
}

TEST_CASE("views of brushing and diffuse roughness show the fields of the surfaces that have them") {
  Stage stage;
  const View view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.3f);
  for (const bool detail : {true, false}) {
    Scene scene;
    Material m = brushed(0.3f, detail ? 1.0f : 0.0f, 0.6435011f);  // cos 0.8, sin 0.6
    m.diffuseRoughness = detail ? 0.5f : 0.0f;
    place(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), m);
    RenderRequest request;
    request.debugView = DebugView::Anisotropy;
    // u runs along x; 1 - αy/αx is 1 - 0.09.
    const dvec3 along = stage.draw(scene, {&view, 1}, {8, 8}, {}, request).at(4, 4);
    CHECK(along.x == Approx(detail ? 0.8 * std::sqrt(1 - 0.09) : 0).margin(0.012));
    CHECK(along.y == Approx(detail ? 0.6 * std::sqrt(1 - 0.09) : 0).margin(0.012));
    CHECK(along.z == Approx(0).margin(0.012));
    request.debugView = DebugView::DiffuseRoughness;
    CHECK(stage.draw(scene, {&view, 1}, {8, 8}, {}, request).at(4, 4).x == Approx(detail ? 0.5 : 0).margin(1.5 / 255));
  }
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
