#include "cost/assistant.h"

namespace burnish::cost {

Assistant::Assistant(const Bench& bench, ContextMaker open) : bench_(bench), open_(std::move(open)), thread_([this] { run(); }) {}

Assistant::~Assistant() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Assistant::begin(std::function<Result<void>(Studio&)> work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = std::move(work);
    busy_ = true;
  }
  changed_.notify_all();
}

Result<void> Assistant::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !busy_; });
  return result_;
}

void Assistant::run() {
  std::unique_ptr<Context> context;  // before the studio, whose objects live in it
  std::unique_ptr<Studio> studio;
  const auto ready = [&]() -> Result<void> {
    if (studio) return {};
    auto opened = open_();
    if (!opened) return fail(opened.error());
    if (!*opened) return fail("second context", "none was made", "return one from CostOptions::secondContext, or leave that empty");
    context = std::move(*opened);
    auto made = Studio::create(context->procAddress(), bench_);
    if (!made) return fail(made.error());
    studio = std::move(*made);
    return {};
  };
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return over_ || work_; });
    if (!work_) return;
    const auto work = std::move(work_);
    work_ = nullptr;
    lock.unlock();
    Result<void> result = ready();
    if (result) result = work(*studio);
    lock.lock();
    result_ = std::move(result);
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace burnish::cost
