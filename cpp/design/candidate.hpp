#pragma once
// Motions to choose among: sums of sines of free size, frequency and phase that start and end at
// rest, made as large as the limits allow.

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
  /// The drive's torque for the joint that needs most: inertia · |a| + viscous · |v| + dry.
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
  /// Genes of a motion: for each sine frequency, size, phase; the position at rest; how much of the
  /// limits it uses. All between 0 and 1.
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

/// The motion of some genes, within the family's bounds between samples too.
Sines motion_of(const Family& family, const Eigen::VectorXd& genes);

}  // namespace jointid::design
