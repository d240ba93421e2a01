// Threads for one call: every index once, exceptions reach the caller, a poll that throws ends long
// work.

#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/pool.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

using base::Pool;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Runs until `done`, or fails after a generous deadline, so that a broken pool cannot hang CI.
template <class Done>
bool wait_for(Done done) {
  const auto start = Clock::now();
  while (!done()) {
    if (seconds_since(start) > 20.0) return false;
    std::this_thread::yield();
  }
  return true;
}

CHECK_CASE("pool: covers every index exactly once") {
  for (const int threads : {1, 2, 3, 7}) {
    Pool pool(threads);
    CHECK(pool.threads() == threads);
    for (const std::size_t count : {0, 1, 2, 9, 10, 11, 69, 70, 71, 1000, 10'007}) {
      std::vector<std::atomic<int>> visits(count);
      std::atomic<bool> inside{true};
      pool.for_each(count, [&](std::size_t begin, std::size_t end) {
        if (begin >= end || end > count) inside = false;
        for (std::size_t i = begin; i < end && i < count; ++i) ++visits[i];
      });
      CHECK(inside);
      std::size_t once = 0;
      for (const auto& visit : visits) once += visit == 1 ? 1 : 0;
      CHECK_WITH(once == count, std::to_string(threads) + " threads, " + std::to_string(count));
    }
  }
}

CHECK_CASE("pool: many short calls in a row") {
  Pool pool(3);
  std::vector<int> values(17, 0);  // plain ints: an unsynchronised read is a race
  for (int round = 0; round < 3000; ++round) {
    pool.for_each(values.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++values[i];
    });
  }
  for (const int value : values) CHECK(value == 3000);
}

CHECK_CASE("pool: work runs on other threads, all threads take part, the poll stays here") {
  std::set<std::thread::id> workers;
  std::mutex mutex;
  bool poll_elsewhere = false;
  std::atomic<int> polls{0};
  const auto here = std::this_thread::get_id();
  Pool pool(2, [&] {
    poll_elsewhere = poll_elsewhere || std::this_thread::get_id() != here;
    ++polls;
  });
  std::atomic<int> arrived{0};
  std::atomic<bool> met{true};
  pool.for_each(2, [&](std::size_t, std::size_t) {
    {
      const std::lock_guard lock(mutex);
      workers.insert(std::this_thread::get_id());
    }
    ++arrived;
    if (!wait_for([&] { return arrived == 2 && polls >= 3; })) met = false;
  });
  CHECK(met);
  CHECK(workers.size() == 2);
  CHECK(workers.count(here) == 0);
  CHECK(!poll_elsewhere);
}

CHECK_CASE("pool: an exception of the work reaches the caller, and the pool continues") {
  for (const int threads : {1, 4}) {
    Pool pool(threads);
    for (int round = 0; round < 20; ++round) {
      const std::string message = message_of<std::runtime_error>(
          [&] {
            pool.for_each(1000, [](std::size_t begin, std::size_t end) {
              if (begin <= 500 && 500 < end) throw std::runtime_error("sample 500");
            });
          },
          "for_each", __FILE__, __LINE__);
      CHECK_WITH(message == "sample 500", message);
      std::atomic<int> visits{0};
      pool.for_each(100, [&](std::size_t begin, std::size_t end) {
        visits += static_cast<int>(end - begin);
      });
      CHECK(visits == 100);
    }
    // All chunks throw at once: one exception reaches the caller, none ends in terminate().
    message_of<std::runtime_error>(
        [&] {
          pool.for_each(1000, [](std::size_t, std::size_t) { throw std::runtime_error("all"); });
        },
        "for_each", __FILE__, __LINE__);
  }
}

CHECK_CASE("pool: after a failure no further chunk starts") {
  Pool pool(1);
  int chunks = 0;
  message_of<std::runtime_error>(
      [&] {
        pool.for_each(1000, [&](std::size_t, std::size_t) {
          ++chunks;
          throw std::runtime_error("first");
        });
      },
      "for_each", __FILE__, __LINE__);
  CHECK(chunks == 1);
}

CHECK_CASE("pool: a poll that throws ends one long evaluation in well under a second") {
  for (const int threads : {1, 3}) {
    std::atomic<bool> asked{false};
    std::atomic<bool> deadline_passed{false};
    Pool pool(threads, [&] {
      asked = true;
      throw std::runtime_error("interrupted");
    });
    const auto start = Clock::now();
    const std::string message = message_of<std::runtime_error>(
        [&] {
          pool.for_each(static_cast<std::size_t>(threads), [&](std::size_t, std::size_t) {
            const bool cancelled = wait_for([&] {
              pool.cancel().check();
              return false;
            });
            if (!cancelled) deadline_passed = true;
          });
        },
        "for_each", __FILE__, __LINE__);
    CHECK(message == "interrupted");
    CHECK(asked);
    CHECK(!deadline_passed);
    CHECK_WITH(seconds_since(start) < 0.5, std::to_string(seconds_since(start)) + " s");
    // Work that reads the flag ends at once from now on; work that does not still runs.
    CHECK(pool.cancel().requested());
    std::atomic<int> visits{0};
    pool.for_each(
        10, [&](std::size_t begin, std::size_t end) { visits += static_cast<int>(end - begin); });
    CHECK(visits == 10);
  }
}

CHECK_CASE("pool: poll() passes on what the poll throws; an empty one is allowed") {
  Pool silent(1);
  silent.poll();
  Pool loud(1, [] { throw std::runtime_error("stop"); });
  CHECK(message_of<std::runtime_error>([&] { loud.poll(); }, "poll", __FILE__, __LINE__) == "stop");
}

CHECK_CASE("pool: made and destroyed without work; a bad number of threads is refused") {
  for (int round = 0; round < 50; ++round) Pool pool(4);
  CHECK(Pool(0).threads() >= 1);
  CHECK_REFUSED(Pool(-1), "threads is -1: must be 0 (all) to 1024");
  CHECK_REFUSED(Pool(1025), "1025");
}

}  // namespace
}  // namespace jointid::tests
