#pragma once
// Friction in proportion to the drive's torque: tau = F + c |tau| sgn v, F the torque of all other
// terms. Solved for tau it is a function of the motion alone, tau = F / (1 - c sgn(F v)): as much
// as the drive pushes harder where it drives the load, it holds less where the load drives it. With
// the measured |tau| as a regressor a coefficient of 1 would explain any torque by itself.

#include <cmath>

namespace jointid::identify {

/// Torque [N·m, or its integral over one direction of motion], and its derivatives.
struct LoadedTorque {
  double value;
  double by_torque;       ///< by F
  double by_coefficient;  ///< by c
};

/// `direction`: 1 or -1, the sign of the velocity; the coefficient is below 1.
inline LoadedTorque loaded_torque(double torque, double direction, double coefficient) {
  const double gain = 1.0 / (1.0 - coefficient * std::copysign(direction, direction * torque));
  return {gain * torque, gain, direction * std::fabs(torque) * gain * gain};
}

}  // namespace jointid::identify
