// The sphere chart: errors of rungs in rendered pictures against the tables of numbers that they must have (closed forms and float64 quadrature).
#include "hard_cases/chart.h"

#include <fmt/format.h>

#include <functional>
#include <iostream>
#include <tuple>

#include "plan/rungs.h"
#include "reference/energy.h"

using namespace burnish;
using namespace burnish::test;

TEST_CASE("sphere chart: what void geometry and Kelemen's term keep toward grazing", "[rung-errors]") {
  // Directional albedo with F = 1 by n·v, p = 64 and 8192: float64 quadrature.
  struct Kept {
    double power, nov, wanted;
  };
  const std::vector<Kept> bare = {{64, 1, 1.000}, {64, 0.8, 0.651}, {64, 0.6, 0.380}, {64, 0.4, 0.187}, {64, 0.2, 0.070}};
  const std::vector<Kept> kelemen = {{64, 1, 0.969}, {64, 0.5, 0.918}, {64, 0.2, 0.817}, {64, 0.1, 0.801}, {8192, 1, 1.000}, {8192, 0.5, 0.999}, {8192, 0.2, 0.997}, {8192, 0.1, 0.987}};
  Stage stage;
  Chart chart({mirrorOf(64), mirrorOf(8192)}, 160);
  chart.scene.environment.color = vec3(1);
  for (const auto& [geometry, name, rows] : {std::tuple(Geometry::Void, "void", bare), std::tuple(Geometry::Kelemen, "kelemen", kelemen)}) {
    const Quality q = forwardOf(geometry);
    const Picture p = stage.linear(chart.scene, chart.view, chart.size, q);
    const shading::Rungs rungs = plan::rungsOf(q);
    for (const Kept& k : rows) {
      const double shown = chart.redAt(p, k.power == 64 ? 0 : 1, k.nov);
      std::cout << fmt::format("  {}, p {}: keeps {:.3f} at n.v {} ({:.3f} by the table)\n", name, k.power, shown, k.nov, k.wanted);
      CHECK(shown == Approx(k.wanted).margin(0.004));  // a table of 1e-3, and a quadratic of n.v fitted by a line
    }
    // Every pixel against the quadrature; nothing is above 1.
    double worst = 0, most = 0;
    for (std::size_t i = 0; i < 2; ++i)
      chart.each(i, 0.05, [&](int x, int y, const dvec3& n) {
        if ((x + y) % 7 != 0) return;
        const glm::dvec2 e = reference::lobeAlbedo(rungs, n.z, alphaOfPower(i == 0 ? 64 : 8192));
        worst = std::max(worst, std::abs(p.at(x, y).x - e.x - e.y));
        most = std::max(most, p.at(x, y).x);
      });
    std::cout << fmt::format("  {}: off the quadrature by at most {:.4f}\n", name, worst);
    CHECK(worst < 0.004);
    CHECK(most < 1.001);
  }
}

TEST_CASE("sphere chart: normalizations of a bare lobe against the exact one", "[rung-errors]") {
  // N(p) over (p+2)(p+4)/(8 pi (2^(-p/2) + p)), less 1; the chart shows it at every lit pixel.
  const std::vector<double> powers = {1, 8.8, 16, 64};
  struct Wanted {
    Normalization rung;
    std::vector<double> percent;  // at those powers; empty: by the closed form alone
    std::function<double(double)> n;
  };
  const std::vector<Wanted> all = {{Normalization::None, {}, [](double) { return 1.0; }},
                                   {Normalization::LinearFit, {-64.1, NAN, -19.4, -5.8}, [](double p) { return 0.0397436 * p + 0.0856832; }},
                                   {Normalization::LinearFit8, {}, [](double p) { return 0.0397436 * p + 0.3183; }},
                                   {Normalization::Plus2, {-65.9, NAN, -20.0, -5.9}, [](double p) { return (p + 2) / (8 * kPi); }},
                                   {Normalization::Plus8, {NAN, 7.52, NAN, NAN}, [](double p) { return (p + 8) / (8 * kPi); }}};
  Stage stage;
  std::vector<Material> materials;
  for (const double p : powers) materials.push_back(mirrorOf(p));
  Chart chart(materials, 48);
  addLight(chart.scene, light(LightKind::Directional, vec3(1), 10), {}, {-0.3, -0.4, -1});
  const auto drawn = [&](Normalization rung) {
    Quality q = forwardOf(Geometry::Void);
    q.normalization = rung;
    return stage.linear(chart.scene, chart.view, chart.size, q);
  };
  const Picture exact = drawn(Normalization::Exact);
  for (const Wanted& w : all) {
    const Picture p = drawn(w.rung);
    for (std::size_t i = 0; i < powers.size(); ++i) {
      const double power = powers[i], truth = w.n(power) / ((power + 2) * (power + 4) / (8 * kPi * (std::exp2(-power / 2) + power))) - 1;
      double least = 1e9, most = -1e9;
      chart.each(i, 0.1, [&](int x, int y, const dvec3&) {
        if (!(exact.at(x, y).x > 1e-4)) return;
        const double off = p.at(x, y).x / exact.at(x, y).x - 1;
        least = std::min(least, off), most = std::max(most, off);
      });
      std::cout << fmt::format("  {}, p {}: {:+.2f} % to {:+.2f} %, {:+.2f} % by the closed form\n", terms()[3].rungs[std::size_t(w.rung)].name, power, 100 * least, 100 * most, 100 * truth);
      CHECK(least == Approx(truth).margin(1e-3 * (1 + std::abs(truth))));
      CHECK(most == Approx(truth).margin(1e-3 * (1 + std::abs(truth))));
      if (!w.percent.empty() && !std::isnan(w.percent[i])) CHECK(100 * truth == Approx(w.percent[i]).margin(0.051));
    }
  }
}

TEST_CASE("sphere chart: Schlick's equation against Fresnel's, worst differences by index", "[rung-errors]") {
  // Black dielectric tiles that face the half vector of light and eye: n.h = 1, l.h = the angle at hand. Divided by the picture without Fresnel (F0), what is left is F itself.
  struct Wanted {
    double index, worst, degrees;
  };
  const std::vector<Wanted> all = {{1.33, 0.060, 83.8}, {1.5, 0.036, 85.0}, {1.8, 0.035, 85.4}, {2.4, 0.074, 84.5}};
  Stage stage;
  std::vector<double> worst(all.size()), at(all.size()), sign(all.size());
  for (double degrees = 60; degrees < 88.51; degrees += degrees < 82 ? 2 : 0.25) {
    const double a = glm::radians(degrees), c = std::cos(a), s = std::sin(a);
    Scene scene;
    for (std::size_t i = 0; i < all.size(); ++i) {
      Material m;
      m.albedo = vec3(0);
      m.substance = encodeDielectric(f0FromIor(float(all[i].index)));
      m.roughness = 0.5f;
      place(scene, quad({float(i), 0, 0}, {0.4f, 0, 0}, vec3(dvec3(0, c, -s) * (0.4 / c))), m);
    }
    // The eye is at +z, the tiles' normal at (0, s, c), the light as far beyond it.
    addLight(scene, light(LightKind::Directional, vec3(1), 10), {}, -dvec3(0, std::sin(2 * a), std::cos(2 * a)));
    View view = lookAt({1.5, 0, 30}, {1.5, 0, 0});
    view.orthographic = true;
    view.height = 1;
    view.far = 60;
    const auto drawn = [&](Fresnel rung) {
      Quality q = forwardOf(Geometry::Kelemen);
      q.fresnel = rung;
      return stage.linear(scene, view, {64, 16}, q);
    };
    const Picture none = drawn(Fresnel::None), schlick = drawn(Fresnel::Schlick), exact = drawn(Fresnel::Dielectric);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const int x = int(i) * 16 + 8;
      const double f0 = double(f0FromIor(float(all[i].index))), base = none.at(x, 8).x;
      REQUIRE(base > 0);
      const double off = (schlick.at(x, 8).x - exact.at(x, 8).x) / base * f0;
      if (std::abs(off) > worst[i]) worst[i] = std::abs(off), at[i] = degrees, sign[i] = off > 0 ? 1 : -1;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::cout << fmt::format("  index {}: off by {:.4f} at {} degrees, too {} there ({:.3f} at {} by the table)\n", all[i].index, worst[i], at[i], sign[i] > 0 ? "bright" : "dark", all[i].worst, all[i].degrees);
    CHECK(worst[i] == Approx(all[i].worst).margin(0.001));
    CHECK(at[i] == Approx(all[i].degrees).margin(0.6));
  }
}

TEST_CASE("sphere chart: what pow loses of narrow lobes", "[rung-errors]") {
  // Worst |error| of (n.h)^p over the lobe with a plain float32 pow, by roughness. Another pow rounds otherwise: the size is held to a factor of 3, the stable rung to its own bound (float normals aside).
  struct Wanted {
    double roughness, error;
  };
  Stage stage;
  for (const Wanted& w : {Wanted{0.2, 0.00015}, Wanted{0.1, 0.0028}, Wanted{0.05, 0.045}, Wanted{0.02, 0.74}}) {
    // The middle of a ball, three half-widths to each side, with the light beside the eye so that the half vector is the axis.
    const double alpha = w.roughness * w.roughness, extent = 3 * 0.83 * alpha;
    Scene scene;
    Material m;
    m.albedo = vec3(1);
    m.substance = 1;
    m.roughness = float(w.roughness);
    Mesh patch;
    constexpr std::uint32_t kCells = 64;
    for (std::uint32_t j = 0; j <= kCells; ++j)
      for (std::uint32_t i = 0; i <= kCells; ++i) {
        const double x = 1.05 * extent * (2.0 * i / kCells - 1), y = 1.05 * extent * (2.0 * j / kCells - 1);
        // Turned off every axis, where rounding is kindest.
        const dvec3 n = glm::normalize(dvec3(x, y, std::sqrt(1 - x * x - y * y)));
        patch.positions.emplace_back(n), patch.normals.emplace_back(n), patch.uv0.emplace_back(0);
      }
    for (std::uint32_t j = 0; j < kCells; ++j)
      for (std::uint32_t i = 0; i < kCells; ++i) {
        const std::uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
        patch.indices.insert(patch.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    glm::dmat4 frame(1);
    frame[2] = glm::dvec4(glm::normalize(dvec3(0.36, 0.72, 0.59)), 0);
    frame[0] = glm::dvec4(glm::normalize(glm::cross(dvec3(0.3, -0.2, 0.9), dvec3(frame[2]))), 0);
    frame[1] = glm::dvec4(glm::cross(dvec3(frame[2]), dvec3(frame[0])), 0);
    const glm::dmat3 axes(frame);
    place(scene, std::move(patch), m, frame);
    const dvec3 toLight = axes * glm::normalize(dvec3(0.35, 0.2, 1)), toEye = axes * glm::normalize(dvec3(-0.35, -0.2, 1));
    addLight(scene, light(LightKind::Directional, vec3(1), 10), {}, -toLight);
    View view = lookAt(axes[2] + toEye * 3.0, axes[2], axes[1]);
    view.orthographic = true;
    view.height = float(2 * extent);
    view.far = 8;
    const auto drawn = [&](Lobe rung) {
      Quality q = forwardOf(Geometry::Kelemen);
      q.lobe = rung;
      return stage.linear(scene, view, {72, 72}, q);
    };
    const Picture stable = drawn(Lobe::Stable), plain = drawn(Lobe::Pow);
    double peak = 0, worst = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 72; ++x) peak = std::max(peak, stable.at(x, y).x);
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 72; ++x) worst = std::max(worst, std::abs(plain.at(x, y).x - stable.at(x, y).x) / peak);
    std::cout << fmt::format("  roughness {}: pow is off by {:.5f} of the peak ({:.5f} by the table)\n", w.roughness, worst, w.error);
    // 10 E D/4 n.l: the closed form of the highlight's middle, which the stable rung must have.
    CHECK(peak == Approx(10 / (4 * kPi * alpha * alpha) * glm::dot(toLight, axes[2]) / std::pow(glm::dot(toLight, axes[2]), 2)).epsilon(0.02));
    CHECK(worst > w.error / 3);
    CHECK(worst < std::max(3 * w.error, 3e-4));
  }
}
