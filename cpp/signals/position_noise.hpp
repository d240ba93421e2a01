#pragma once
// Noise of a position signal: the encoder's resolution, white noise, and errors of the time stamps.

#include <cstdint>
#include <vector>

#include "base/cancel.hpp"
#include "signals/signal.hpp"

namespace jointid::signals {

/// Samples begin .. end - 1, without a gap.
struct Stretch {
  Eigen::Index begin;
  Eigen::Index end;
};

/// The stretches between gaps. `gap_after` has the last sample before each gap, increasing.
std::vector<Stretch> stretches_between(Eigen::Index samples,
                                       const std::vector<std::int64_t>& gap_after);

struct PositionNoise {
  double quantum = 0.0;  ///< the encoder's resolution; 0 if the positions lie on no grid
  double sigma = 0.0;    ///< standard deviation of a sample, without errors of the time stamps
  double timing = 0.0;   ///< scatter of the time stamps [s]
};

/// The step is the smallest change of position, if the small changes are multiples of it; its noise
/// is step / sqrt(12). White noise is estimated from differences of orders 3 to 6 at the slower
/// half of the samples. The order with the least noise counts, because a smooth motion appears in
/// the low orders.
/// Of more than 2^17 samples, about 2^17 are examined, in stretches spread over the recording.
PositionNoise position_noise(const Signal& time, const Signal& position,
                             const std::vector<Stretch>& stretches, double period,
                             const base::Cancel* cancel);

}  // namespace jointid::signals
