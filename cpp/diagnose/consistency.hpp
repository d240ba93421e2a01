#pragma once
// Whether position, velocity and sensor are consistent with one motion.

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

/// Delay of the sensor behind the torque of a free link, which follows from the motion alone
/// (inertia and gravity, wherever friction is), and its error [s]; infinite where the link is not
/// free.
struct SensorLag {
  double lag = 0.0;
  double error;
};
SensorLag sensor_lag(const Signal& time, const Signal& position, const Signal& velocity,
                     const Signal& sensor, double period, const base::Cancel* cancel);

}  // namespace jointid::diagnose
