// What the renderer remembers of a sequence of pictures: how each view looked, and whether anything has changed since. Only while antialiasing over time is on.
#pragma once
#include "gpu_scene/frame.h"
#include "scene/motion.h"

namespace burnish {

class History {
 public:
  /// Before anything is looked at: compares with the frame before, and says where each view's samples lie (jitter()). `refreshes`: of probes, so far.
  void begin(const Scene& scene, const scene::Derived& derived, std::span<const View> views, const Target& target, const Quality& quality, const RenderRequest& request,
             std::uint64_t refreshes);
  [[nodiscard]] glm::dvec2 jitter(std::size_t view) const;
  [[nodiscard]] const scene::MotionTracker& motion() const { return motion_; }
  /// What the view's passes take. `pictures`: TargetPool::serial of the target that should hold the frame before.
  [[nodiscard]] gpu_scene::PastFrame past(std::size_t view, std::uint64_t pictures) const;
  /// Which of the two targets holds the frame before; the other one is written.
  [[nodiscard]] int source() const { return source_; }
  /// The view has been drawn.
  void drawn(std::size_t view, const scene::ViewFrame& frame, float preExposure);
  /// The frame is whole: `pictures` of the target that was written. `settled`: nothing waits to be uploaded.
  void end(std::uint64_t pictures, bool settled);
  /// Drops all: the next frame starts anew.
  void forget() { seen_.clear(); }

 private:
  /// What a picture is made of, but for the views. Whatever a scene is given beside its tables belongs in here: an animated picture that is taken for a still one smears.
  struct Stamp {
    std::uint64_t scene = 0, nodes = 0, meshes = 0, textures = 0, materials = 0, instances = 0, lights = 0, skins = 0, probes = 0, refreshes = 0, environment = 0;
    glm::vec3 color{0};
    float scale = 0;
    int filterSize = 0;
    double filterError = 0;
    std::array<float, 8> fog{}, sun{};
    bool background = false, hostDraws = false;
    Quality quality;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct Seen {
    View view;
    scene::ViewFrame frame;
    float preExposure = 1;
    unsigned frames = 0;  ///< since it began; 0: there is no frame before
    bool still = false;   ///< in this frame
  };
  scene::MotionTracker motion_;
  std::vector<Seen> seen_;
  Stamp stamp_;
  glm::ivec2 size_{0};
  Output output_ = Output::Display;
  bool settled_ = false;
  int source_ = 0;
  std::uint64_t pictures_ = 0;
};

}  // namespace burnish
