#include "bind/beside.hpp"

#include <system_error>

namespace jointid::bind {

Beside::Run::~Run() {
  if (thread.joinable()) thread.join();
}

bool Beside::has_room(std::int64_t samples, int threads) {
  return samples < kManySamples && base::processors(threads) > 1;
}

void Beside::begin(std::int64_t samples, int threads) {
  run_ = std::make_unique<Run>();
  const auto run = [task = task_.get(), own = run_.get()](base::Pool* pool) {
    try {
      task->run(pool);
    } catch (...) {
      own->failure = own->later = std::current_exception();
    }
    if (!task->goes_on()) return;
    {
      const std::lock_guard lock(own->mutex);
      own->done = true;
    }
    own->wake.notify_all();
    try {
      if (own->failure) return;
      task->go_on();
    } catch (...) {
      own->later = std::current_exception();
    }
  };
  if (has_room(samples, threads)) {
    try {
      run_->thread = std::thread(run, nullptr);
      return;
    } catch (const std::system_error&) {  // none is left
    }
  }
  {
    const py::gil_scoped_release nogil;
    with_pool(samples, threads, run);
  }
  if (samples >= kManySamples && run_->failure) std::rethrow_exception(run_->failure);
}

py::object Beside::result() {
  if (run_->thread.joinable()) {
    const py::gil_scoped_release nogil;
    if (task_->goes_on()) {
      std::unique_lock lock(run_->mutex);
      run_->wake.wait(lock, [this] { return run_->done; });
    } else {
      run_->thread.join();
    }
  }
  if (run_->failure) std::rethrow_exception(run_->failure);
  if (!handed_) handed_ = task_->found();
  return handed_;
}

py::object Beside::further() {
  result();  // which it may need for as long as it runs
  if (run_->thread.joinable()) {
    const py::gil_scoped_release nogil;
    run_->thread.join();
  }
  if (run_->later) std::rethrow_exception(run_->later);
  if (!handed_further_) handed_further_ = task_->found_further();
  return handed_further_;
}

}  // namespace jointid::bind
