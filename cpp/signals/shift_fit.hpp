#pragma once
// The shift of one signal that a balance under smooth windows asks for.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/cancel.hpp"
#include "signals/window_means.hpp"

namespace jointid::signals {

/// One stretch: a signal, the windows over which it is averaged, and which of these are used.
struct ShiftedStretch {
  Signal time;
  Signal signal;
  Signal weight;
  Middles middles;         ///< of all windows, at even strides
  std::vector<bool> kept;  ///< which of them are used
  std::int64_t stride;     ///< samples from one window to the next
  double period;           ///< [s]
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
  Eigen::VectorXd unshifted;  ///< as `shift_coefficients`; empty where the search has a reach
};

/// The signal's window means, shifted, are regressed on the columns and on their own rate of
/// change, which is taken from the fitted columns: an instrument without the signal's noise, so
/// that neither that noise nor the interpolation pulls the delay to a whole or a half sample.
/// Nothing where the rows are too few or say nothing.
std::optional<FittedShift> fit_shift(const ShiftRows& rows, const ShiftSearch& search,
                                     const base::Cancel* cancel);

/// Least squares of the signals, not shifted, on the columns.
Eigen::VectorXd shift_coefficients(const ShiftRows& rows);

}  // namespace jointid::signals
