#pragma once
// Open loop, PD, PID, and PID with a fixed model of friction.

#include <algorithm>
#include <limits>

#include "simulate/estimates.hpp"

namespace jointid::simulate {

/// The trajectory is the torque.
struct OpenLoop {
  double gain = 1.0;  ///< torque per unit of the trajectory

  struct State {};
  [[nodiscard]] double law(State&, const ControlInput& input) const {
    return gain * input.wanted.position;
  }
  void validate() const { base::Requirement("OpenLoop").finite("gain", gain); }
};

struct Pd {
  double stiffness = 0.0;  ///< torque per error of position
  double damping = 0.0;    ///< torque per error of velocity

  struct State {};
  [[nodiscard]] double law(State&, const ControlInput& input) const {
    return stiffness * (input.wanted.position - input.position) +
           damping * (input.wanted.velocity - input.velocity);
  }
  void validate() const {
    const base::Requirement require("Pd");
    require.at_least_zero("stiffness", stiffness);
    require.at_least_zero("damping", damping);
  }
};

struct Pid {
  double stiffness = 0.0;
  double integral = 0.0;  ///< torque per error of position and second
  double damping = 0.0;
  double integral_limit = 1e6;  ///< limit on the torque of the integral

  struct State {
    double torque = 0.0;  ///< torque of the integral
  };
  [[nodiscard]] double law(State& state, const ControlInput& input) const {
    const double error = input.wanted.position - input.position;
    state.torque =
        std::clamp(state.torque + integral * error * input.period, -integral_limit, integral_limit);
    return stiffness * error + state.torque + damping * (input.wanted.velocity - input.velocity);
  }
  void validate() const { validate_as(base::Requirement("Pid")); }
  void validate_as(const base::Requirement& require) const {
    require.at_least_zero("stiffness", stiffness);
    require.at_least_zero("integral", integral);
    require.at_least_zero("damping", damping);
    require.above_zero("integral_limit", integral_limit);
  }
};

struct CompensatedPid : Pid, Estimates {
  [[nodiscard]] double law(State& state, const ControlInput& input) const {
    const double velocity = friction_speed(input);
    const double dry = coulomb + static_excess * fading(velocity);
    return Pid::law(state, input) + inertia * input.wanted.acceleration + viscous * velocity +
           dry * sign_of(velocity) + link_torque(input);
  }
  void validate() const {
    const base::Requirement require("CompensatedPid");
    validate_as(require);
    validate_estimates(require);
  }
};

}  // namespace jointid::simulate
