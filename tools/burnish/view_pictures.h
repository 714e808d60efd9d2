// The pictures that the window shows: of one quality, or of two with what they cost and how far they are apart.
#pragma once
#include <burnish/renderer.h>

#include <array>
#include <memory>
#include <optional>

#include "view_difference.h"
#include "view_times.h"

namespace cli::viewer {

enum class Layout : std::uint8_t {
  One,    ///< quality A
  Split,  ///< A left of the divider, B right of it
  Heat,   ///< A, B, their difference, figures: four quarters
};

/// What is to be drawn. Frames of equal ones show the same picture.
struct Wanted {
  burnish::View view;
  burnish::Quality a, b;
  burnish::DebugView debugView = burnish::DebugView::Final;
  glm::ivec2 size{0};        ///< of one picture, pixels
  Layout layout = Layout::One;
  double heatScale = 0, threshold = 0.01;  ///< as differenceOf takes them
  std::uint64_t moment = 0;  ///< advances when the scene moves or its light changes
};

/// Draws through one renderer and keeps what it drew.
class Pictures {
 public:
  Pictures(burnish::ProcAddress getProcAddress, burnish::Renderer& renderer) : address_(std::move(getProcAddress)), renderer_(renderer) {}

  /// One frame. `shrink`: pixels of the window along a side of one that is drawn, 1 or more.
  burnish::Result<void> draw(const burnish::Scene& scene, const Wanted& wanted, int shrink);
  /// The pictures are of `wanted` and whole.
  [[nodiscard]] bool shows(const Wanted& wanted) const;
  /// The pictures are of `wanted`, whole, and measured often enough.
  [[nodiscard]] bool settled(const Wanted& wanted) const;
  /// Measures again.
  void measureAgain() { duel_.restart(), history_.begin(), since_ = 0; }

  /// The last picture of A (0) or B (1); framebuffer 0 and no size before there is one.
  [[nodiscard]] burnish::Target picture(int which) const;
  [[nodiscard]] burnish::Result<burnish::Image> read(int which) const;
  [[nodiscard]] const History& history() const { return history_; }
  [[nodiscard]] const Duel& duel() const { return duel_; }
  [[nodiscard]] const std::optional<Difference>& difference() const { return difference_; }
  [[nodiscard]] const burnish::FramePlan& plan() const { return plans_[0]; }
  [[nodiscard]] const burnish::FrameStats& stats() const { return stats_; }
  [[nodiscard]] const std::vector<std::string>& changed() const { return changed_; }  ///< passes that A and B do not share
  [[nodiscard]] float exposureEv() const { return exposureEv_; }  ///< EV100 that the pictures were developed with
  [[nodiscard]] double lastMs() const { return lastMs_; }         ///< wall time of the last frame, all its pictures
  [[nodiscard]] bool onCpu() const { return renderer_.capabilities().software; }
  [[nodiscard]] long long framesDrawn() const { return framesDrawn_; }
  [[nodiscard]] const Wanted& drawn() const { return drawn_; }
  [[nodiscard]] int shrink() const { return shrink_; }

 private:
  struct Slot {
    std::unique_ptr<burnish::OffscreenTarget> target;
    glm::ivec2 size{0};
  };
  /// Display pictures of A and B, linear ones of A and B.
  enum : std::size_t { kA, kB, kLinearA, kLinearB, kSlots };
  void noteChange(const Wanted& wanted, int shrink);
  burnish::Result<burnish::FrameStats> drawSlot(std::size_t slot, const burnish::Scene& scene, const burnish::View& view, const burnish::Quality& quality, burnish::RenderRequest request);
  burnish::Result<void> drawB(const burnish::Scene& scene, const burnish::FrameStats& ofA);
  burnish::Result<void> findDifference(const burnish::Scene& scene);

  burnish::ProcAddress address_;
  burnish::Renderer& renderer_;
  std::array<Slot, kSlots> slots_;
  std::array<burnish::FramePlan, 2> plans_;
  burnish::FrameStats stats_;
  std::vector<std::string> changed_;
  History history_;
  Duel duel_;
  std::optional<Difference> difference_;
  Wanted drawn_;
  int shrink_ = 0, since_ = 0;  ///< since_: frames since anything changed
  bool differenceIsNew_ = false;
  float exposureEv_ = 0;
  double lastMs_ = 0;
  long long framesDrawn_ = 0;
};

}  // namespace cli::viewer
