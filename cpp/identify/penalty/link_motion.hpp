#pragma once
// Motion of a rigid link in each window of a penalty: the regressors of a reading of its torque.

#include <Eigen/Core>
#include <vector>

#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

/// Columns of `link_motion`, one row per window.
enum LinkMotion : Eigen::Index {
  kFaster,    ///< velocity change over the window [rad/s or m/s]
  kCosine,    ///< cosine of the angle in the middle, times the integrated time
  kSine,      ///< sine of that angle, times the integrated time
  kDuration,  ///< integrated time [s]
  kStep,      ///< rise of the torque over the usable intervals, times the recording's period
  kDry,       ///< constant friction: the integrated time with the sign of the motion [s]
  kViscous,   ///< the integrated time, times the mean velocity
  kSlow,      ///< as kDry, decaying with the mean speed over `slow`
  kTorque,    ///< integral of the torque, as the penalty's target
  kReading,   ///< integral of the sensor's reading
  kLasting,   ///< time from the first to the last sample [s]
  kLinkMotion
};

/// For a penalty with a gain. `periods`: one factor on the torque steps per recording of the
/// penalty.
Eigen::MatrixXd link_motion(const Penalty& penalty, const Penalty::Masked& recordings,
                            const std::vector<double>& periods, double slow);

}  // namespace jointid::identify
