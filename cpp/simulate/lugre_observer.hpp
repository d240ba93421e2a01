#pragma once
// Friction compensation by an observer of the bristles (Canudas de Wit, Olsson, Åström, Lischinsky:
// "A new model for control of systems with friction", 1995), around a PD law with torque feedback.

#include <cmath>

#include "simulate/estimates.hpp"

namespace jointid::simulate {

struct LugreObserver : Estimates {
  double bandwidth = 80.0;         ///< bandwidth of the tracking error [1/s]
  double bristle_stiffness = 1e4;  ///< sigma_0
  double bristle_damping = 0.0;    ///< sigma_1
  double observer_gain = 0.0;      ///< gain of the filtered error on the bristles [1]

  struct State {
    double bristle = 0.0;  ///< observed deflection [rad]
  };

  [[nodiscard]] double law(State& state, const ControlInput& input) const {
    const double error = input.position - input.wanted.position;
    const double error_rate = input.velocity - input.wanted.velocity;
    const double r = error_rate + bandwidth * error;
    const double pulled =
        input.wanted.acceleration - 2.0 * bandwidth * error_rate - bandwidth * bandwidth * error;
    const double velocity = friction_speed(input);
    const double model = inertia * pulled + viscous * velocity + link_torque(input);
    const double level = coulomb + static_excess * fading(velocity);
    if (level <= 0.0) return model;  // no dry friction, no bristles
    // Exact over a period at this velocity; the rate is that of the mean deflection.
    const double rate = bristle_stiffness * std::fabs(velocity) / level;
    const double inflow = velocity - observer_gain * r;
    const double x = rate * input.period;
    const double mean = x < 1e-9 ? 1.0 : (1.0 - base::exp(-x)) / x;
    const double change = mean * (inflow - rate * state.bristle);
    state.bristle += input.period * change;
    return model + bristle_stiffness * state.bristle + bristle_damping * change;
  }

  void validate() const {
    const base::Requirement require("LugreObserver");
    validate_estimates(require);
    require.at_least_zero("bandwidth", bandwidth);
    require.above_zero("bristle_stiffness", bristle_stiffness);
    require.at_least_zero("bristle_damping", bristle_damping);
    require.at_least_zero("observer_gain", observer_gain);
  }
};

}  // namespace jointid::simulate
