#include "bind/beside.hpp"

#include <system_error>

namespace jointid::bind {

Beside::Joined::~Joined() {
  if (thread.joinable()) thread.join();
}

void Beside::begin(std::int64_t samples, int threads) {
  run_ = std::make_unique<Joined>();
  const auto run = [task = task_.get(), own = run_.get()](base::Pool* pool) {
    try {
      task->run(pool);
    } catch (...) {
      own->failure = std::current_exception();
    }
  };
  const bool brief = samples < kManySamples;
  if (brief && base::processors(threads) > 1) {
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
  if (!brief && run_->failure) std::rethrow_exception(run_->failure);
}

py::object Beside::result() {
  if (run_->thread.joinable()) {
    const py::gil_scoped_release nogil;
    run_->thread.join();
  }
  if (run_->failure) std::rethrow_exception(run_->failure);
  if (!handed_) handed_ = task_->found();
  return handed_;
}

}  // namespace jointid::bind
