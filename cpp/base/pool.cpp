#include "base/pool.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/input_error.hpp"

namespace jointid::base {

namespace {

unsigned checked(int threads) {
  if (threads < 0 || threads > 1024) {
    throw InputError("must be 0 (all) to 1024", "threads", as_value(threads));
  }
  return threads > 0 ? static_cast<unsigned>(threads)
                     : std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace

Pool::Pool(int threads, Poll poll) : wanted_(checked(threads)), poll_(std::move(poll)) {}

void Pool::start() {
  workers_.reserve(wanted_);
  while (workers_.size() < wanted_) workers_.emplace_back([this] { run(); });
}

Pool::~Pool() {
  cancel_.request();
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void Pool::poll() {
  if (poll_) poll_();
}

bool Pool::take(std::size_t& begin, std::size_t& end) {
  if (work_ == nullptr || next_ >= count_) return false;
  begin = next_;
  end = std::min(count_, begin + chunk_);
  next_ = end;
  return true;
}

void Pool::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    std::size_t begin = 0;
    std::size_t end = 0;
    wake_.wait(lock, [&] { return closing_ || (work_ != nullptr && next_ < count_); });
    if (closing_) return;
    while (take(begin, end)) {
      ++running_;
      const auto& work = *work_;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work(begin, end);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      --running_;
      if (failure) {
        if (!failure_) failure_ = failure;
        next_ = count_;
      }
    }
    if (running_ == 0) done_.notify_all();
  }
}

void Pool::for_each(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work,
                    std::size_t chunk) {
  if (count == 0) return;
  start();
  std::unique_lock lock(mutex_);
  work_ = &work;
  next_ = 0;
  count_ = count;
  chunk_ = chunk > 0 ? chunk : std::max<std::size_t>(1, count / (10 * workers_.size()));
  failure_ = nullptr;
  wake_.notify_all();
  const auto finished = [&] { return next_ >= count_ && running_ == 0; };
  std::exception_ptr interruption;
  while (!done_.wait_for(lock, std::chrono::milliseconds(20), finished)) {
    if (!poll_ || interruption) continue;
    lock.unlock();
    try {
      poll_();
    } catch (...) {
      interruption = std::current_exception();
    }
    lock.lock();
    if (interruption) {
      next_ = count_;
      cancel_.request();
    }
  }
  work_ = nullptr;
  if (interruption) std::rethrow_exception(interruption);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace jointid::base
