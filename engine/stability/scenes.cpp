#include "stability/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burnish::stability {

using glm::dvec3;
using glm::vec3;

namespace {
constexpr double kPi = std::numbers::pi;
}

Mesh sphere(std::uint32_t rings, std::uint32_t columns) {
  Mesh m;
  for (std::uint32_t r = 0; r <= rings; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double t = kPi * r / rings, p = 2 * kPi * c / columns;
      const vec3 n(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
      m.positions.push_back(n);
      m.normals.push_back(n);
      m.uv0.emplace_back(float(c) / float(columns), float(r) / float(rings));
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
      m.indices.insert(m.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return m;
}

Mesh halfBall(std::uint32_t rings, std::uint32_t columns) {
  Mesh m;
  for (std::uint32_t r = 0; r <= rings + 2; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double t = kPi / 2 * r / rings, p = 2 * kPi * c / columns;
      m.positions.emplace_back(vec3(dvec3(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t))));
    }
  m.normals = m.positions;
  for (std::uint32_t r = 0; r < rings + 2; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
      m.indices.insert(m.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  return m;
}

Mesh quad(vec3 center, vec3 u, vec3 v) {
  Mesh m;
  m.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  m.normals.assign(4, glm::normalize(glm::cross(u, v)));
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}

Texture flatNormals() {
  Texture t;
  t.name = "flat";
  t.kind = MapKind::NormalRoughness;
  t.image = makeImage(2, 2, 4, PixelType::U8);
  for (int i = 0; i < 16; ++i) t.image.u8()[i] = i % 4 < 2 ? 128 : 255;
  return t;
}

void place(Scene& scene, Mesh mesh, const Material& material, const glm::dmat4& local) {
  Instance instance;
  instance.mesh = scene.meshes.add(std::move(mesh));
  instance.material = scene.materials.add(material);
  Node node;
  node.local = local;
  instance.node = scene.nodes.add(node);
  scene.instances.add(instance);
}

glm::dmat4 translation(dvec3 to) {
  glm::dmat4 m(1);
  m[3] = glm::dvec4(to, 1);
  return m;
}

void addLight(Scene& scene, Light light, dvec3 position, dvec3 direction) {
  const dvec3 back = glm::normalize(direction) * -1.0;
  const dvec3 right = glm::normalize(glm::cross(std::abs(back.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), back));
  Node node;
  node.local = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0), glm::dvec4(position, 1));
  light.node = scene.nodes.add(node);
  scene.lights.add(light);
}

void addLight(Scene& scene, LightKind kind, float intensity, dvec3 position, dvec3 direction) {
  Light light;
  light.kind = kind;
  light.intensity = intensity;
  addLight(scene, light, position, direction);
}

dvec3 Picture::at(int x, int y) const {
  const std::size_t i = (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4;
  if (image.type == PixelType::F32) return {image.f32()[i], image.f32()[i + 1], image.f32()[i + 2]};
  return dvec3(image.u8()[i], image.u8()[i + 1], image.u8()[i + 2]) / 255.0;
}

Result<Picture> draw(Studio& studio, const Scene& scene, std::span<const View> views, glm::ivec2 size, RenderRequest request, const Quality& quality) {
  request.output = quality.exposureEv ? Output::Display : Output::Linear;
  request.countNonfinite = true;
  auto target = OffscreenTarget::create(studio.gl, size, request.output);
  if (!target) return fail(target.error());
  auto stats = studio.renderer.render(scene, views, (*target)->target(), quality, request);
  studio.renderer.release(scene);
  if (!stats) return fail(stats.error());
  if (!stats->glErrors.empty()) return fail("OpenGL", stats->glErrors.front());
  auto image = (*target)->read();
  if (!image) return fail(image.error());
  Picture p{std::move(*image), stats->nonfinitePixels};
  if (p.image.type == PixelType::F32)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const dvec3 c = p.at(x, y);
        p.nonfinite += !(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z));
      }
  return p;
}

double brightest(const Picture& picture) {
  double most = 0;
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      for (int c = 0; c < 3; ++c)
        if (const double v = picture.at(x, y)[c]; !(v <= most)) most = v;
  return most;
}

double largestShare(const Picture& picture, const Picture& other) {
  double largest = 0;
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double p = picture.at(x, y)[c], q = other.at(x, y)[c];
        if (p == q) continue;
        if (const double share = std::abs(p - q) / std::max(q, 1e-12); !(share <= largest)) largest = share;
      }
  return largest;
}

Ray rayThrough(const View& view, glm::ivec2 size, double x, double y) {
  const double u = 2 * x / size.x - 1, v = 1 - 2 * y / size.y, aspect = double(size.x) / size.y;
  if (view.orthographic) {
    const double h = double(view.height) / 2;
    return {view.eye + view.axes[0] * (u * h * aspect) + view.axes[1] * (v * h), -view.axes[2]};
  }
  const double t = std::tan(double(view.fovY) / 2);
  return {view.eye, glm::normalize(view.axes[0] * (u * t * aspect) + view.axes[1] * (v * t) - view.axes[2])};
}

}  // namespace burnish::stability
