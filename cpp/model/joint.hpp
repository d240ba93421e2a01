#pragma once
// A joint as it is simulated: the drive's inertia, dry and viscous friction, what hangs on it. For
// one number or for several lanes: the structure (decay, bristles, harmonics) is common to all
// lanes, the numbers are not.

#include <array>
#include <vector>

#include "base/choices.hpp"

namespace jointid::model {

/// How the static excess over Coulomb friction fades with speed.
enum class Decay {
  none,      ///< no static excess
  gaussian,  ///< (4-1): exp(-stribeck v^2)
  general,   ///< (2-3): exp(-|v / stribeck_velocity|^stribeck_exponent)
};

/// Torque over an angle: cosine and sine part [N·m] of an order [1] of the joint's angle.
template <class Number>
struct HarmonicOf {
  double order = 1.0;
  Number cos = 0.0;
  Number sin = 0.0;
};

/// What the torque of gravity of one mass is: weight · cos(q + angle).
template <class Number>
struct WeightOf {
  Number torque = 0.0;  ///< mass · gravity · distance [N·m]
  Number angle = 0.0;   ///< [rad]
};

/// Output side of the gear, SI; coefficients of friction for each direction.
template <class Number>
struct JointOf {
  Number inertia = 1.0;       ///< of the drive
  Number link_inertia = 0.0;  ///< behind the torque sensor
  Number load = 0.0;          ///< constant torque behind the sensor that resists positive motion
  Number torque_offset = 0.0;
  Number torque_limit = 1e300;  ///< of the drive, on the magnitude

  Decay decay = Decay::gaussian;
  Number coulomb_positive = 0.0;
  Number coulomb_negative = 0.0;
  Number static_positive = 0.0;
  Number static_negative = 0.0;
  Number viscous_positive = 0.0;
  Number viscous_negative = 0.0;
  Number stribeck = 0.0;
  Number stribeck_velocity = 1.0;
  Number stribeck_exponent = 1.0;
  Number load_friction = 0.0;  ///< dry friction per torque of the drive

  bool bristles = false;  ///< Dahl and LuGre: friction behind a spring
  Number bristle_stiffness = 0.0;
  Number bristle_damping = 0.0;

  std::vector<WeightOf<Number>> weights{};
  std::vector<HarmonicOf<Number>> harmonics{};  ///< in the drive: the sensor does not see them

  void validate() const;
};

using Joint = JointOf<double>;
using Weight = WeightOf<double>;
using Harmonic = HarmonicOf<double>;

/// Calls visit(number of a, number of b) for all numbers of two joints of one structure.
template <class A, class B, class Visit>
void each_number(A& a, B& b, Visit visit) {
  visit(a.inertia, b.inertia);
  visit(a.link_inertia, b.link_inertia);
  visit(a.load, b.load);
  visit(a.torque_offset, b.torque_offset);
  visit(a.torque_limit, b.torque_limit);
  visit(a.coulomb_positive, b.coulomb_positive);
  visit(a.coulomb_negative, b.coulomb_negative);
  visit(a.static_positive, b.static_positive);
  visit(a.static_negative, b.static_negative);
  visit(a.viscous_positive, b.viscous_positive);
  visit(a.viscous_negative, b.viscous_negative);
  visit(a.stribeck, b.stribeck);
  visit(a.stribeck_velocity, b.stribeck_velocity);
  visit(a.stribeck_exponent, b.stribeck_exponent);
  visit(a.load_friction, b.load_friction);
  visit(a.bristle_stiffness, b.bristle_stiffness);
  visit(a.bristle_damping, b.bristle_damping);
  for (std::size_t i = 0; i < a.weights.size(); ++i) {
    visit(a.weights[i].torque, b.weights[i].torque);
    visit(a.weights[i].angle, b.weights[i].angle);
  }
  for (std::size_t i = 0; i < a.harmonics.size(); ++i) {
    visit(a.harmonics[i].cos, b.harmonics[i].cos);
    visit(a.harmonics[i].sin, b.harmonics[i].sin);
  }
}

/// Whether two joints differ in numbers only, so that they can be lanes of one.
bool same_structure(const Joint& a, const Joint& b);

}  // namespace jointid::model

template <>
struct jointid::base::Words<jointid::model::Decay> {
  static constexpr std::string_view field = "decay";
  static constexpr std::array<std::string_view, 3> all{"none", "gaussian", "general"};
};
