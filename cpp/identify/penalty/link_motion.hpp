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
  kDry,       ///< friction of one size: the integrated time with the sign of the motion [s]
  kViscous,   ///< the integrated time, times the mean velocity
  kSlow,      ///< as kDry, fading with the mean speed over `slow`
  kTorque,    ///< integral of the torque, as the penalty's target
  kReading,   ///< integral of the sensor's reading
  kLasting,   ///< time from the first to the last sample [s]
  kLinkMotion
};

/// Of a penalty with a gain. `periods`: a number for each of the recordings that the penalty was
/// cut from, by which its torque's steps are multiplied.
Eigen::MatrixXd link_motion(const Penalty& penalty, const Penalty::Masked& recordings,
                            const std::vector<double>& periods, double slow);

}  // namespace jointid::identify
