#pragma once
// What the joint's log says: one contiguous array per signal, and which sample intervals may be
// used.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace jointid::identify {

/// How the torque signal lives between samples: a command is held, a measured signal is
/// interpolated.
enum class Hold { zero_order, linear };

struct Recording {
  Eigen::VectorXd time;      ///< [s], increasing
  Eigen::VectorXd position;  ///< output side [rad] or [m]
  Eigen::VectorXd velocity;  ///< output side [rad/s] or [m/s]
  Eigen::VectorXd torque;    ///< output side [N m] or [N]
  Eigen::VectorXd sensor;    ///< raw reading of the joint torque sensor; empty without one
  Hold torque_hold = Hold::linear;
  std::vector<std::int64_t> gap_after;  ///< last sample before each gap

  [[nodiscard]] Eigen::Index samples() const { return time.size(); }
  [[nodiscard]] bool has_sensor() const { return sensor.size() > 0; }
  /// Throws std::invalid_argument when lengths differ, a value is not finite or time does not
  /// increase.
  void validate() const;
};

/// One flag per sample interval k -> k+1: 1 where the joint moves and the record has no gap.
///
/// Left out are, narrowly: gaps; runs in which the joint truly sticks (position unchanged, or
/// velocity exactly zero, for longer than the resolution explains) with two intervals either side,
/// where friction is set-valued and the model says nothing; and standing still (creeping below 0.3
/// % of the peak speed for 0.1 s or longer; at slow motion 1 % of its period). A mere reversal is
/// kept: dropping all that is slow biases viscous friction.
struct UsableIntervals {
  std::vector<std::uint8_t> usable;
  std::int64_t standing = 0;  ///< samples found sticking or standing still
};
UsableIntervals usable_intervals(const Recording& recording, bool mask_standstill);

}  // namespace jointid::identify
