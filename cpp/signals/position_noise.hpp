#pragma once
// Noise of a position signal: the encoder's step, white noise, and errors of the time stamps.

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

/// The stretches between gaps; `gap_after` holds the last sample before each, increasing.
std::vector<Stretch> stretches_between(Eigen::Index samples,
                                       const std::vector<std::int64_t>& gap_after);

struct PositionNoise {
  double quantum = 0.0;  ///< the encoder's step; 0 where the positions lie on no grid
  double sigma = 0.0;    ///< standard deviation at a sample, apart from that of the stamps
  double timing = 0.0;   ///< scatter of the stamps [s]
};

/// The step is the smallest change of position, if the small changes are multiples of it; its noise
/// is step / sqrt(12). White noise is looked for in differences of orders 3 to 6 at the slower half
/// of the samples: the order that shows least, because a smooth motion appears in the low ones.
/// Of more than 2^17 samples about as many are looked at, in stretches spread over all.
PositionNoise position_noise(const Signal& time, const Signal& position,
                             const std::vector<Stretch>& stretches, double period,
                             const base::Cancel* cancel);

}  // namespace jointid::signals
