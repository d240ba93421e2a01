#pragma once
// Facts that hold for a whole run of samples, and so for the many short windows inside it.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "base/scans.hpp"
#include "identify/recording/recording.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::identify {

/// Whether windows have only usable intervals. Windows come in order, so one known run of usable
/// intervals serves all windows in it.
class WholeWindows {
 public:
  WholeWindows(const std::vector<std::uint8_t>& usable, std::span<const Window> windows)
      : flags_(usable.data()), last_(windows.empty() ? 0 : windows.back().end) {}

  bool operator()(const Window& window) {
    if (window.begin < from_ || window.begin > until_) {
      from_ = window.begin;
      const auto count = static_cast<std::size_t>(std::max(last_, window.end) - from_);
      const void* found = std::memchr(flags_ + from_, 0, count);
      until_ = found == nullptr ? from_ + static_cast<std::int64_t>(count)
                                : static_cast<const std::uint8_t*>(found) - flags_;
    }
    return window.end <= until_;
  }

  /// End of the known run: the next windows are whole if they end before it.
  [[nodiscard]] std::int64_t until() const { return until_; }

 private:
  const std::uint8_t* flags_;
  std::int64_t last_;
  std::int64_t from_ = 0;
  std::int64_t until_ = -1;  ///< the intervals from_ .. until_ - 1 are usable
};

/// Whether the velocity keeps one sign over a window, ends included. Windows come in order, too.
class OneSided {
 public:
  OneSided(const RecordingView::Signal& velocity, std::span<const Window> windows)
      : velocity_(velocity.data()), last_(windows.empty() ? 0 : windows.back().end) {}

  /// The sign, or 0 if it changes.
  double operator()(const Window& window) {
    if (window.begin < from_ || window.begin >= until_) {
      from_ = window.begin;
      const auto count = static_cast<std::size_t>(std::max(last_, window.end) - from_) + 1;
      until_ = from_ + static_cast<std::int64_t>(base::one_sided(velocity_ + from_, count));
    }
    if (window.end >= until_) return 0.0;
    return velocity_[window.begin] > 0.0 ? 1.0 : -1.0;
  }

 private:
  const double* velocity_;
  std::int64_t last_;
  std::int64_t from_ = 0;
  std::int64_t until_ = 0;  ///< the samples from_ .. until_ - 1 have one sign
};

}  // namespace jointid::identify
