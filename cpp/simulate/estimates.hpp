#pragma once
// A controller's estimates of its joint, and the torque that follows from them.

#include <array>
#include <limits>
#include <string_view>

#include "base/choices.hpp"
#include "base/elementary.hpp"
#include "base/require.hpp"
#include "simulate/trajectory.hpp"

namespace jointid::simulate {

/// The velocity at which friction is compensated. The measured velocity gives no direction while
/// the joint sticks. The desired velocity does.
enum class FrictionVelocity { measured, reference };

/// The last computed share of the static excess, because runs in neighbouring lanes often need the
/// same one.
struct Faded {
  double stribeck = -1.0;
  double velocity = 0.0;
  double share = 1.0;
};

/// A controller's inputs at one instant.
struct ControlInput {
  double time = 0.0;
  double position = 0.0;
  double velocity = 0.0;
  double reading = 0.0;  ///< raw reading of the torque sensor
  Reference wanted{};
  double period = 0.0;  ///< time between instants
  Faded* faded = nullptr;
};

/// Estimates of the joint, output side, SI units.
struct Estimates {
  double inertia = 0.0;  ///< inertia of the drive
  double coulomb = 0.0;
  double static_excess = 0.0;
  double stribeck = 0.0;
  double viscous = 0.0;
  double sensor_gain = 1.0;
  double sensor_offset = 0.0;
  bool torque_feedback = true;  ///< compensate the link's torque that the sensor measures
  FrictionVelocity friction_velocity = FrictionVelocity::measured;

  [[nodiscard]] double friction_speed(const ControlInput& input) const {
    return friction_velocity == FrictionVelocity::reference ? input.wanted.velocity
                                                            : input.velocity;
  }
  [[nodiscard]] double link_torque(const ControlInput& input) const {
    return torque_feedback ? sensor_gain * input.reading + sensor_offset : 0.0;
  }
  [[nodiscard]] double fading(double velocity, Faded* known = nullptr) const {
    if (known == nullptr) return base::exp(-(stribeck * velocity * velocity));
    if (!(known->stribeck == stribeck && known->velocity == velocity)) {
      *known = {stribeck, velocity, base::exp(-(stribeck * velocity * velocity))};
    }
    return known->share;
  }
  void validate_estimates(const base::Requirement& require) const {
    require.at_least_zero("inertia", inertia);
    require.at_least_zero("coulomb", coulomb);
    require.at_least_zero("static", static_excess);
    require.at_least_zero("stribeck", stribeck);
    require.at_least_zero("viscous", viscous);
    require.finite("sensor_gain", sensor_gain);
    require.finite("sensor_offset", sensor_offset);
  }
};

inline double sign_of(double x) {
  return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0);
}

}  // namespace jointid::simulate

template <>
struct jointid::base::Words<jointid::simulate::FrictionVelocity> {
  static constexpr std::string_view field = "friction_velocity";
  static constexpr std::array<std::string_view, 2> all{"measured", "reference"};
};
