#pragma once
// Friction of one direction of motion: the dry part, the part that varies with the speed, and the
// viscous part.

#include "base/lanes.hpp"
#include "model/joint.hpp"

namespace jointid::model {

/// Sums over the terms, in the direction of motion.
template <class Number>
struct DirectedFriction {
  Number dry;      ///< constant, with the share that grows with the load
  Number at_rest;  ///< the varying terms just above zero speed
  Number viscous;  ///< per unit of speed

  [[nodiscard]] Number breakaway() const { return dry + at_rest; }
  /// All friction except the viscous part; `varying` is the value of the varying terms.
  [[nodiscard]] Number level(const Number& varying) const { return dry + varying; }
};

template <class Number, class Mask>
DirectedFriction<Number> directed(const JointOf<Number>& joint, const Mask& forward,
                                  const Number& load) {
  DirectedFriction<Number> sum{0.0, 0.0, 0.0};
  for (const auto& term : joint.friction) {
    const Number coefficient = base::select(forward, term.positive, term.negative);
    if (term.basis == SpeedBasis::constant) {
      sum.dry = sum.dry + coefficient;
    } else if (term.basis == SpeedBasis::linear) {
      sum.viscous = sum.viscous + coefficient;
    } else {
      sum.at_rest = sum.at_rest + coefficient * Number(facts_of(term.basis).at_rest);
    }
  }
  sum.dry = sum.dry + load;
  return sum;
}

/// The sum of the terms that are neither constant nor linear, at a speed of at least 0.
template <class Number, class Mask>
Number varying(const JointOf<Number>& joint, const Mask& forward, const Number& speed) {
  Number sum = 0.0;
  for (const auto& term : joint.friction) {
    if (term.basis == SpeedBasis::constant || term.basis == SpeedBasis::linear) continue;
    sum = sum + base::select(forward, term.positive, term.negative) *
                    basis_value(term.basis, speed, term.shapes.data());
  }
  return sum;
}

}  // namespace jointid::model
