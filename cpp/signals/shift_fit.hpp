#pragma once
// The shift of one signal that a balance under smooth windows asks for.

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

/// What a signal's window means are a sum of. The first columns, `conservative` of them, have
/// nothing to do with friction; a signal `held` between samples stands for the middle of the
/// interval.
struct ShiftRows {
  std::vector<ShiftedStretch> stretches;
  Eigen::Ref<const Eigen::MatrixXd> columns;
  Eigen::Index conservative;
  bool held;
};

struct ShiftSearch {
  double reach;  ///< from the shift of least misfit up to this [s]; 0: from no shift
  bool robust;   ///< whether windows that miss by far count for less
  double least;  ///< a delay that is clearly shorter after one step is not refined [s]
};

/// A value and a standard error for the whole signal, its conservative part and friction [s], and
/// the variance that the columns leave, over that of the signal.
struct FittedShift {
  std::array<double, 2> whole;
  std::array<double, 2> conservative;
  std::array<double, 2> friction;
  double unexplained;
  /// As `leading_coefficient`, where that was a step on the way.
  std::optional<double> leading;
};

/// The signal's window means, shifted, are regressed on the columns and on their own rate of
/// change, which is taken from the fitted columns: an instrument without the signal's noise, so
/// that neither that noise nor the interpolation pulls the delay to a whole or a half sample.
/// Nothing where the rows are too few or say nothing.
std::optional<FittedShift> fit_shift(const ShiftRows& rows, const ShiftSearch& search,
                                     const base::Cancel* cancel);

/// Of the first column, in least squares of the signals, not shifted, on the columns.
double leading_coefficient(const ShiftRows& rows);

}  // namespace jointid::signals
