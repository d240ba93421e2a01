#pragma once
// How well time stamps and positions agree.

#include "base/cancel.hpp"
#include "signals/signal.hpp"

namespace jointid::signals {

/// Scatter of the samples' true times about the stamps, and about an even grid [s]; 0 where it
/// cannot be seen.
///
/// An error of time is an error of position in proportion to speed. Third differences leave nothing
/// of a smooth motion; medians keep spikes and breaks out. Medians of so many settle early: of a
/// recording longer than 2^18 samples, as many are looked at, in stretches spread over all of it.
struct TimingErrors {
  double as_stamped = 0.0;
  double as_uniform = 0.0;  ///< looked for only where the stamps are off
};
TimingErrors timing_errors(const Signal& time, const Signal& position, double period,
                           const base::Cancel* cancel);

}  // namespace jointid::signals
