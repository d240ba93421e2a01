#pragma once
// What a single signal shows of clipping, repeated samples and hanging: counts, exact, in two
// passes.

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
  std::int64_t there = 0;   ///< on it
  std::int64_t moving = 0;  ///< on it while the joint moves, if ever so slowly
  std::int64_t near = 0;    ///< within 1 % of the range, those on it too
};

struct SignalFacts {
  Extremes range;
  bool fine = false;  ///< the usual step is at least 30 of the smallest: equal neighbours are odd
  std::int64_t changes = 0;  ///< steps that are not zero
  double smallest = 0.0;     ///< of those the smallest; infinite without any
  Limit lower;
  Limit upper;
  std::int64_t moving = 0;  ///< intervals at a fair speed
  std::int64_t stale = 0;   ///< of those: no step, and not on a limit
  std::int64_t frozen = 0;  ///< of those: in runs longer than 0.1 s and ten intervals
};

SignalFacts inspect_signal(const Signal& signal, const Signal& velocity, double peak_speed,
                           double period, const base::Cancel* cancel);

}  // namespace jointid::diagnose
