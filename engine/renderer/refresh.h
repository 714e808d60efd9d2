// A probe that is captured and filtered again while pictures are drawn, a piece at a time.
#pragma once
#include "gpu_scene/cube_filter.h"
#include "renderer/impl.h"

namespace burnish {

struct ProbeRefresher {
  explicit ProbeRefresher(gl::Device& d) : device(d) {}
  ~ProbeRefresher() { forgetFence(); }
  ProbeRefresher(const ProbeRefresher&) = delete;
  ProbeRefresher& operator=(const ProbeRefresher&) = delete;

  /// What is at work.
  struct Work {
    std::uint64_t scene = 0, revision = 0;
    std::size_t probe = 0;
    friend bool operator==(const Work&, const Work&) = default;
  };
  /// Textures for faces of that size, and a filter for that lobe.
  Result<void> prepare(gl::ProgramCache& programs, int size, int levels, ReflectionLobe wanted);
  void forgetFence() {
    if (fence) device.gl.DeleteSync(fence);
    fence = nullptr;
  }

  gl::Device& device;
  std::unique_ptr<Series> series;
  gl::Texture source, target;  ///< captured; filtered
  std::array<gl::Framebuffer, 6> faces;
  std::unique_ptr<gpu_scene::CubeFilter> filter;
  ReflectionLobe lobe = ReflectionLobe::BlinnPhong;
  std::optional<Work> work;
  int drawn = 0;         ///< faces
  GLsync fence = nullptr;  ///< after the last slice
};

}  // namespace burnish
