#pragma once
// The decomposition-based law (4-8 to 4-15): the torque of the model with feedback of the sensed
// torque, adaptation of the friction terms, and a robust term with a boundary layer.

#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/estimates.hpp"

namespace jointid::simulate {

struct AdaptiveRobust : Estimates {
  double bandwidth = 80.0;  ///< lambda [1/s]
  bool robust_term = true;
  double robust_torque = 5.05;  ///< rho
  double boundary = 0.9 / 101;  ///< epsilon, boundary layer of r [rad/s]
  bool adaptation = false;
  double adaptation_dry = 0.0;  ///< gain k of the terms with sgn v
  double adaptation_viscous =
      0.0;  ///< gain k of the terms with v and with the Stribeck coefficient

  struct State {
    std::array<double, 4> integral{};
  };

  [[nodiscard]] double law(State& state, const ControlInput& input) const {
    const double error = input.position - input.wanted.position;
    const double error_rate = input.velocity - input.wanted.velocity;
    const double r = error_rate + bandwidth * error;
    const double pulled =
        input.wanted.acceleration - 2.0 * bandwidth * error_rate - bandwidth * bandwidth * error;
    const double velocity = friction_speed(input);
    const double sign = sign_of(velocity);
    const double faded = fading(velocity, input.faded);
    double torque = inertia * pulled + viscous * velocity +
                    (coulomb + static_excess * faded) * sign + link_torque(input);
    if (adaptation) {
      const std::array<double, 4> slope{velocity, sign, faded * sign,
                                        -static_excess * velocity * velocity * faded * sign};
      const std::array<double, 4> gain{adaptation_viscous, adaptation_dry, adaptation_dry,
                                       adaptation_viscous};
      for (std::size_t i = 0; i < slope.size(); ++i) {
        state.integral[i] += slope[i] * r * input.period;
        torque -= gain[i] * slope[i] * state.integral[i];
      }
    }
    if (robust_term) torque -= robust_torque * std::clamp(r / boundary, -1.0, 1.0);
    return torque;
  }

  void validate() const {
    const base::Requirement require("AdaptiveRobust");
    validate_estimates(require);
    require.at_least_zero("bandwidth", bandwidth);
    require.at_least_zero("robust_torque", robust_torque);
    require.above_zero("boundary", boundary);
    require.at_least_zero("adaptation_dry", adaptation_dry);
    require.at_least_zero("adaptation_viscous", adaptation_viscous);
  }

  /// Converts gains of the motor side to the output of a gear.
  static AdaptiveRobust from_motor_side(double gear_ratio, double bandwidth, double robust_torque,
                                        double boundary, double adaptation_gain) {
    const double ratio = std::fabs(gear_ratio);
    base::Requirement("AdaptiveRobust").above_zero("gear_ratio", ratio);
    AdaptiveRobust law;
    law.bandwidth = bandwidth;
    law.robust_torque = robust_torque * ratio;
    law.boundary = boundary / ratio;
    law.adaptation = adaptation_gain > 0.0;
    law.adaptation_dry = adaptation_gain * (ratio * ratio);
    law.adaptation_viscous = adaptation_gain * (ratio * ratio) * (ratio * ratio);
    law.validate();
    return law;
  }
};

}  // namespace jointid::simulate
