// A chart of balls in rendered linear pictures: what rungs are held against each other on. Forward path: normals and roughness are not rounded.
#pragma once
#include <vector>

#include "render/scenes.h"
#include "stability/scenes.h"

namespace burnish::test {

inline double alphaOfPower(double p) { return std::sqrt(2 / (p + 2)); }

/// White metal of F0 1 with that Blinn-Phong power: its Fresnel is 1 at every angle.
inline Material mirrorOf(double power) {
  Material m;
  m.albedo = vec3(1);
  m.substance = 1;
  m.roughness = float(std::sqrt(alphaOfPower(power)));
  return m;
}
inline Quality forwardOf(Geometry geometry) {
  Quality q;
  q.path = Path::Forward;
  q.geometry = geometry;
  return q;
}

/// A row of balls side by side, a unit apart from edge to edge, each `cell` pixels wide; looked at along -z without perspective.
struct Chart {
  Scene scene;
  View view;
  glm::ivec2 size;
  int cell;

  Chart(const std::vector<Material>& materials, int pixels) : cell(pixels) {
    const Id<Mesh> ball = scene.meshes.add(stability::halfBall(160, 256));
    for (std::size_t i = 0; i < materials.size(); ++i) {
      Instance instance;
      instance.mesh = ball;
      instance.material = scene.materials.add(materials[i]);
      instance.node = addNode(scene, translation({2.0 * double(i) + 1, 1, 0}));
      scene.instances.add(instance);
    }
    const double middle = double(materials.size());
    view = lookAt({middle, 1, 5}, {middle, 1, 0});
    view.orthographic = true;
    view.height = 2;
    view.far = 10;
    size = {cell * int(materials.size()), cell};
  }
  /// f(x, y of the picture, normal) for the pixels of ball i whose n·v is at least `least`.
  template <class F>
  void each(std::size_t i, double least, F&& f) const {
    for (int y = 0; y < cell; ++y)
      for (int x = 0; x < cell; ++x) {
        const double u = (2.0 * x + 1) / cell - 1, v = 1 - (2.0 * y + 1) / cell, z2 = 1 - u * u - v * v;
        if (z2 >= least * least) f(int(i) * cell + x, y, dvec3(u, v, std::sqrt(z2)));
      }
  }
  /// The picture's red on ball i where n·v is `nov`, by least squares over the pixels nearby.
  [[nodiscard]] double redAt(const Picture& p, std::size_t i, double nov) const {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    const double reach = std::max(0.03, 0.1 * nov * (nov > 0.9));
    each(i, 0.02, [&](int x, int y, const dvec3& normal) {
      const double d = normal.z - nov;
      if (std::abs(d) > reach) return;
      const double red = p.at(x, y).x;
      n += 1, sx += d, sy += red, sxx += d * d, sxy += d * red;
    });
    REQUIRE(n > 8);
    return (sxx * sy - sx * sxy) / (n * sxx - sx * sx);
  }
};

}  // namespace burnish::test
