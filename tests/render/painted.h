// Pictures painted straight into the light buffer by the host's callback, and developed into floats: what the effects of the picture are tested with.
#pragma once
#include <glad/gl.h>

#include "render/scenes.h"

namespace burnish::test {

/// A rectangle of one radiance; x, y from the lower left corner of the target.
struct Patch {
  int x = 0, y = 0, width = 1, height = 1;
  vec3 light{1};
};

/// EV100 at which radiance 1 is display value 1: the light buffer holds cd/m² as they are.
inline const float kUnitEv = -std::log2(1.2f);

/// Quality that shows light as it is: no tone curve, nothing metered.
inline Quality plainQuality() {
  Quality q;
  q.toneMap = ToneMap::None;
  q.exposureEv = kUnitEv;
  return q;
}

struct Easel {
  Stage stage;
  GladGLContext gl{};

  Easel() {
    static thread_local const ProcAddress* address = nullptr;
    const ProcAddress found = stage.context->procAddress();
    address = &found;
    gladLoadGLContext(&gl, [](const char* name) { return reinterpret_cast<GLADapiproc>((*address)(name)); });
    address = nullptr;
  }
  /// Draws views of a scene, with patches painted over the light, into a float target. The picture holds linear display light, 0 to 1, rows from the top.
  Picture develop(const Scene& scene, std::span<const View> views, glm::ivec2 size, const Quality& quality, const std::vector<Patch>& patches = {}, bool count = false) {
    REQUIRE(stage.context->makeCurrent());
    auto target = OffscreenTarget::create(stage.context->procAddress(), size, Output::Linear);
    REQUIRE(target);
    RenderRequest request;
    request.countNonfinite = count;
    if (!patches.empty())
      request.hostDraw = [&](const HostDraw& draw) {
        gl.Enable(GL_SCISSOR_TEST);
        for (const Patch& p : patches) {
          const int left = std::max(p.x, draw.viewport.x), low = std::max(p.y, draw.viewport.y), right = std::min(p.x + p.width, draw.viewport.x + draw.viewport.z),
                    high = std::min(p.y + p.height, draw.viewport.y + draw.viewport.w);
          if (right <= left || high <= low) continue;
          gl.Scissor(left, low, right - left, high - low);
          const float value[4] = {p.light.x, p.light.y, p.light.z, 1};
          gl.ClearBufferfv(GL_COLOR, 0, value);
        }
      };
    auto stats = stage.renderer->render(scene, views, (*target)->target(), quality, request);
    if (!stats) FAIL("render: " << stats.error().message());
    CHECK(stats->glErrors == std::vector<std::string>{});
    auto image = (*target)->read();
    REQUIRE(image);
    float* values = image->f32();
    for (std::size_t i = 0; i < image->pixelCount() * 4; ++i) values[i] = values[i] <= 0.04045f ? values[i] / 12.92f : std::pow((values[i] + 0.055f) / 1.055f, 2.4f);
    return {std::move(*image), std::move(*stats)};
  }
  Picture paint(glm::ivec2 size, const Quality& quality, const std::vector<Patch>& patches, bool count = false) {
    const View view = lookAt({0, 0, 1}, {0, 0, 0});
    return develop(Scene{}, {&view, 1}, size, quality, patches, count);
  }
};

inline dvec3 meanOf(const Picture& p) {
  dvec3 sum(0);
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x) sum += p.at(x, y);
  return sum / double(p.image.width * p.image.height);
}
inline bool finite(const Picture& p) {
  for (int y = 0; y < p.image.height; ++y)
    for (int x = 0; x < p.image.width; ++x)
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(p.at(x, y)[c])) return false;
  return true;
}

}  // namespace burnish::test
