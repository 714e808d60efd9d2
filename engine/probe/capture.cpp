// A capture is one call of the renderer: six views in one float target, read back once.
#include "probe/capture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace burnish::probe {
namespace {

class RendererCapture final : public Capture {
 public:
  RendererCapture(ProcAddress address, Scene scene, const Quality& quality) : address_(std::move(address)), scene_(std::move(scene)), quality_(captureQuality(quality)), near_(captureNear(scene_)) {
    // The disc is a directional light's: in a capture it would light once more. What lights is captured whether it is shown or not.
    scene_.environment.sun.reset();
    scene_.environment.background = true;
  }

  Result<void> start() {
    auto made = Renderer::create(address_, {.hostState = HostState::Declared, .linkOnDemand = true});
    if (!made) return fail(made.error());
    renderer_ = std::move(*made);
    return {};
  }

  void setProbes(ProbeSet probes) override {
    // The renderer compares revisions: each set that comes here is another one.
    probes.revision = ++revision_;
    scene_.probes = std::move(probes);
  }

  Result<CubeLevel> radiance(glm::dvec3 point, int size) override {
    auto target = targetOf(size);
    if (!target) return fail(target.error());
    const std::array<View, 6> views = faceViews(point, near_, size);
    RenderRequest request;
    request.output = Output::Linear;
    if (auto drawn = renderer_->render(scene_, views, (*target)->target(), quality_, request); !drawn) return fail(drawn.error());
    takeWarnings();
    auto picture = (*target)->read();
    if (!picture) return fail(picture.error());
    return facesOf(*picture, size, mended_);
  }

 private:
  /// One is kept for each size in use: a bake has two.
  Result<OffscreenTarget*> targetOf(int size) {
    if (size < 1 || size > 4096) return fail("capture", fmt::format("faces of {} pixels", size), "ask for 1 to 4096");
    std::unique_ptr<OffscreenTarget>& target = targets_[size];
    if (!target) {
      auto made = OffscreenTarget::create(address_, {3 * size, 2 * size}, Output::Linear);
      if (!made) return fail(made.error());
      target = std::move(*made);
    }
    return target.get();
  }

  void takeWarnings() {
    const std::vector<Warning>& all = renderer_->report().warnings();
    for (; taken_ < all.size(); ++taken_) report_.warn(all[taken_].place, all[taken_].what);
  }

  ProcAddress address_;
  Scene scene_;
  Quality quality_;
  float near_;
  std::unique_ptr<Renderer> renderer_;
  std::map<int, std::unique_ptr<OffscreenTarget>> targets_;
  std::uint64_t revision_ = 0;
  std::size_t taken_ = 0;
};

}  // namespace

CubeLevel facesOf(const Image& picture, int size, std::size_t& mended) {
  CubeLevel cube{size, 0, std::vector<float>(std::size_t(size) * std::size_t(size) * 18)};
  mended = 0;
  float* out = cube.texels.data();
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y) {
      const int row = picture.height - 1 - (face / 3 * size + y);
      const float* in = picture.f32() + (std::size_t(row) * std::size_t(picture.width) + std::size_t(face % 3 * size)) * 4;
      for (int x = 0; x < size; ++x, in += 4)
        for (int c = 0; c < 3; ++c, ++out) {
          const bool good = in[c] >= 0 && std::isfinite(in[c]);
          *out = good ? in[c] : 0;
          mended += !good;
        }
    }
  return cube;
}

Result<std::unique_ptr<Capture>> Capture::create(const ProcAddress& getProcAddress, Scene scene, const Quality& quality) {
  auto capture = std::make_unique<RendererCapture>(getProcAddress, std::move(scene), quality);
  if (auto started = capture->start(); !started) return fail(started.error());
  return std::unique_ptr<Capture>(std::move(capture));
}

}  // namespace burnish::probe
