#pragma once
// Whether position and velocity are consistent with one motion.

#include <optional>

#include "diagnose/signal_facts.hpp"

namespace jointid::diagnose {

/// position change = scale * integrated velocity + lag * velocity change, over blocks of eight
/// samples, trimmed. None if there are too few blocks or the two effects are indistinguishable.
struct Agreement {
  double scale;
  double lag;        ///< [s]
  double lag_error;  ///< its standard error [s]
};
std::optional<Agreement> velocity_agreement(const Signal& time, const Signal& position,
                                            const Signal& velocity, double period,
                                            const base::Cancel* cancel);

}  // namespace jointid::diagnose
