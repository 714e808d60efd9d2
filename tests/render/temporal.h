// Sequences of pictures into one target, and what they are held against.
#pragma once
#include "plan/temporal.h"
#include "render/painted.h"
#include "render/reduced.h"

namespace burnish::test {

inline Quality temporal(bool on = true) {
  Quality q = plainQuality();
  q.antialiasing = on ? Antialiasing::Temporal : Antialiasing::None;
  return q;
}

/// Root mean square over those pixels that `counts` takes.
template <class F>
double rms(const Picture& a, const Picture& b, F&& counts) {
  double sum = 0, n = 0;
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x)
      if (counts(x, y)) {
        sum += glm::dot(a.at(x, y) - b.at(x, y), a.at(x, y) - b.at(x, y)) / 3;
        n += 1;
      }
  REQUIRE(n > 0);
  return std::sqrt(sum / n);
}
inline double rms(const Picture& a, const Picture& b) {
  return rms(a, b, [](int, int) { return true; });
}

/// `size` metres across in height, seen from the front; a place in the plane z = 0 in the middle.
inline View facing(double x = 0, double y = 0, float height = 2) {
  View v = lookAt({x, y, 2}, {x, y, 0});
  v.orthographic = true;
  v.height = height;
  v.far = 10;
  return v;
}

/// A glowing bar turned by `degrees` before another brightness.
inline Scene slanted(double degrees, float bright, float dark) {
  Scene scene;
  Material m;
  m.unlit = true;
  m.albedo = vec3(bright);
  const double a = degrees * kPi / 180;
  place(scene, quad({0, 0, 0}, vec3(0.7 * std::cos(a), 0.7 * std::sin(a), 0), vec3(-0.3 * std::sin(a), 0.3 * std::cos(a), 0)), m);
  m.albedo = vec3(dark);
  place(scene, quad({0, 0, -0.5f}, {4, 0, 0}, {0, 4, 0}), m);
  return scene;
}

}  // namespace burnish::test
