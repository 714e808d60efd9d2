// What the program says on standard error: errors, warnings, progress.
#pragma once
#include <burnish/result.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace cli {

enum Exit : int { kOk = 0, kFailed = 1, kUsage = 2 };

/// "burnish: place: what: remedy". Returns kFailed, so that a subcommand can end with it.
int printError(const burnish::Error& error);
/// "burnish: warning: ..." for each of the first 20, then how many more there are.
void printWarnings(const std::vector<std::string>& warnings);
/// The text with control characters replaced: names come from files that nobody vouches for, and a terminal obeys them.
std::string shown(std::string_view text);
/// " (did you mean 'x'?)" when a name is close to what was typed; else empty.
std::string didYouMean(std::string_view typed, const std::vector<std::string>& names);
/// "a, b, c"
std::string listed(const std::vector<std::string>& names);

/// Tells on standard error what goes on, for whatever takes more than a second: one changing line on a terminal, plain lines elsewhere.
class Progress {
 public:
  Progress();
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void stage(std::string text);    ///< what is being done from now on
  void detail(std::string text);   ///< said beside the stage, which goes on
  void step(int done, int total, double secondsLeft = -1);  ///< how far it is; negative: how long the rest takes is not known
  void finish();                   ///< takes the line away; nothing is printed afterwards

 private:
  void watch();
  void show(std::chrono::steady_clock::time_point now);

  using Clock = std::chrono::steady_clock;
  bool terminal_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string text_, detail_;
  int done_ = 0, total_ = 0;
  double secondsLeft_ = -1;
  bool ending_ = false, lineShown_ = false;
  Clock::time_point began_ = Clock::now(), nextPlain_ = began_ + std::chrono::seconds(1);
  std::thread thread_;
};

}  // namespace cli
