// A second thread with a context and a renderer of its own.
#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "cost/studio.h"

namespace burnish::cost {

class Assistant {
 public:
  /// The bench must outlive it. The context is opened with the first work.
  Assistant(const Bench& bench, ContextMaker open);
  /// Waits for the work.
  ~Assistant();
  Assistant(const Assistant&) = delete;
  Assistant& operator=(const Assistant&) = delete;

  /// Begins `work` on the thread; wait() before the next.
  void begin(std::function<Result<void>(Studio&)> work);
  /// Until the work is done. What it returned, or why there is no context.
  Result<void> wait();

 private:
  void run();

  const Bench& bench_;
  ContextMaker open_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Result<void>(Studio&)> work_;
  Result<void> result_;
  bool busy_ = false, over_ = false;
  std::thread thread_;  ///< last: it reads the rest
};

}  // namespace burnish::cost
