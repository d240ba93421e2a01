#pragma once
// Velocity from a coarse or noisy position. At each sample it is the slope of a cubic over the
// largest number of samples with the same slope.

#include <Eigen/Core>

#include "base/pool.hpp"
#include "signals/position_noise.hpp"

namespace jointid::signals {

struct LocalVelocity {
  Eigen::VectorXd velocity;
  Eigen::VectorXd noise;  ///< standard deviation at each sample; the deviation of the difference
                          ///< where that is kept
  bool refined = false;   ///< false: the noise is harmless, and every velocity is the difference
};

/// Starts from `difference`, the second-order differences at the true time stamps. They are kept
/// where their noise is below 0.03 % of the largest speed. Elsewhere, cubics are fitted at each
/// sample over 2 to 50 samples on either side. The longest length is taken with an interval of 1.8
/// standard deviations that meets those of all shorter ones (intersection of confidence intervals:
/// Goldenshluger and Nemirovski 1997, Katkovnik 1999). So a break of the motion ends the lengths
/// there. No fit reaches across a gap; at the ends of a stretch it is one-sided.
LocalVelocity local_velocity(const Signal& time, const Signal& position, const Signal& difference,
                             const std::vector<Stretch>& stretches, const PositionNoise& noise,
                             base::Pool* pool);

}  // namespace jointid::signals
