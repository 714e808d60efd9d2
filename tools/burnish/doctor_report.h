// What the doctor found: the machine, and of each backend its capabilities, a trial frame and the hard cases.
#pragma once
#include <burnish/measure.h>

#include <optional>

#include "output.h"

namespace cli {

struct MachineReport {
  std::string system, processor;  ///< "Debian GNU/Linux 12, Linux 6.1", "AMD EPYC"
  int threads = 0;
};
MachineReport lookAtMachine();

/// A small frame, drawn with each way of timing.
struct TrialFrame {
  std::string error;     ///< empty: it was drawn
  int programs = 0;      ///< linked for it
  double linkMs = 0;     ///< wall time of all of them
  double frameMs = 0;    ///< wall time of a frame, finished, median
  std::optional<double> queryMs;  ///< sum of its passes by timer queries; none: none arrived
  double finishedMs = 0;          ///< the same with a glFinish between passes (--profile)
  std::uint64_t nonfinitePixels = 0;
  std::vector<std::string> glErrors;
};
TrialFrame tryFrame(const burnish::ProcAddress& getProcAddress);

struct BackendReport {
  std::string name;
  bool usable = false, casesRun = false;
  std::string error;  ///< why not
  burnish::Capabilities capabilities;
  TrialFrame trial;
  std::vector<burnish::StabilityCase> cases;
  [[nodiscard]] std::size_t failed() const;  ///< hard cases, and a trial frame that could not be drawn
};

void print(const MachineReport& machine);
void print(const BackendReport& report, bool extensions);
/// What to do about what is wrong; nothing where nothing is.
void printRemedies(const std::vector<BackendReport>& reports, bool quick);
Json toJson(const MachineReport& machine, const std::vector<BackendReport>& reports);

}  // namespace cli
