#pragma once
// How a rigid link moves in each window of a penalty: what a reading of its torque is regressed on.

#include <Eigen/Core>
#include <vector>

#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

/// Columns of `link_motion`, a row a window.
enum LinkMotion : Eigen::Index {
  kFaster,    ///< how much faster the joint is at the end [rad/s or m/s]
  kCosine,    ///< of the angle in the middle, times the integrated time
  kSine,      ///< of it
  kDuration,  ///< integrated time [s]
  kStep,      ///< how far the torque rises over the usable intervals, times the recording's period
  kLasting,   ///< time from the first to the last sample [s]
  kSpeed,     ///< mean velocity [rad/s or m/s]
  kLinkMotion
};

/// `periods`: a number for each of the recordings that the penalty was cut from, by which its
/// torque's steps are multiplied.
Eigen::MatrixXd link_motion(const Penalty& penalty, const Penalty::Masked& recordings,
                            const std::vector<double>& periods);

}  // namespace jointid::identify
