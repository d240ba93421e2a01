#pragma once
// Smooth windows over a stretch of a recording: their weights, and which of them are used.

#include <cstdint>
#include <vector>

#include "signals/signal.hpp"
#include "signals/window_means.hpp"

namespace jointid::signals {

/// A stretch of evenly spaced samples without a gap.
struct EvenStretch {
  Signal time;
  Signal position;
  Signal velocity;
  const bool* usable;  ///< whether friction is defined at the sample
  bool derived;        ///< whether the velocity was derived from the position

  [[nodiscard]] double period() const {
    return (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  }
};

constexpr std::int64_t kLongestHalf = 200;  // samples
constexpr std::int64_t kLeastMargin = 4;    // samples, so that whole vectors may be read

struct WindowRules {
  std::int64_t half;    ///< half the length of a window, in samples: also from one to the next
  std::int64_t margin;  ///< samples that a signal may be shifted by
  std::int64_t clear;   ///< no middle is nearer to a change of direction; 0: no such rule
  bool usable_only;     ///< leave out what touches an unusable sample
};

struct SmoothWindows {
  Eigen::VectorXd weight;  ///< of the samples in a window: they sum to one
  Eigen::VectorXd slope;   ///< sums to the mean slope of a signal in the window [1/s]
  Middles used;            ///< the windows' middle samples
  /// 1 over the time between both neighbours of a window [1/s]; 0 where one of them is left out.
  Eigen::VectorXd between;
};

/// Even times from the first to the last one, and how far the times are from them at most [s].
struct EvenGrid {
  Eigen::VectorXd time;
  double apart;
};
EvenGrid even_grid(const Signal& time);

/// Throws std::invalid_argument where a window could reach beyond the stretch.
SmoothWindows smooth_windows(const EvenStretch& stretch, const WindowRules& rules);

/// Sums to the mean curvature of a signal in a window of that half length.
Eigen::VectorXd curvature_weight(std::int64_t half, double period);

/// The shortest half length that averages the acceleration's noise to 1e-4 of its variance: from
/// the velocity, or from the position where that is asked for.
std::int64_t half_length(const Signal& signal, double period, bool position);

}  // namespace jointid::signals
