#pragma once
// Friction of one direction of motion: the dry level that fades with speed, and what viscosity
// adds.

#include "base/lanes.hpp"
#include "model/joint.hpp"

namespace jointid::model {

/// Coefficients in the direction of motion.
template <class Number>
struct DirectedFriction {
  Number coulomb;  ///< with the share that grows with the load
  Number excess;   ///< static friction over Coulomb's
  Number viscous;

  [[nodiscard]] Number breakaway() const { return coulomb + excess; }
  /// The dry level where `fading` of the excess is left.
  [[nodiscard]] Number level(const Number& fading) const { return coulomb + excess * fading; }
};

template <class Number, class Mask>
DirectedFriction<Number> directed(const JointOf<Number>& joint, const Mask& forward,
                                  const Number& load) {
  return {base::select(forward, joint.coulomb_positive, joint.coulomb_negative) + load,
          base::select(forward, joint.static_positive, joint.static_negative),
          base::select(forward, joint.viscous_positive, joint.viscous_negative)};
}

/// The share of the static excess that is left at a speed of at least 0: 1 at rest.
template <class Number>
Number fading(const JointOf<Number>& joint, const Number& speed) {
  switch (joint.decay) {
    case Decay::none:
      return 0.0;
    case Decay::gaussian:
      return base::exp(-(joint.stribeck * speed * speed));
    case Decay::general:
      return base::exp(-base::pow(speed / joint.stribeck_velocity, joint.stribeck_exponent));
  }
  return 0.0;
}

}  // namespace jointid::model
