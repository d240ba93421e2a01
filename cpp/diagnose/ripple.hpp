#pragma once
// Residual at multiples of the motor's angle.

#include <Eigen/Core>

#include "identify/penalty/penalty_parts.hpp"

namespace jointid::diagnose {

/// Sums over short windows of the residual without its mean.
struct Spectrum {
  std::int64_t windows = 0;
  double power = 0.0;  ///< sum of squared residuals [(N m)^2]
  Eigen::VectorXd
      multiple;  ///< magnitude of the sum of residual * exp(i h/2 * motor angle), h = 1 ..
};

/// `parts` has short windows. Windows in which the highest multiple turns by two revolutions or
/// more are left out, because they would average it. A share of a variance needs few windows: for
/// more than 2^18 samples, about 2^18 are examined, in stretches spread over all recordings.
Spectrum ripple_spectrum(const identify::PenaltyParts& parts, const Eigen::VectorXd& theta,
                         double gear_ratio, int halves, base::Pool* pool);

}  // namespace jointid::diagnose
