#pragma once
// Whether position, velocity and time stamps are consistent with one motion.

#include <optional>

#include "diagnose/signal_facts.hpp"

namespace jointid::diagnose {

/// position change = scale * integrated velocity + lag * velocity change, over blocks of eight
/// samples, trimmed; none where there are too few blocks or the two are indistinguishable.
struct Agreement {
  double scale;
  double lag;        ///< [s]
  double lag_error;  ///< its standard error [s]
};
std::optional<Agreement> velocity_agreement(const Signal& time, const Signal& position,
                                            const Signal& velocity, double period,
                                            const base::Cancel* cancel);

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

}  // namespace jointid::diagnose
