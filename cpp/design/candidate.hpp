#pragma once
// Candidate motions: sums of sines of free size, frequency and phase that start and end at rest.
// They are as large as the limits allow.

#include <Eigen/Core>

#include "search/domain.hpp"
#include "simulate/trajectory.hpp"

namespace jointid::design {

/// Limits of the reference.
struct Bounds {
  double lowest = -1.0;  ///< position [rad]
  double highest = 1.0;
  double velocity = 1.0;      ///< [rad/s]
  double acceleration = 1.0;  ///< [rad/s^2]
  /// Bound on the drive's torque for the joint that needs most: inertia · |a| + viscous · |v| +
  /// dry.
  double torque = 1e300;
  double inertia = 0.0;
  double viscous = 0.0;
  double dry = 0.0;  ///< friction and load [N·m]

  void validate() const;
};

struct Family {
  int sines = 5;
  double duration = 12.0;  ///< [s]
  double fade = 0.5;       ///< at both ends [s]
  double slowest = 0.1;    ///< frequencies [rad/s]
  double fastest = 20.0;
  Bounds bounds{};

  void validate() const;
  /// Number of genes of a motion: frequency, size and phase of each sine, the position at rest, and
  /// the used share of the limits. All genes are between 0 and 1.
  [[nodiscard]] Eigen::Index genes() const { return 3 * sines + 2; }
  [[nodiscard]] search::Domain domain() const;
};

/// A sum of sines.
struct Sines {
  Eigen::VectorXd amplitude;
  Eigen::VectorXd frequency;
  Eigen::VectorXd phase;
  double offset = 0.0;
  double fade = 0.0;
  double duration = 0.0;

  [[nodiscard]] simulate::Trajectory trajectory() const;
};

/// The motion of these genes. It keeps the family's bounds, also between samples.
Sines motion_of(const Family& family, const Eigen::VectorXd& genes);

}  // namespace jointid::design
