#pragma once
// A recording as Python passes it: views of its arrays, which are kept alive, and the mask, which
// is computed on first use.

#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/pool.hpp"
#include "bind/bind.hpp"
#include "identify/recording/masked_recording.hpp"
#include "signals/signal.hpp"

namespace jointid::bind {

/// With fewer samples a pool costs more than it saves, and Ctrl-C acts soon enough without it.
constexpr std::int64_t kManySamples = 200000;

/// Calls work with a pool that checks for Ctrl-C if there are many samples, otherwise with null.
template <class Work>
auto with_pool(std::int64_t samples, int threads, Work work) {
  if (samples < kManySamples) return work(static_cast<base::Pool*>(nullptr));
  base::Pool pool(threads, SignalPoll{});
  return work(&pool);
}

inline signals::Signal signal_of(
    const py::array_t<double, py::array::c_style | py::array::forcecast>& array) {
  return {array.data(), static_cast<Eigen::Index>(array.size())};
}

class SharedRecording {
 public:
  using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

  SharedRecording(std::vector<Array> signals, identify::Hold hold, std::vector<std::int64_t> gaps,
                  double min_speed = 0.0, std::vector<std::int64_t> doubtful = {},
                  std::vector<std::pair<std::string, Array>> own = {});
  [[nodiscard]] const identify::RecordingView& view() const { return view_; }
  [[nodiscard]] std::int64_t samples() const { return view_.samples(); }
  /// Computed once for each choice. Call it without the GIL.
  [[nodiscard]] std::shared_ptr<const identify::MaskedRecording> masked(bool mask_standstill,
                                                                        base::Pool* pool);

 private:
  std::vector<Array> signals_;
  std::vector<std::pair<std::string, Array>> own_;
  identify::RecordingView view_;
  std::mutex mutex_;
  std::array<std::shared_ptr<const identify::MaskedRecording>, 2> masked_;
};

}  // namespace jointid::bind
