#pragma once
// Single samples far off both neighbours, and positions that jump. Limits follow from the signal's
// usual changes; where counting shows that the largest lies below its limit, no quantile is formed.

#include <cstdint>

#include "diagnose/signal_facts.hpp"

namespace jointid::diagnose {

enum class SpikeRule {
  position,  ///< inertia makes it smooth
  command,   ///< a controller may hit back hard
  other,
};

struct Spike {
  double height = 0.0;
  std::int64_t index = 0;
  std::int64_t count = 0;  ///< 0: none
};

/// A torque, a reading and a velocity truly step where the joint reverses, sticks or breaks loose:
/// within a few samples of that, only what leaves the signal's usual range altogether is a spike.
/// `peak_speed` is that of the motion.
Spike largest_spike(const Signal& signal, SpikeRule rule, const Signal& velocity, double peak_speed,
                    const base::Cancel* cancel);

/// The sample after which the position moves on faster than it ever does otherwise, and stays
/// there; -1 without one.
std::int64_t largest_jump(const Signal& time, const Signal& position, const base::Cancel* cancel);

}  // namespace jointid::diagnose
