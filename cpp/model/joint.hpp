#pragma once
// A simulated joint: the drive's inertia, its friction and its load. For one number or for several
// lanes. All lanes share the structure (friction bases, bristles, harmonics), but not the numbers.

#include <array>
#include <vector>

#include "model/friction.hpp"

namespace jointid::model {

/// One term of the friction: coefficients for each direction, and the basis with its shapes.
template <class Number>
struct FrictionOf {
  SpeedBasis basis = SpeedBasis::constant;
  Number positive = 0.0;
  Number negative = 0.0;
  std::array<Number, kMostShapes> shapes{};
};

/// Torque over an angle: cosine and sine part [N·m] of an order [1] of the joint's angle.
template <class Number>
struct HarmonicOf {
  double order = 1.0;
  Number cos = 0.0;
  Number sin = 0.0;
};

/// Gravity torque of one mass: weight · cos(q + angle).
template <class Number>
struct WeightOf {
  Number torque = 0.0;  ///< mass · gravity · distance [N·m]
  Number angle = 0.0;   ///< [rad]
};

/// Output side of the gear, SI units.
template <class Number>
struct JointOf {
  Number inertia = 1.0;       ///< of the drive
  Number link_inertia = 0.0;  ///< behind the torque sensor
  Number load = 0.0;          ///< constant torque behind the sensor that resists positive motion
  Number torque_offset = 0.0;
  Number torque_limit = 1e300;  ///< of the drive, limit on the magnitude

  std::vector<FrictionOf<Number>> friction{};
  Number load_friction = 0.0;  ///< dry friction per torque of the drive

  bool bristles = false;  ///< Dahl and LuGre: friction behind a spring
  Number bristle_stiffness = 0.0;
  Number bristle_damping = 0.0;

  std::vector<WeightOf<Number>> weights{};
  std::vector<HarmonicOf<Number>> harmonics{};  ///< in the drive: the sensor does not measure them

  void validate() const;
};

using Joint = JointOf<double>;
using Friction = FrictionOf<double>;
using Weight = WeightOf<double>;
using Harmonic = HarmonicOf<double>;

/// Calls visit(number of a, number of b) for all numbers of two joints with the same structure.
template <class A, class B, class Visit>
void each_number(A& a, B& b, Visit visit) {
  visit(a.inertia, b.inertia);
  visit(a.link_inertia, b.link_inertia);
  visit(a.load, b.load);
  visit(a.torque_offset, b.torque_offset);
  visit(a.torque_limit, b.torque_limit);
  visit(a.load_friction, b.load_friction);
  visit(a.bristle_stiffness, b.bristle_stiffness);
  visit(a.bristle_damping, b.bristle_damping);
  for (std::size_t i = 0; i < a.friction.size(); ++i) {
    visit(a.friction[i].positive, b.friction[i].positive);
    visit(a.friction[i].negative, b.friction[i].negative);
    for (std::size_t s = 0; s < kMostShapes; ++s)
      visit(a.friction[i].shapes[s], b.friction[i].shapes[s]);
  }
  for (std::size_t i = 0; i < a.weights.size(); ++i) {
    visit(a.weights[i].torque, b.weights[i].torque);
    visit(a.weights[i].angle, b.weights[i].angle);
  }
  for (std::size_t i = 0; i < a.harmonics.size(); ++i) {
    visit(a.harmonics[i].cos, b.harmonics[i].cos);
    visit(a.harmonics[i].sin, b.harmonics[i].sin);
  }
}

/// Whether two joints differ only in numbers, so that they can be lanes of one joint.
bool same_structure(const Joint& a, const Joint& b);

}  // namespace jointid::model
