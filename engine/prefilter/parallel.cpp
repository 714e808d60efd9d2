#include "prefilter/parallel.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <thread>
#include <vector>

namespace burnish::prefilter {

void forEachPiece(int count, int threads, const std::function<void(int piece)>& piece) {
  const int helpers = std::min(threads, count) - 1;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) piece(i);
  };
  std::vector<std::jthread> others;
  for (int i = 0; i < helpers; ++i) others.emplace_back(work);
  work();
}

int threadsFor(int wanted) { return wanted > 0 ? std::min(wanted, 256) : std::clamp(int(std::thread::hardware_concurrency()), 1, 64); }

double cpuMilliseconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) * 1e3 + double(t.tv_nsec) * 1e-6;
}

}  // namespace burnish::prefilter
