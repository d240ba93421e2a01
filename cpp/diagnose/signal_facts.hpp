#pragma once
// Clipping, repeated samples and freezing of a single signal: exact counts in two passes.

#include <cstdint>

#include "base/cancel.hpp"
#include "signals/signal.hpp"

namespace jointid::diagnose {

using signals::Signal;

/// Smallest and largest value.
struct Extremes {
  double lowest = 0.0;
  double highest = 0.0;
};
Extremes extremes(const Signal& signal);

/// Samples at one of a signal's extremes.
struct Limit {
  std::int64_t there = 0;   ///< samples at the extreme
  std::int64_t moving = 0;  ///< samples at the extreme while the joint moves at any speed
  std::int64_t near = 0;    ///< samples within 1 % of the range, including those at the extreme
};

struct SignalFacts {
  Extremes range;
  bool fine = false;         ///< the usual step is at least 30 times the smallest, so that equal
                             ///< neighbours are suspicious
  std::int64_t changes = 0;  ///< number of steps that are not zero
  double smallest = 0.0;     ///< smallest step that is not zero; infinite if there is none
  Limit lower;
  Limit upper;
  std::int64_t moving = 0;  ///< intervals at a fair speed
  std::int64_t stale = 0;   ///< intervals among `moving` without a step and not at an extreme
  std::int64_t frozen =
      0;  ///< intervals among `moving` in runs longer than 0.1 s and ten intervals
};

SignalFacts inspect_signal(const Signal& signal, const Signal& velocity, double peak_speed,
                           double period, const base::Cancel* cancel);

}  // namespace jointid::diagnose
