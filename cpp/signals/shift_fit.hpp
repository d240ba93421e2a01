#pragma once
// The time shift of one signal that a balance under smooth windows requires.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/cancel.hpp"
#include "signals/smooth_windows.hpp"

namespace jointid::signals {

/// One stretch: a signal, and the windows over which it is averaged.
struct ShiftedStretch {
  Signal time;
  Signal signal;
  const SmoothWindows& windows;
};

/// Model of a signal's window means. The first `conservative` columns have no friction. A sample of
/// a `held` signal represents the middle of its interval.
struct ShiftRows {
  std::vector<ShiftedStretch> stretches;
  Eigen::Ref<const Eigen::MatrixXd> columns;
  Eigen::Index conservative;
  bool held;
};

struct ShiftSearch {
  double reach;  ///< start at the shift with the smallest residual up to this one [s]; 0: start
                 ///< without a shift
  bool robust;   ///< whether windows with a large residual have less weight
  double least;  ///< a delay that is clearly shorter after one step is not refined [s]
};

/// Value and standard error [s] for the whole signal, its conservative part and friction, and the
/// variance that the columns do not explain, as a share of the signal's variance.
struct FittedShift {
  std::array<double, 2> whole;
  std::array<double, 2> conservative;
  std::array<double, 2> friction;
  double unexplained;
  /// The result of `leading_coefficient`, if the fit computed it.
  std::optional<double> leading;
};

/// Regresses the shifted window means of the signal on the columns and on their own rate of change.
/// That rate comes from the fitted columns: an instrument without the signal's noise. So neither
/// that noise nor the interpolation pulls the delay to a whole or a half sample. Nothing if the
/// rows are too few or do not determine a shift.
std::optional<FittedShift> fit_shift(const ShiftRows& rows, const ShiftSearch& search,
                                     const base::Cancel* cancel);

/// The first column's coefficient in least squares of the unshifted signals on the columns.
double leading_coefficient(const ShiftRows& rows);

}  // namespace jointid::signals
