#pragma once
// Agreement of time stamps and positions.

#include "base/cancel.hpp"
#include "signals/signal.hpp"

namespace jointid::signals {

/// Scatter of the samples' true times about the time stamps, and about an even grid [s]; 0 where it
/// cannot be seen.
///
/// An error of time is an error of position in proportion to the speed. Third differences remove a
/// smooth motion; medians exclude spikes and breaks. These medians need few samples: of a recording
/// longer than 2^18 samples, about 2^18 are examined, in stretches spread over all of it.
struct TimingErrors {
  double as_stamped = 0.0;
  double as_uniform = 0.0;  ///< computed only where the time stamps are wrong
};
TimingErrors timing_errors(const Signal& time, const Signal& position, double period,
                           const base::Cancel* cancel);

}  // namespace jointid::signals
