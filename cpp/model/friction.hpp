#pragma once
// Static friction maps as sums of linear coefficients times basis functions of the speed:
// f(v) = sgn v * sum c_i h_i(|v|).
// (2-1) Coulomb + viscous, (2-3) Stribeck with exponent and (4-1) Coulomb + static excess with
// Gaussian decay + viscous are such sums. Only a decay and a rise have shape parameters. A basis
// has a value, slopes, a unit and its text for exports. A new basis needs a case in each function
// here, and a row in identify/balance/terms.cpp. Fits, simulation, design, exports and pages
// follow.

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include "base/choices.hpp"
#include "base/elementary.hpp"
#include "base/lanes.hpp"

namespace jointid::model {

enum class SpeedBasis {
  constant,  ///< 1: Coulomb friction
  linear,    ///< |v|: viscous friction
  gaussian,  ///< exp(-s v^2), s [s^2/rad^2]: the static excess of (4-1)
  general,   ///< exp(-|v/v_s|^d), v_s [rad/s] and d [1]: the static excess of (2-3)
  rising,    ///< tanh(|v|/v_r), v_r [rad/s]: Coulomb friction that rises smoothly with speed
};

constexpr std::size_t kMostShapes = 2;  ///< most shape parameters of a basis

/// The direction of motion in which a term acts.
enum class Direction { both, positive, negative };

/// Facts about a basis that do not depend on the speed.
struct BasisFacts {
  const char* unit;  ///< unit of a coefficient: torque over the basis's unit
  const char* unit_prismatic;
  double at_rest;            ///< h(0)
  bool settles = false;      ///< whether h is 1 in fast motion, as for Coulomb friction
  bool shape_above = false;  ///< whether its shape parameters must be above 0, not 0
  /// h as a product, in the notation of C: `speed` is the speed, {0} and {1} are the shapes. Empty:
  /// 1.
  const char* expression = "";
};
inline const BasisFacts& facts_of(SpeedBasis basis) {
  static constexpr std::array<BasisFacts, 5> kFacts{{
      {.unit = "N·m", .unit_prismatic = "N", .at_rest = 1.0, .settles = true},
      {.unit = "N·m·s/rad", .unit_prismatic = "N·s/m", .at_rest = 0.0, .expression = "speed"},
      {.unit = "N·m",
       .unit_prismatic = "N",
       .at_rest = 1.0,
       .expression = "exp(-({0} * speed * speed))"},
      // A power as exponential and logarithm, which every language has.
      {.unit = "N·m",
       .unit_prismatic = "N",
       .at_rest = 1.0,
       .shape_above = true,
       .expression = "exp(-exp({1} * log(speed / {0})))"},
      // The hyperbolic tangent by an exponential, which every language has.
      {.unit = "N·m",
       .unit_prismatic = "N",
       .at_rest = 0.0,
       .settles = true,
       .shape_above = true,
       .expression = "(2.0 / (1.0 + exp(-(2.0 * speed / {0}))) - 1.0)"},
  }};
  return kFacts.at(static_cast<std::size_t>(basis));
}

/// log |v|. For a joint at rest, a number so low that any power of the speed is 0.
inline double log_speed(double speed) {
  constexpr double least = std::numeric_limits<double>::min();
  const double rest = speed >= least ? 0.0 : -1e6;  // added, because a choice would be a branch
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
  const double power = base::exp_short(lowest < 7.0 ? lowest : 7.0);  // e^-1096 is 0
  const double value = base::exp_decay(power);
  const double slope = value * power;
  return {value, slope * exponent / velocity, -slope * scaled};
}

/// h(|v|) for one speed or several lanes; `shapes` holds the shapes of the basis.
template <class Number>
Number basis_value(SpeedBasis basis, const Number& speed, const Number* shapes) {
  switch (basis) {
    case SpeedBasis::constant:
      return 1.0;
    case SpeedBasis::linear:
      return speed;
    case SpeedBasis::gaussian:
      return base::exp(-(shapes[0] * speed * speed));
    case SpeedBasis::general:
      return base::exp(-base::pow(speed / shapes[0], shapes[1]));
    case SpeedBasis::rising:
      return Number(2.0) / (Number(1.0) + base::exp(-(Number(2.0) * speed / shapes[0]))) -
             Number(1.0);
  }
  return 0.0;
}

/// Derivative of h by its shape number `which`.
inline double basis_slope(SpeedBasis basis, double speed, const double* shapes, int which) {
  switch (basis) {
    case SpeedBasis::constant:
    case SpeedBasis::linear:
      return 0.0;
    case SpeedBasis::gaussian:
      return -speed * speed * basis_value(basis, speed, shapes);
    case SpeedBasis::general: {
      const double scaled = log_speed(speed) - base::log(shapes[0]);
      const auto decay = general_decay(scaled, shapes[0], shapes[1]);
      return which == 0 ? decay.by_velocity : decay.by_exponent;
    }
    case SpeedBasis::rising: {
      const double value = basis_value(basis, speed, shapes);
      return -(1.0 - value * value) * speed / (shapes[0] * shapes[0]);
    }
  }
  return 0.0;
}

/// Derivative of h by the speed, which is above 0.
inline double basis_rate(SpeedBasis basis, double speed, const double* shapes) {
  switch (basis) {
    case SpeedBasis::constant:
      return 0.0;
    case SpeedBasis::linear:
      return 1.0;
    case SpeedBasis::gaussian:
      return -2.0 * shapes[0] * speed * basis_value(basis, speed, shapes);
    case SpeedBasis::general:
      return -shapes[1] * base::pow(speed / shapes[0], shapes[1]) / speed *
             basis_value(basis, speed, shapes);
    case SpeedBasis::rising: {
      const double value = basis_value(basis, speed, shapes);
      return (1.0 - value * value) / shapes[0];
    }
  }
  return 0.0;
}

}  // namespace jointid::model

template <>
struct jointid::base::Words<jointid::model::SpeedBasis> {
  static constexpr std::string_view field = "basis";
  static constexpr std::array<std::string_view, 5> all{"constant", "linear", "gaussian", "general",
                                                       "rising"};
};
