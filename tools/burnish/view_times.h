// What frames took: a history for the graph, and samples of two qualities that took turns.
#pragma once
#include <burnish/plan.h>

#include <array>
#include <deque>
#include <string>
#include <vector>

namespace cli::viewer {

/// Median and quartiles of some samples.
struct Middle {
  double median = 0, low = 0, high = 0;
  int count = 0;
};
Middle middleOf(std::vector<double> samples);

/// The last frames' times, pass by pass.
class History {
 public:
  static constexpr std::size_t kFrames = 120;
  struct Frame {
    std::vector<double> ms;  ///< by index into names(); 0 where the frame had no such pass
    std::vector<std::size_t> order;  ///< its passes, as executed
    double total = 0;        ///< of the passes
    double wallMs = 0;       ///< from the call to the last pixel
    glm::ivec2 size{0};      ///< pixels that were drawn
  };
  /// `cpu`: PassTime::cpuMs counts, else gpuMs. A frame without pass times is left out.
  void add(const burnish::FrameStats& stats, bool cpu, double wallMs, glm::ivec2 size);
  [[nodiscard]] const std::deque<Frame>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }  ///< of passes, in order of their first appearance
  /// Median over the latest frames of the last one's size: of a pass, of all passes, of wall time.
  [[nodiscard]] double medianOf(std::size_t pass) const;
  [[nodiscard]] double medianTotal() const;
  [[nodiscard]] double medianWall() const;
  /// A setting changed: medians are of what follows. The graph keeps what it has.
  void begin() { begin_ = 0; }

 private:
  template <class F>
  [[nodiscard]] double median(F value) const;
  std::vector<std::string> names_;
  std::deque<Frame> frames_;
  std::size_t begin_ = 0;  ///< frames since begin()
};

/// Frames of two qualities, drawn in turns, so that drift of the machine meets both alike.
class Duel {
 public:
  static constexpr int kUnmeasured = 2;  ///< the first pairs compile and upload
  static constexpr int kPairs = 9;       ///< enough for a median with quartiles
  void restart();
  /// One more pair: A's and B's frames. `changed`: names of the passes that differ.
  void add(const burnish::FrameStats& a, const burnish::FrameStats& b, const std::vector<std::string>& changed, bool cpu);
  [[nodiscard]] bool settled() const { return int(frame_[0].size()) >= kPairs; }
  [[nodiscard]] Middle frame(int which) const { return middleOf(frame_[std::size_t(which)]); }    ///< 0: A, 1: B
  [[nodiscard]] Middle changed(int which) const { return middleOf(changed_[std::size_t(which)]); }
  /// Of each pair, B less A: the whole frame. Its quartiles say more than those of the two.
  [[nodiscard]] Middle gap() const;

 private:
  int seen_ = 0;
  std::array<std::vector<double>, 2> frame_, changed_;
};

/// Names of the passes that two plans do not share: other programs, or targets of another shape.
std::vector<std::string> changedPasses(const burnish::FramePlan& a, const burnish::FramePlan& b);

}  // namespace cli::viewer
