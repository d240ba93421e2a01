#pragma once
// Work of the core beside the interpreter: one call begins it, another one fetches what it found.

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
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
  /// The same, and goes on with further(*found), where work(pool) has found a pointer to that.
  template <class Work, class Further>
  Beside(std::int64_t samples, int threads, Work work, Further further)
      : task_(std::make_unique<Twice<Work, Further>>(std::move(work), std::move(further))) {
    begin(samples, threads);
  }
  Beside(Beside&&) noexcept = default;

  /// Whether such work would get a thread of its own.
  static bool has_room(std::int64_t samples, int threads);

  py::object result();
  /// What the work found when it went on.
  py::object further();

 private:
  struct Task {
    Task() = default;
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;
    virtual ~Task() = default;
    virtual void run(base::Pool* pool) = 0;
    virtual py::object found() = 0;
    [[nodiscard]] virtual bool goes_on() const { return false; }
    virtual void go_on() {}
    virtual py::object found_further() { return py::none(); }
  };

  template <class Work>
  struct Of : Task {
    explicit Of(Work task) : work(std::move(task)) {}
    void run(base::Pool* pool) override { kept = work(pool); }
    py::object found() override { return py::cast(std::move(*kept)); }
    Work work;
    std::optional<decltype(std::declval<Work>()(nullptr))> kept;
  };

  template <class Work, class Further>
  struct Twice final : Of<Work> {
    Twice(Work task, Further next) : Of<Work>(std::move(task)), further(std::move(next)) {}
    void run(base::Pool* pool) override {
      Of<Work>::run(pool);
      first = this->kept->get();
    }
    [[nodiscard]] bool goes_on() const override { return true; }
    void go_on() override { also = further(*first); }
    py::object found_further() override { return py::cast(std::move(*also)); }
    Further further;
    decltype(std::declval<Work>()(nullptr).get()) first = nullptr;  ///< Python may own it by then
    std::optional<decltype(further(*first))> also;
  };

  /// Joins before the task goes.
  struct Run {
    std::thread thread;
    std::mutex mutex;
    std::condition_variable wake;
    bool done = false;  ///< with what is fetched first
    std::exception_ptr failure;
    std::exception_ptr later;
    ~Run();
  };

  void begin(std::int64_t samples, int threads);

  std::unique_ptr<Task> task_;
  py::object handed_;  ///< as Python has it; the run may still read it
  py::object handed_further_;
  std::unique_ptr<Run> run_;
};

}  // namespace jointid::bind
