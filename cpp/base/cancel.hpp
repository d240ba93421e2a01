#pragma once
// A flag that workers read once per block, so that long work ends soon after a request.

#include <atomic>

namespace jointid::base {

/// Thrown by work that must stop. It unwinds through the core and never reaches a user directly.
struct Cancelled {};

class Cancel {
 public:
  void request() { requested_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool requested() const { return requested_.load(std::memory_order_relaxed); }
  /// A worker calls this once per block.
  void check() const {
    if (requested()) throw Cancelled{};
  }

 private:
  std::atomic<bool> requested_{false};
};

}  // namespace jointid::base
