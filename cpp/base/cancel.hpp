#pragma once
// A flag that workers read once a block, so that long work ends soon after a request.

#include <atomic>

namespace jointid::base {

/// Thrown by work that was asked to stop; unwinds through the core, never reaches a user by itself.
struct Cancelled {};

class Cancel {
 public:
  void request() { requested_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool requested() const { return requested_.load(std::memory_order_relaxed); }
  /// Called by a worker once a block.
  void check() const {
    if (requested()) throw Cancelled{};
  }

 private:
  std::atomic<bool> requested_{false};
};

}  // namespace jointid::base
