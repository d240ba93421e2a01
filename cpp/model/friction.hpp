#pragma once
// Static friction maps as sums of linear coefficients times basis functions of the speed:
// f(v) = sgn v * sum c_i h_i(|v|). (2-1) Coulomb + viscous, (2-3) Stribeck with exponent and (4-1)
// Coulomb + static excess with Gaussian decay + viscous are such sums; only the decay has shape
// parameters. A basis owns value, slope and unit; a new one is a case in each function here, and a
// row in identify/balance/terms.cpp.

#include <limits>

#include "base/elementary.hpp"

namespace jointid::model {

enum class SpeedBasis {
  one,               ///< 1: Coulomb friction
  speed,             ///< |v|: viscous friction of one direction
  stribeck,          ///< exp(-s v^2), s [s^2/rad^2]: the static excess of (4-1)
  stribeck_general,  ///< exp(-|v/v_s|^d), v_s [rad/s] and d [1]: the static excess of (2-3)
};

/// The direction of motion in which a term acts.
enum class Direction { both, positive, negative };

/// Units of a coefficient: torque over the basis's unit.
struct BasisUnit {
  const char* revolute;
  const char* prismatic;
};
inline BasisUnit basis_unit(SpeedBasis basis) {
  switch (basis) {
    case SpeedBasis::speed:
      return {"N·m·s/rad", "N·s/m"};
    case SpeedBasis::one:
    case SpeedBasis::stribeck:
    case SpeedBasis::stribeck_general:
      break;
  }
  return {"N·m", "N"};
}

/// log |v|; for a joint at rest a number so low that any power of the speed is 0.
inline double log_speed(double speed) {
  constexpr double least = std::numeric_limits<double>::min();
  const double rest = speed >= least ? 0.0 : -1e6;  // added, since a choice would be a branch
  return base::log_normal(speed >= least ? speed : least) + rest;
}

/// exp(-|v/v_s|^d) and its derivatives, without a branch: loops over it vectorise.
struct GeneralDecay {
  double value;
  double by_velocity;
  double by_exponent;
};
/// `scaled`: log(|v| / v_s).
inline GeneralDecay general_decay(double scaled, double velocity, double exponent) {
  const double wanted = exponent * scaled;
  const double lowest = wanted > -600.0 ? wanted : -600.0;
  const double power = base::exp_short(lowest < 7.0 ? lowest : 7.0);  // e^-1096 is 0 anyway
  const double value = base::exp_decay(power);
  const double slope = value * power;
  return {value, slope * exponent / velocity, -slope * scaled};
}

/// h(|v|) for one speed; `shapes` holds as many values as the basis has.
inline double basis_value(SpeedBasis basis, double speed, const double* shapes) {
  switch (basis) {
    case SpeedBasis::one:
      return 1.0;
    case SpeedBasis::speed:
      return speed;
    case SpeedBasis::stribeck:
      return base::exp(-shapes[0] * speed * speed);
    case SpeedBasis::stribeck_general:
      return general_decay(log_speed(speed) - base::log(shapes[0]), shapes[0], shapes[1]).value;
  }
  return 0.0;
}

/// Derivative of h by its shape number `which`.
inline double basis_slope(SpeedBasis basis, double speed, const double* shapes, int which) {
  switch (basis) {
    case SpeedBasis::one:
    case SpeedBasis::speed:
      return 0.0;
    case SpeedBasis::stribeck:
      return -speed * speed * base::exp(-shapes[0] * speed * speed);
    case SpeedBasis::stribeck_general: {
      const double scaled = log_speed(speed) - base::log(shapes[0]);
      const auto decay = general_decay(scaled, shapes[0], shapes[1]);
      return which == 0 ? decay.by_velocity : decay.by_exponent;
    }
  }
  return 0.0;
}

}  // namespace jointid::model
