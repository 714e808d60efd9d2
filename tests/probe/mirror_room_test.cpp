// Mirror rooms (H6 of docs/hard_cases.md): what each bounce adds, against sums in closed form.
#include "probe/probes.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr double kReflectance = 0.9;

/// Mirrors that reflect the same from every side: no Fresnel, no diffuse light.
Quality mirrors() {
  Quality q;
  q.fresnel = Fresnel::None;
  q.ambient = Ambient::None;
  return q;
}
Material mirror(double emission, double reflectance = kReflectance) {
  Material m;
  m.substance = 1;
  m.albedo = vec3(float(reflectance));
  m.roughness = 0.02f;
  m.emission = vec3(float(emission));
  return m;
}
double stored(double albedo) {
  const double root = std::round(std::sqrt(albedo) * 255) / 255;
  return root * root;
}

}  // namespace

TEST_CASE("mirror room: each bounce adds the reflected share of the one before", "[h6]") {
  // All walls alike: whatever way light takes, bounce k adds e R^(k-1), in every direction.
  const vec3 low(-1, -1.5f, -2), high(3, 1, 2);
  Scene scene;
  addRoom(scene, low, high, mirror(2));
  ProbeSet places;
  places.reflections.push_back(probeIn(low, high, {0.5, 0.1, 0.3}));
  BakeOptions options;
  options.quality = mirrors();
  options.size = 32;
  options.bounces = 5;
  Observatory o(std::move(scene), options.quality);
  Bake bake;
  double sum = 0, term = 2, worst = 0;
  while (bake.bounce(o, places, options)) {
    sum += term;
    term *= stored(kReflectance);
    eachTexel(bake.lights[0].radiance.levels[0], [&](int, int, int, const dvec3&, const dvec3& l) { worst = std::max(worst, std::abs(l.x / sum - 1)); });
  }
  CHECK(bake.bounces.size() == 5);
  std::cout << fmt::format("  mirror room, uniform: every texel of 5 bounces within {:.3f} % of e Σ R^i\n", 100 * worst);
  CHECK(worst < 0.01);
}

TEST_CASE("mirror room: two mirrors that face each other, seen along their normal", "[h6]") {
  // The walls at z = -1 and z = 1 give off a and b, the sides nothing. Along the normal the images of both lie one behind the other: a, b, a, ... at R, R², R³.
  const vec3 low(-1, -1, -1), high(1, 1, 1);
  const double a = 5, b = 1;
  const Material side = mirror(0);
  Scene scene;
  addRoom(scene, low, high, {side, side, side, side, mirror(a), mirror(b)});
  ProbeSet places;
  places.reflections.push_back(probeIn(low, high, {0, 0, 0}));
  BakeOptions options;
  options.quality = mirrors();
  options.size = 128;
  options.bounces = 4;
  Observatory o(std::move(scene), options.quality);
  Bake bake;
  const double r = stored(kReflectance);
  while (bake.bounce(o, places, options)) {
    // The texels around the axis: at a slope of 1/128 the path through the probe's box meets the walls at 3, 9, 27 times that, 0.21 at the most of bounce 4.
    const auto seen = [&](int face) {
      double sum = 0;
      for (const int y : {63, 64})
        for (const int x : {63, 64}) sum += texel(bake.lights[0].radiance.levels[0], face, x, y).x / 4;
      return sum;
    };
    double ahead = 0, behind = 0, share = 1;
    for (std::size_t k = 0; k < bake.bounces.size(); ++k, share *= r) {
      ahead += share * (k % 2 ? a : b);
      behind += share * (k % 2 ? b : a);
    }
    std::cout << fmt::format("  facing mirrors, bounce {}: {:.4f} and {:.4f}, off by {:+.3f} % and {:+.3f} %\n", bake.bounces.size(), seen(4), seen(5), 100 * (seen(4) / ahead - 1), 100 * (seen(5) / behind - 1));
    CHECK(seen(4) == Approx(ahead).epsilon(0.01));
    CHECK(seen(5) == Approx(behind).epsilon(0.01));
  }
  CHECK(bake.bounces.size() == 4);
}
