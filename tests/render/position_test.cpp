// Position from depth (H23): what the lighting pass computes from a 32-bit reversed depth buffer, at 1 m to 100 km, near the origin and 1e6 m from it.
// A wall is rendered, the engine's depth is read bit for bit in the draw callback, and unprojected in float as shaders/interface/surface.glsl does; the exact
// point is where the pixel's ray meets the wall, in double.
#include <fmt/format.h>

#include <iostream>

#include "render/scenes.h"
#include "stability/depth_position.h"

using namespace burnish;
using namespace burnish::test;

TEST_CASE("position from depth, in millimetres") {
  GlFixture f;
  RendererOptions options;
  options.debugOutput = true;
  auto renderer = Renderer::create(f.context->procAddress(), options);
  REQUIRE(renderer);
  for (bool orthographic : {false, true})
    for (dvec3 origin : {dvec3(0), dvec3(1e6 + 0.123, 2e5, -1e6)})
      for (double distance : {1.0, 1000.0, 100000.0}) {
        INFO("distance " << distance << ", origin " << origin.x << ", orthographic " << orthographic);
        const auto found = stability::positionError(f.context->procAddress(), *f.device, **renderer, distance, origin, orthographic);
        if (!found) FAIL(found.error().message());
        const stability::PositionError& e = *found;
        std::cout << fmt::format("  {} {:>6} m, eye {:.0e} m from the origin: along the view {:.4g} mm, point {:.4g} mm ({:.2g} of the distance)\n", orthographic ? "orthographic" : "perspective ", distance,
                                 glm::length(origin), e.along, e.total, e.total / 1000 / distance);
        // Vertex, clip position, interpolated depth and the division round once each: a few 2^-24 of the distance, wherever the eye is.
        CHECK(e.total < distance * 1000 * 1e-6);
        CHECK(e.total > 0);
      }
}
