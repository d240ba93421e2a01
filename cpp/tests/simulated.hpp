#pragma once
// The thesis's joint with its controller, for the checks of the simulator.

#include "simulate/simulator.hpp"

namespace jointid::tests {

inline constexpr double kHalfPi = 0x1.921fb54442d18p+0;

inline simulate::Setup thesis_setup(double angle = -kHalfPi) {
  simulate::Setup setup;
  model::Joint& joint = setup.joint;
  joint.inertia = 2.472e-4 * 101.0 * 101.0;
  joint.link_inertia = 0.25;
  joint.weights = {{3.0 * 9.817 * 0.25, angle}};
  joint.friction = {{model::SpeedBasis::constant, 25.0, 25.0},
                    {model::SpeedBasis::gaussian, 20.0, 20.0, {100.0}},
                    {model::SpeedBasis::linear, 20.0, 20.0}};
  joint.torque_limit = 160.0;
  setup.gear_ratio = 101.0;
  setup.sensor_gain = 2.4;
  setup.sensor_offset = 15.0;
  simulate::AdaptiveRobust law;
  law.inertia = joint.inertia;
  law.coulomb = 15.0;
  law.static_excess = 10.0;
  law.stribeck = 150.0;
  law.viscous = 10.0;
  law.sensor_gain = 1.5;
  setup.controller = law;
  return setup;
}

/// (6-1): amplitude in degrees, seconds per cycle.
inline simulate::Trajectory thesis_trajectory(double degrees, double cycle, double duration) {
  const double size = degrees / 90.0 * kHalfPi / 1.3;
  const double rate = 4.0 * kHalfPi / cycle;
  return simulate::Trajectory::multisine(Eigen::Vector2d(size, -0.5 * size),
                                         Eigen::Vector2d(rate, 2.0 * rate), Eigen::Vector2d::Zero(),
                                         0.0, duration);
}

}  // namespace jointid::tests
