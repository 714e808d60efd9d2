// Position from depth (H23): what the lighting pass computes from a 32-bit reversed depth buffer, at 1 m to 100 km, near the origin and 1e6 m from it.
// A wall is rendered, the engine's depth is read bit for bit in the draw callback, and unprojected in float as shaders/interface/surface.glsl does; the exact
// point is where the pixel's ray meets the wall, in double.
#include <fmt/format.h>

#include <iostream>

#include "render/scenes.h"
#include "scene/visibility.h"

using namespace burnish;
using namespace burnish::test;

namespace {

constexpr glm::ivec2 kSize{64, 48};

struct Measured {
  double along = 0, total = 0;  ///< largest errors in mm: along the view, and of the point
};

/// The engine's own depth of a wall, from the bottom left.
std::vector<float> depthOf(GlFixture& f, const Scene& scene, const View& view) {
  std::vector<float> values(std::size_t(kSize.x * kSize.y));
  RendererOptions options;
  options.debugOutput = true;
  auto renderer = Renderer::create(f.context->procAddress(), options);
  auto target = OffscreenTarget::create(f.context->procAddress(), kSize, Output::Display);
  REQUIRE(renderer);
  REQUIRE(target);
  RenderRequest request;
  request.hostDraw = [&](const HostDraw& d) {
    // The callback's framebuffer carries the engine's depth.
    f.gl.BindFramebuffer(GL_READ_FRAMEBUFFER, d.framebuffer);
    f.gl.ReadPixels(0, 0, kSize.x, kSize.y, GL_DEPTH_COMPONENT, GL_FLOAT, values.data());
  };
  const auto done = (*renderer)->render(scene, {&view, 1}, (*target)->target(), {}, request);
  REQUIRE(done);
  CHECK(done->glErrors == std::vector<std::string>{});
  return values;
}

Measured measure(GlFixture& f, double distance, dvec3 origin, bool orthographic) {
  Scene scene;
  // A wall turned by 30 degrees, `distance` ahead on the axis.
  const double c = std::cos(0.5236), s = std::sin(0.5236);
  glm::dmat4 m(distance);
  m[0] = glm::dvec4(dvec3(c, 0, s) * distance, 0);
  m[1] = glm::dvec4(0, distance, 0, 0);
  m[2] = glm::dvec4(dvec3(-s, 0, c) * distance, 0);
  m[3] = glm::dvec4(origin + dvec3(0, 0, -distance), 1);
  place(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), Material{}, m);
  View view = lookAt(origin, origin + dvec3(0, 0, -1));
  view.near = float(std::min(0.05, distance * 0.05));
  view.orthographic = orthographic;
  view.height = float(distance);
  if (orthographic) view.far = float(distance * 2);
  const std::vector<float> depth = depthOf(f, scene, view);
  const scene::ViewFrame frame = scene::frameOf(view, kSize);
  // As fillRays and positionAt have it, in float.
  const vec3 right(frame.axes[0]), up(frame.axes[1]), forward(-frame.axes[2]);
  const vec3 rayX = vec3(glm::dvec3(frame.axes[0]) * (2 * frame.tanX / kSize.x)), rayY = vec3(glm::dvec3(frame.axes[1]) * (2 * frame.tanY / kSize.y));
  const vec3 rayOrigin = vec3(-glm::dvec3(frame.axes[0]) * frame.tanX - glm::dvec3(frame.axes[1]) * frame.tanY + (orthographic ? dvec3(0) : -frame.axes[2]));
  const float px = float(frame.depthParams.x), py = float(frame.depthParams.y);
  const dvec3 normal(-s, 0, c), on(0, 0, -distance);
  Measured worst;
  std::size_t covered = 0;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const float z = depth[std::size_t(y * kSize.x + x)];
      if (!(z > 0)) continue;
      ++covered;
      const vec3 ray = rayOrigin + rayX * (float(x) + 0.5f) + rayY * (float(y) + 0.5f);
      const vec3 p = orthographic ? ray + forward * (px - z * py) : ray * (px / (z + py));
      View local = view;
      local.eye = dvec3(0);
      const Ray r = rayThrough(local, kSize, x + 0.5, kSize.y - y - 0.5);
      const dvec3 exact = r.origin + r.direction * (glm::dot(on - r.origin, normal) / glm::dot(r.direction, normal));
      const dvec3 d = dvec3(p) - exact;
      worst.total = std::max(worst.total, glm::length(d) * 1000);
      worst.along = std::max(worst.along, std::abs(d.z) * 1000);
    }
  CHECK(covered == std::size_t(kSize.x * kSize.y));
  return worst;
}

}  // namespace

TEST_CASE("position from depth, in millimetres") {
  GlFixture f;
  for (bool orthographic : {false, true})
    for (dvec3 origin : {dvec3(0), dvec3(1e6 + 0.123, 2e5, -1e6)})
      for (double distance : {1.0, 1000.0, 100000.0}) {
        INFO("distance " << distance << ", origin " << origin.x << ", orthographic " << orthographic);
        const Measured e = measure(f, distance, origin, orthographic);
        std::cout << fmt::format("  {} {:>6} m, eye {:.0e} m from the origin: along the view {:.4g} mm, point {:.4g} mm ({:.2g} of the distance)\n", orthographic ? "orthographic" : "perspective ", distance,
                                 glm::length(origin), e.along, e.total, e.total / 1000 / distance);
        // Vertex, clip position, interpolated depth and the division round once each: a few 2^-24 of the distance, wherever the eye is.
        CHECK(e.total < distance * 1000 * 1e-6);
        CHECK(e.total > 0);
      }
}
