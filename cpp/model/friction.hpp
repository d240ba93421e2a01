#pragma once
// Static friction maps as sums of linear coefficients times basis functions of the speed: f(v) =
// sgn v * sum c_i h_i(|v|). (2-1) Coulomb + viscous and (4-1) Coulomb + static excess with Gaussian
// decay + viscous are such sums; only the decay has a shape parameter. A new map is a new basis
// here and a new row in identify/terms.cpp.

#include "base/elementary.hpp"

namespace jointid::model {

enum class SpeedBasis {
  one,       ///< 1: Coulomb friction
  stribeck,  ///< exp(-s v^2), s the shape coefficient [s^2/rad^2]: the static excess of (4-1)
};

/// h(|v|) for one speed.
inline double basis_value(SpeedBasis basis, double speed, double shape) {
  return basis == SpeedBasis::one ? 1.0 : base::exp(-shape * speed * speed);
}

/// d h / d shape.
inline double basis_slope(SpeedBasis basis, double speed, double shape) {
  return basis == SpeedBasis::one ? 0.0 : -speed * speed * base::exp(-shape * speed * speed);
}

}  // namespace jointid::model
