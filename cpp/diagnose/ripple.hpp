#pragma once
// Residual against multiples of the motor's angle.

#include <Eigen/Core>

#include "identify/penalty/penalty_parts.hpp"

namespace jointid::diagnose {

/// Sums over short windows, of what is left after their mean.
struct Spectrum {
  std::int64_t windows = 0;
  double power = 0.0;  ///< sum of squared residuals [(N m)^2]
  Eigen::VectorXd
      multiple;  ///< magnitude of the sum of residual * exp(i h/2 * motor angle), h = 1 ..
};

/// `parts` has short windows; those in which the highest multiple turns by two rounds or more would
/// average it away, and are left out. A share of a variance settles early: of more than 2^18
/// samples, about as many are looked at, in stretches spread over all of the recordings.
Spectrum ripple_spectrum(const identify::PenaltyParts& parts, const Eigen::VectorXd& theta,
                         double gear_ratio, int halves, base::Pool* pool);

}  // namespace jointid::diagnose
