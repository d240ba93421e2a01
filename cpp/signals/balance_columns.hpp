#pragma once
// What a signal may be a sum of, under smooth windows: wide enough that a model error is no delay.

#include <optional>
#include <vector>

#include "signals/smooth_windows.hpp"

namespace jointid::signals {

/// Which columns a balance has, in this order.
struct ColumnChoice {
  Signal cosine;  ///< of the angle
  Signal sine;
  /// Besides inertia, gravity and a constant: an inertia that varies with the angle.
  bool varying;
  std::vector<Signal> own;  ///< of each the mean rate
  /// Friction as any smooth function of the speed that may depend on direction, angle and time.
  bool friction;
  std::vector<Signal> own_friction;  ///< of each the mean rate
  /// What jumps, by which the acceleration of a sample is that of the interval before it, and the
  /// acceleration's answer to half of a jump.
  std::optional<Signal> jumping;
  double answer;
};

/// Means over the windows: windows x columns.
Eigen::MatrixXd balance_columns(const EvenStretch& stretch, const SmoothWindows& windows,
                                const ColumnChoice& choice);

/// Mean rate of a signal in each window.
Eigen::VectorXd mean_rates(const Signal& signal, const SmoothWindows& windows);

}  // namespace jointid::signals
