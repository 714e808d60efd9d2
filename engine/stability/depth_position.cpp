#include "stability/depth_position.h"

#include <cmath>
#include <vector>

#include "scene/visibility.h"
#include "stability/scenes.h"

namespace burnish::stability {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr glm::ivec2 kSize{64, 48};

/// Depth of the scene, from the bottom left; empty where nothing could be drawn.
Result<std::vector<float>> depthOf(const ProcAddress& getProcAddress, gl::Device& device, Renderer& renderer, const Scene& scene, const View& view) {
  std::vector<float> values(std::size_t(kSize.x * kSize.y));
  auto target = OffscreenTarget::create(getProcAddress, kSize, Output::Display);
  if (!target) return fail(target.error());
  RenderRequest request;
  request.hostDraw = [&](const HostDraw& d) {
    // The callback's framebuffer carries the engine's depth.
    device.gl.BindFramebuffer(GL_READ_FRAMEBUFFER, d.framebuffer);
    device.gl.ReadPixels(0, 0, kSize.x, kSize.y, GL_DEPTH_COMPONENT, GL_FLOAT, values.data());
  };
  const auto done = renderer.render(scene, {&view, 1}, (*target)->target(), {}, request);
  renderer.release(scene);
  if (!done) return fail(done.error());
  if (!done->glErrors.empty()) return fail("OpenGL", done->glErrors.front());
  return values;
}

}  // namespace

Result<PositionError> positionError(const ProcAddress& getProcAddress, gl::Device& device, Renderer& renderer, double distance, dvec3 origin, bool orthographic) {
  Scene scene;
  const double c = std::cos(0.5236), s = std::sin(0.5236);
  glm::dmat4 m(distance);
  m[0] = glm::dvec4(dvec3(c, 0, s) * distance, 0);
  m[1] = glm::dvec4(0, distance, 0, 0);
  m[2] = glm::dvec4(dvec3(-s, 0, c) * distance, 0);
  m[3] = glm::dvec4(origin + dvec3(0, 0, -distance), 1);
  View view = lookAt(origin, origin + dvec3(0, 0, -1));
  view.near = float(std::min(0.05, distance * 0.05));
  view.orthographic = orthographic;
  view.height = float(distance);
  if (orthographic) view.far = float(distance * 2);
  const dvec3 normal(-s, 0, c), on(0, 0, -distance);
  View local = view;
  local.eye = dvec3(0);
  const auto onWall = [&](double x, double y) {
    const Ray r = rayThrough(local, kSize, x, y);
    return r.origin + r.direction * (glm::dot(on - r.origin, normal) / glm::dot(r.direction, normal));
  };
  // Its corners lie where pixels meet, outside the picture: rasterizers move vertices to a grid of fractions of a pixel, and a wall that is moved is elsewhere.
  Mesh wall = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const double corners[4][2] = {{-8, kSize.y + 8.0}, {kSize.x + 8.0, kSize.y + 8.0}, {kSize.x + 8.0, -8}, {-8, -8}};
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 p = (onWall(corners[i][0], corners[i][1]) - on) / distance;
    wall.positions[i] = vec3(glm::dot(p, dvec3(c, 0, s)), p.y, 0);
  }
  place(scene, std::move(wall), Material{}, m);
  const auto depth = depthOf(getProcAddress, device, renderer, scene, view);
  if (!depth) return fail(depth.error());
  const scene::ViewFrame frame = scene::frameOf(view, kSize);
  // As fillRays and positionAt have it, in float.
  const vec3 forward(-frame.axes[2]);
  const vec3 rayX = vec3(dvec3(frame.axes[0]) * (2 * frame.tanX / kSize.x)), rayY = vec3(dvec3(frame.axes[1]) * (2 * frame.tanY / kSize.y));
  const vec3 rayOrigin = vec3(-dvec3(frame.axes[0]) * frame.tanX - dvec3(frame.axes[1]) * frame.tanY + (orthographic ? dvec3(0) : -frame.axes[2]));
  const float px = float(frame.depthParams.x), py = float(frame.depthParams.y);
  PositionError worst;
  for (int y = 0; y < kSize.y; ++y)
    for (int x = 0; x < kSize.x; ++x) {
      const float z = (*depth)[std::size_t(y * kSize.x + x)];
      if (!(z > 0)) return fail("H23", "the wall does not fill the picture");
      const vec3 ray = rayOrigin + rayX * (float(x) + 0.5f) + rayY * (float(y) + 0.5f);
      const vec3 p = orthographic ? ray + forward * (px - z * py) : ray * (px / (z + py));
      const dvec3 d = dvec3(p) - onWall(x + 0.5, kSize.y - y - 0.5);
      worst.total = std::max(worst.total, glm::length(d) * 1000);
      worst.along = std::max(worst.along, std::abs(d.z) * 1000);
    }
  return worst;
}

}  // namespace burnish::stability
