#include "messages.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cli {

int printError(const burnish::Error& error) {
  fmt::print(stderr, "burnish: {}\n", shown(error.message()));
  return kFailed;
}

void printWarnings(const std::vector<std::string>& warnings) {
  constexpr std::size_t kMost = 20;
  for (std::size_t i = 0; i < std::min(warnings.size(), kMost); ++i)
    fmt::print(stderr, "burnish: warning: {}\n", shown(warnings[i]));
  if (warnings.size() > kMost) fmt::print(stderr, "burnish: warning: and {} more\n", warnings.size() - kMost);
}

std::string shown(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return result;
}

namespace {
// Levenshtein distance, one row at a time.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}
/// "42 s", "7 min", "2 h 05 min"
std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const auto minutes = std::lround(seconds / 60);
  return minutes < 100 ? fmt::format("{} min", minutes) : fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

}  // namespace

std::string didYouMean(std::string_view typed, const std::vector<std::string>& names) {
  if (typed.size() > 100) return {};
  const std::string* best = nullptr;
  std::size_t least = std::max<std::size_t>(2, typed.size() / 3) + 1;
  for (const std::string& name : names)
    if (const std::size_t d = distance(typed, name); d < least) least = d, best = &name;
  return best ? fmt::format(" (did you mean '{}'?)", *best) : std::string();
}

std::string listed(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void Progress::stage(std::string text) {
  const std::lock_guard lock(mutex_);
  text_ = shown(text);
  detail_.clear();
  done_ = total_ = 0;
  secondsLeft_ = -1;
  began_ = Clock::now();
  nextPlain_ = began_ + std::chrono::seconds(1);
  ending_ = false;
  if (!thread_.joinable()) thread_ = std::thread([this] { watch(); });
}

void Progress::detail(std::string text) {
  const std::lock_guard lock(mutex_);
  detail_ = " (" + shown(text) + ")";
}

void Progress::step(int done, int total, double secondsLeft) {
  const std::lock_guard lock(mutex_);
  done_ = done;
  total_ = total;
  secondsLeft_ = secondsLeft;
}

void Progress::finish() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Progress::watch() {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, std::chrono::milliseconds(200), [this] { return ending_; })) show(Clock::now());
  if (lineShown_) fmt::print(stderr, "\r\x1b[K");
  lineShown_ = false;
}

void Progress::show(Clock::time_point now) {
  const double seconds = std::chrono::duration<double>(now - began_).count();
  if (seconds < 1) return;
  const std::string count = total_ > 0 ? fmt::format(" {}/{}", done_, total_) : std::string(), left = secondsLeft_ >= 0 ? ", about " + duration(secondsLeft_) + " left" : std::string();
  if (terminal_) {
    fmt::print(stderr, "\r\x1b[K{}{}{} {:.0f} s{}", text_, detail_, count, seconds, left);
    std::fflush(stderr);
    lineShown_ = true;
  } else if (now >= nextPlain_) {
    fmt::print(stderr, "burnish: {}{}{} ({:.0f} s{})\n", text_, detail_, count, seconds, left);
    nextPlain_ = now + std::chrono::seconds(10);
  }
}

}  // namespace cli
