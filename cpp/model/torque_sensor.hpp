#pragma once
// A joint's built-in torque sensor: its reading of the link's torque, before any electronics. tau_J
// = gain * reading + offset. The ripple of a strain-wave gear, the non-linearity and the noise act
// as torques at its input.

#include <cmath>

#include "base/elementary.hpp"

namespace jointid::model {

struct TorqueSensor {
  double gain = 1.0;          ///< [N·m per unit of the reading]
  double offset = 0.0;        ///< [N·m]
  double ripple = 0.0;        ///< amplitude [N·m]
  double ripple_order = 2.0;  ///< order in the motor's angle
  double ripple_phase = 0.0;  ///< [rad]
  double nonlinearity = 0.0;  ///< largest deviation, as a share of the full scale
  double full_scale = 650.0;  ///< [N·m]

  /// `noise` acts at the input [N·m].
  [[nodiscard]] double reading(double torque, double motor_angle, double noise) const {
    double sensed = torque + noise;
    if (ripple != 0.0) sensed += ripple * base::sin(ripple_order * motor_angle + ripple_phase);
    if (nonlinearity != 0.0) {
      // x - x^3 vanishes at zero and at full scale. Its maximum between is 2 / sqrt 27.
      const double x = torque / full_scale;
      sensed += nonlinearity * full_scale * (1.5 * 1.7320508075688772) * (x - x * x * x);
    }
    return (sensed - offset) / gain;
  }
};

}  // namespace jointid::model
