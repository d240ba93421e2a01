#pragma once
// Single samples far from both neighbours, and positions that jump. Limits follow from the signal's
// usual changes. If counting shows that the largest change is below its limit, no quantile is
// computed.

#include <cstdint>

#include "diagnose/signal_facts.hpp"

namespace jointid::diagnose {

enum class SpikeRule {
  position,  ///< inertia makes it smooth
  command,   ///< a controller may react strongly
  other,
};

struct Spike {
  double height = 0.0;
  std::int64_t index = 0;
  std::int64_t count = 0;  ///< 0: none
};

/// A torque, a reading and a velocity really step where the joint reverses, sticks or breaks loose.
/// Within a few samples of that, only a value outside the signal's usual range is a spike.
/// `peak_speed` is the peak speed of the motion.
Spike largest_spike(const Signal& signal, SpikeRule rule, const Signal& velocity, double peak_speed,
                    const base::Cancel* cancel);

/// The sample after which the position moves faster than anywhere else and does not return; -1 if
/// there is none.
std::int64_t largest_jump(const Signal& time, const Signal& position, const base::Cancel* cancel);

}  // namespace jointid::diagnose
