#pragma once
// Friction in proportion to a load, without the measured torque as a regressor: with the measured
// |tau|, a coefficient of 1 would explain any torque. F is the torque of all other terms, c the
// coefficient.
//
// In proportion to the drive's torque: tau = F + c |tau| sgn v, solved for tau, is
// tau = F / (1 - c sgn(F v)). The drive needs more torque where it drives the load, and less where
// the load drives it. In proportion to the torque L behind the gear, which a sensor or a model of
// the load gives: tau = F + c |L| sgn v.

#include <cmath>

namespace jointid::identify {

/// The drive's torque (or its integral over one direction of motion), and its derivatives.
struct LoadedTorque {
  double value;
  double by_torque;       ///< derivative by F
  double by_link;         ///< derivative by L
  double by_coefficient;  ///< derivative by c
};

/// `direction`: 1 or -1, the sign of the velocity. The coefficient must be below 1.
inline LoadedTorque loaded_by_drive(double torque, double direction, double coefficient) {
  const double gain = 1.0 / (1.0 - coefficient * std::copysign(1.0, direction * torque));
  return {gain * torque, gain, 0.0, direction * std::fabs(torque) * gain * gain};
}

inline LoadedTorque loaded_by_link(double torque, double link, double direction,
                                   double coefficient) {
  const double load = direction * std::fabs(link);
  return {torque + coefficient * load, 1.0, coefficient * direction * std::copysign(1.0, link),
          load};
}

}  // namespace jointid::identify
