#pragma once
// Columns that can explain a signal under smooth windows. There are so many of them that a model
// error does not appear as a delay.

#include <optional>
#include <vector>

#include "signals/smooth_windows.hpp"

namespace jointid::signals {

/// Columns of a balance, in this order.
struct ColumnChoice {
  Signal cosine;  ///< cosine of the angle
  Signal sine;
  /// Adds an inertia that varies with the angle to inertia, gravity and a constant.
  bool varying;
  std::vector<Signal> own;  ///< mean rate of each
  /// Adds friction as any smooth function of the speed, which may depend on direction, angle and
  /// time.
  bool friction;
  std::vector<Signal> own_friction;  ///< mean rate of each
  /// A signal that jumps. With it, the acceleration of a sample is that of the interval before.
  /// `answer` is the response of the acceleration to half a jump.
  std::optional<Signal> jumping;
  double answer;
};

/// Means over the windows, shape windows x columns.
Eigen::MatrixXd balance_columns(const EvenStretch& stretch, const SmoothWindows& windows,
                                const ColumnChoice& choice);

/// Mean rate of a signal in each window.
Eigen::VectorXd mean_rates(const Signal& signal, const SmoothWindows& windows);

}  // namespace jointid::signals
