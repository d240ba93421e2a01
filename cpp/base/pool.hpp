#pragma once
// Threads for one call. They start when there is work and the destructor joins them, so nothing
// outlives the call (fork stays safe).

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "base/cancel.hpp"

namespace jointid::base {

/// The waiting thread calls it at least every 20 ms. It throws to end the work (Ctrl-C).
using Poll = std::function<void()>;

/// Splits index ranges over worker threads while the calling thread polls.
///
/// The calling thread never works, so that one long evaluation can be interrupted. The result of
/// `work` for an index must depend on that index only. Then the number of threads cannot change any
/// bit.
class Pool {
 public:
  /// threads = 0: one per thread of the hardware. An empty poll is allowed.
  explicit Pool(int threads, Poll poll = {});
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(wanted_); }
  /// The flag that long work checks.
  [[nodiscard]] const Cancel& cancel() const { return cancel_; }
  /// Calls the poll now (between generations); throws what the poll throws.
  void poll();
  /// Calls work(begin, end) for chunks that cover [0, count). Returns when all are done, and
  /// rethrows the first exception. chunk = 0 chooses a size; use 1 where the work differs much
  /// between indices.
  void for_each(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work,
                std::size_t chunk = 0);

 private:
  void start();
  void run();
  bool take(std::size_t& begin, std::size_t& end);

  unsigned wanted_;
  Poll poll_;
  Cancel cancel_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(std::size_t, std::size_t)>* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::size_t chunk_ = 1;
  std::size_t running_ = 0;
  bool closing_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> workers_;
};

}  // namespace jointid::base
