// What the render tests share: a context with a renderer, pictures as values, a few meshes, and pixel rays in double.
#pragma once
#include <burnish/renderer.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "gpu/gl_fixture.h"

namespace burnish::test {

using glm::dvec3;
using glm::vec3;
using glm::vec4;

inline constexpr double kPi = std::numbers::pi;

struct Picture {
  Image image;
  FrameStats stats;
  /// Pixel from the top left corner: radiance (F32), or 0..1 (U8).
  [[nodiscard]] dvec3 at(int x, int y) const {
    const std::size_t i = (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4;
    if (image.type == PixelType::F32) return {image.f32()[i], image.f32()[i + 1], image.f32()[i + 2]};
    return dvec3(image.u8()[i], image.u8()[i + 1], image.u8()[i + 2]) / 255.0;
  }
};

/// Context and renderer. GL errors of any frame fail the test.
struct Stage {
  std::unique_ptr<Context> context = openContext();
  std::unique_ptr<Renderer> renderer;

  explicit Stage(RendererOptions options = {}) {
    options.debugOutput = true;
    options.linkOnDemand = true;  // many qualities, few pictures of each; tests of programs and plans have renderers of their own
    auto made = Renderer::create(context->procAddress(), options);
    if (!made) FAIL("no renderer: " << made.error().message());
    renderer = std::move(*made);
  }
  ~Stage() {
    if (context->makeCurrent()) renderer.reset();
  }
  /// The renderer computes on the CPU: floats round as IEEE 754 has it, and vertices stay where they are.
  [[nodiscard]] bool software() const { return renderer->capabilities().software; }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;
  Result<Picture> tryDraw(const Scene& scene, std::span<const View> views, glm::ivec2 size, const Quality& quality, const RenderRequest& request) {
    // Another stage may have come and gone.
    if (auto current = context->makeCurrent(); !current) return fail(current.error());
    auto target = OffscreenTarget::create(context->procAddress(), size, request.output);
    if (!target) return fail(target.error());
    auto stats = renderer->render(scene, views, (*target)->target(), quality, request);
    if (!stats) return fail(stats.error());
    auto image = (*target)->read();
    if (!image) return fail(image.error());
    return Picture{std::move(*image), std::move(*stats)};
  }
  Picture draw(const Scene& scene, std::span<const View> views, glm::ivec2 size, const Quality& quality, const RenderRequest& request) {
    auto picture = tryDraw(scene, views, size, quality, request);
    if (!picture) FAIL("render: " << picture.error().message());
    CHECK(picture->stats.glErrors == std::vector<std::string>{});
    return std::move(*picture);
  }
  /// Linear radiance in cd/m².
  Picture linear(const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality = {}) {
    RenderRequest request;
    request.output = Output::Linear;
    return draw(scene, {&view, 1}, size, quality, request);
  }
  Picture display(const Scene& scene, const View& view, glm::ivec2 size, const Quality& quality = {}) { return draw(scene, {&view, 1}, size, quality, {}); }
};

/// A rectangle around `center` spanned by the half-vectors u and v; faces u × v.
inline Mesh quad(vec3 center, vec3 u, vec3 v) {
  Mesh m;
  m.positions = {center - u - v, center + u - v, center + u + v, center - u + v};
  m.normals.assign(4, glm::normalize(glm::cross(u, v)));
  m.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  m.indices = {0, 1, 2, 0, 2, 3};
  return m;
}

inline Mesh sphere(float radius, std::uint32_t rings, std::uint32_t columns) {
  Mesh m;
  for (std::uint32_t r = 0; r <= rings; ++r)
    for (std::uint32_t c = 0; c <= columns; ++c) {
      const double t = kPi * r / rings, p = 2 * kPi * c / columns;
      const dvec3 n(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
      m.positions.push_back(vec3(n * double(radius)));
      m.normals.push_back(vec3(n));
      m.uv0.emplace_back(float(c) / float(columns), float(r) / float(rings));
    }
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t c = 0; c < columns; ++c) {
      const std::uint32_t a = r * (columns + 1) + c, b = a + columns + 1;
      m.indices.insert(m.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  return m;
}

/// Outward faces of an axis-aligned box; `inside`: seen from within.
inline Mesh box(vec3 low, vec3 high, bool inside = false) {
  Mesh m;
  const vec3 c = (low + high) * 0.5f, h = (high - low) * 0.5f;
  for (int axis = 0; axis < 3; ++axis)
    for (float side : {-1.0f, 1.0f}) {
      vec3 n(0), u(0), v(0);
      n[axis] = side * h[axis];
      u[(axis + 1) % 3] = h[(axis + 1) % 3];
      v[(axis + 2) % 3] = h[(axis + 2) % 3];
      if ((side < 0) != inside) std::swap(u, v);
      const Mesh q = quad(c + n, u, v);
      const std::uint32_t base = std::uint32_t(m.positions.size());
      m.positions.insert(m.positions.end(), q.positions.begin(), q.positions.end());
      m.normals.insert(m.normals.end(), q.normals.begin(), q.normals.end());
      m.uv0.insert(m.uv0.end(), q.uv0.begin(), q.uv0.end());
      for (std::uint32_t i : q.indices) m.indices.push_back(base + i);
    }
  return m;
}

inline Id<Node> addNode(Scene& scene, const glm::dmat4& local = glm::dmat4(1), Id<Node> parent = {}) {
  Node node;
  node.parent = parent;
  node.local = local;
  return scene.nodes.add(node);
}
inline glm::dmat4 translation(dvec3 t) {
  glm::dmat4 m(1);
  m[3] = glm::dvec4(t, 1);
  return m;
}

inline Id<Instance> place(Scene& scene, Mesh mesh, const Material& material, const glm::dmat4& local = glm::dmat4(1)) {
  Instance instance;
  instance.mesh = scene.meshes.add(std::move(mesh));
  instance.material = scene.materials.add(material);
  instance.node = addNode(scene, local);
  return scene.instances.add(instance);
}

/// Stands at `position` and shines along `direction` (unit length not needed).
inline Id<Light> addLight(Scene& scene, Light light, dvec3 position, dvec3 direction = {0, 0, -1}) {
  const dvec3 back = -glm::normalize(direction), side = std::abs(back.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 right = glm::normalize(glm::cross(side, back));
  glm::dmat4 m(1);
  m[0] = glm::dvec4(right, 0);
  m[1] = glm::dvec4(glm::cross(back, right), 0);
  m[2] = glm::dvec4(back, 0);
  m[3] = glm::dvec4(position, 1);
  light.node = addNode(scene, m);
  return scene.lights.add(light);
}
inline Light light(LightKind kind, vec3 color, float intensity, float range = 0) {
  Light l;
  l.kind = kind;
  l.color = color;
  l.intensity = intensity;
  l.range = range;
  return l;
}

struct Ray {
  dvec3 origin, direction;  ///< direction: unit length
};
/// The ray through a point of the picture (pixels from the top left corner; centres at .5) of a view that fills it.
inline Ray rayThrough(const View& view, glm::ivec2 size, double x, double y) {
  const double u = 2 * x / size.x - 1, v = 1 - 2 * y / size.y, aspect = double(size.x) / size.y;
  if (view.orthographic) {
    const double h = view.height / 2.0;
    return {view.eye + view.axes[0] * (u * h * aspect) + view.axes[1] * (v * h), -view.axes[2]};
  }
  const double t = std::tan(double(view.fovY) / 2);
  return {view.eye, glm::normalize(view.axes[0] * (u * t * aspect) + view.axes[1] * (v * t) - view.axes[2])};
}

/// Share of values within a bound and the largest of all.
struct Errors {
  double largest = 0;
  std::size_t count = 0, within = 0;
  void add(double error, double bound) {
    ++count;
    within += error <= bound;
    if (!(error <= largest)) largest = error;  // NaN stays
  }
  [[nodiscard]] double share() const { return count ? double(within) / double(count) : 0; }
};

/// The same bytes. (Catch would print them all.)
inline bool same(const Picture& a, const Picture& b) { return a.image.width == b.image.width && a.image.height == b.image.height && a.image.data == b.image.data; }

inline Errors difference(const Picture& a, const Picture& b, double bound) {
  Errors e;
  REQUIRE(a.image.width == b.image.width);
  REQUIRE(a.image.height == b.image.height);
  for (int y = 0; y < a.image.height; ++y)
    for (int x = 0; x < a.image.width; ++x) {
      const dvec3 d = glm::abs(a.at(x, y) - b.at(x, y));
      e.add(std::max({d.x, d.y, d.z}), bound);
    }
  return e;
}

}  // namespace burnish::test
