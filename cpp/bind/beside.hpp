#pragma once
// Work of the core beside the interpreter: one call begins it, another one fetches what it found.

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "bind/recording.hpp"

namespace jointid::bind {

/// What Python holds of work that was begun. When it is let go of, it waits for the end.
class Beside {
 public:
  /// Begins work(pool). Brief work that may have a second processor gets a thread of its own, so
  /// that it does not wait for the interpreter; other work, which Ctrl-C has to end, is done at
  /// once. What the work holds is let go of where the interpreter is held.
  template <class Work>
  Beside(std::int64_t samples, int threads, Work work)
      : task_(std::make_unique<Of<Work>>(std::move(work))) {
    begin(samples, threads);
  }
  Beside(Beside&&) noexcept = default;

  py::object result();

 private:
  struct Task {
    Task() = default;
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;
    virtual ~Task() = default;
    virtual void run(base::Pool* pool) = 0;
    virtual py::object found() = 0;
  };

  template <class Work>
  struct Of final : Task {
    explicit Of(Work task) : work(std::move(task)) {}
    void run(base::Pool* pool) override { kept = work(pool); }
    py::object found() override { return py::cast(std::move(*kept)); }
    Work work;
    std::optional<decltype(std::declval<Work>()(nullptr))> kept;
  };

  /// Joins before the task goes.
  struct Joined {
    std::thread thread;
    std::exception_ptr failure;
    ~Joined();
  };

  void begin(std::int64_t samples, int threads);

  std::unique_ptr<Task> task_;
  std::unique_ptr<Joined> run_;
  py::object handed_;  ///< as Python has it
};

}  // namespace jointid::bind
