#pragma once
// The accuracy with which a motion determines the free parameters: Fisher information of the
// windows of a noise-free run, as a least-squares identification would use them.

#include <Eigen/Core>
#include <vector>

#include "design/regressors.hpp"

namespace jointid::design {

/// Noise of the balance, and the samples that an identification leaves out.
struct Noise {
  double torque = 1.0;    ///< white noise of a sample [N·m]
  double position = 0.0;  ///< error of the position at a window's end [rad]
  double velocity = 0.0;  ///< error of the velocity there [rad/s]
  double slowest = 0.0;   ///< slower samples carry no information [rad/s]
  /// Error of a window in which the velocity changes its sign between samples [N·m·s].
  double reversal = 0.0;
  double sampled = 0.0;  ///< time between samples of the recording [s]

  void validate() const;
};

/// Information of the windows of a run.
struct Told {
  Eigen::MatrixXd information;  ///< sum of row' row / variance
  Eigen::VectorXd misled;       ///< sum of row' (systematic error of the balance) / variance
};

/// A window has `samples` samples. It ends earlier where the joint is slower than `noise.slowest`.
/// `period` is the time between samples [s]. The systematic error of the balance is the error of
/// the trapezoidal rule over the recording's samples for static friction that decays fast.
Told information(const simulate::Signals& signals, const std::vector<Column>& columns,
                 const Noise& noise, const model::Joint& joint, double inertia, double viscous,
                 double period, int samples);

}  // namespace jointid::design
