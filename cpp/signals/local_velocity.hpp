#pragma once
// Velocity from position where the position is coarse or noisy: at each sample the slope of a cubic
// over as many samples as show the same slope.

#include <Eigen/Core>

#include "base/pool.hpp"
#include "signals/position_noise.hpp"

namespace jointid::signals {

struct LocalVelocity {
  Eigen::VectorXd velocity;
  Eigen::VectorXd noise;  ///< standard deviation at each sample; that of the difference where kept
  bool refined = false;   ///< false: the noise is harmless, and every velocity is the difference
};

/// Starts from `difference`, the second-order differences at the true stamps. Where their noise is
/// below 0.03 % of the largest speed they stay. Elsewhere cubics are fitted at each sample over 2
/// to 50 samples on either side; the longest is taken whose interval of 1.8 standard deviations
/// meets those of all shorter ones (intersection of confidence intervals: Goldenshluger and
/// Nemirovski 1997, Katkovnik 1999), so that a break of the motion ends the lengths there. No fit
/// reaches across a gap; at the ends of a stretch it is one-sided.
LocalVelocity local_velocity(const Signal& time, const Signal& position, const Signal& difference,
                             const std::vector<Stretch>& stretches, const PositionNoise& noise,
                             base::Pool* pool);

}  // namespace jointid::signals
