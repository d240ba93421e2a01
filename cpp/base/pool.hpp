#pragma once
// Threads for one call: made when there is work for them, joined by the destructor, so nothing
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

/// Called by the waiting thread at least every 20 ms; it throws to end the work (Ctrl-C).
using Poll = std::function<void()>;

/// Splits index ranges over worker threads while the calling thread polls.
///
/// The calling thread never works itself: that is what lets one long evaluation be interrupted.
/// `work` must give a result per index that depends on the index only; then the number of threads
/// cannot change any bit.
class Pool {
 public:
  /// threads = 0: as many as the hardware has. An empty poll is allowed.
  explicit Pool(int threads, Poll poll = {});
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(wanted_); }
  /// Work hands this to whatever runs long.
  [[nodiscard]] const Cancel& cancel() const { return cancel_; }
  /// Ask the poll now (between generations); throws what the poll throws.
  void poll();
  /// Calls work(begin, end) for chunks that cover [0, count); returns when all are done; rethrows
  /// the first exception. A chunk of 0 is chosen; give 1 where indices differ much in their work.
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
