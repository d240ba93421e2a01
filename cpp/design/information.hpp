#pragma once
// How well a motion determines the free parameters: Fisher's information of the windows of a
// noise-free run, as a least-squares identification would use them.

#include <Eigen/Core>
#include <vector>

#include "design/regressors.hpp"

namespace jointid::design {

/// Noise of the balance, and what an identification leaves out.
struct Noise {
  double torque = 1.0;    ///< of a sample, white [N·m]
  double position = 0.0;  ///< of the position at a window's end [rad]
  double velocity = 0.0;  ///< of the velocity there [rad/s]
  double slowest = 0.0;   ///< slower samples carry no information [rad/s]
  /// Of a window in which the velocity changes its sign at an instant between samples [N·m·s].
  double reversal = 0.0;
  double sampled = 0.0;  ///< between samples of the recording [s]

  void validate() const;
};

/// Information of the windows of a run.
struct Told {
  Eigen::MatrixXd information;  ///< sum of row' row / variance
  Eigen::VectorXd misled;       ///< sum of row' (what the balance misses) / variance
};

/// A window of `samples` ends early where the joint is slower than `noise.slowest`. `period` is
/// between samples [s]. The balance misses what the trapezoidal rule over the recording's samples
/// does of static friction that fades fast.
Told information(const simulate::Signals& signals, const std::vector<Column>& columns,
                 const Noise& noise, const model::Joint& joint, double inertia, double viscous,
                 double period, int samples);

}  // namespace jointid::design
