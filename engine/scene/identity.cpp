#include <burnish/scene.h>

#include <atomic>

namespace burnish {

Identity::Identity() {
  static std::atomic<std::uint64_t> next{1};
  value_ = next.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace burnish
