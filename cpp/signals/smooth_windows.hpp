#pragma once
// Smooth windows over a stretch of a recording: their weights, and the choice of the used ones.

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
constexpr std::int64_t kLeastMargin = 4;    // extra samples, so that whole vectors may be read

struct WindowRules {
  std::int64_t half;  ///< half the length of a window in samples; also the distance between windows
  std::int64_t margin;  ///< samples by which a signal may be shifted
  std::int64_t clear;   ///< least distance of a middle from a change of direction; 0: no such rule
  bool usable_only;     ///< leave out windows that touch an unusable sample
};

struct SmoothWindows {
  Eigen::VectorXd weight;  ///< weights of the samples in a window; their sum is one
  Eigen::VectorXd slope;   ///< weights that give the mean slope of a signal in the window [1/s]
  Middles used;            ///< the windows' middle samples
  /// 1 over the time between the two neighbours of a window [1/s]; 0 where one of them is omitted.
  Eigen::VectorXd between;
};

/// Even times from the first to the last sample, and the largest distance of the real times from
/// them [s].
struct EvenGrid {
  Eigen::VectorXd time;
  double apart;
};
EvenGrid even_grid(const Signal& time);

/// Throws std::invalid_argument if a window could reach beyond the stretch.
SmoothWindows smooth_windows(const EvenStretch& stretch, const WindowRules& rules);

/// Weights that give the mean curvature of a signal in a window of that half length.
Eigen::VectorXd curvature_weight(std::int64_t half, double period);

/// The shortest half length that reduces the acceleration's noise to 1e-4 of its variance. The
/// acceleration is from the velocity, or from the position if `position` is true.
std::int64_t half_length(const Signal& signal, double period, bool position);

}  // namespace jointid::signals
