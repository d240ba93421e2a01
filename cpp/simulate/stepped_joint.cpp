#include "simulate/stepped_joint.hpp"

#include <algorithm>
#include <stdexcept>

#include "base/require.hpp"

namespace jointid::simulate {

SteppedJoint::SteppedJoint(const SteppedSetup& setup)
    : joint_(setup.joint),
      sensors_(setup.sensors, setup.gear_ratio, setup.sensor_gain, setup.sensor_offset,
               setup.period, setup.seed),
      step_(setup.step) {
  const base::Requirement require("SteppedJoint");
  joint_.validate();
  setup.sensors.validate();
  require.above_zero("period", setup.period);
  require.above_zero("step", setup.step);
  require.finite("position", setup.position);
  require.finite("velocity", setup.velocity);
  require.that(setup.gear_ratio != 0.0 && std::isfinite(setup.gear_ratio), "gear_ratio",
               setup.gear_ratio, "finite and not 0");
  require.that(setup.sensor_gain != 0.0 && std::isfinite(setup.sensor_gain), "sensor_gain",
               setup.sensor_gain, "finite and not 0");
  motion_.position = setup.position;
  motion_.velocity = setup.velocity;
  motion_.varying = model::varying(joint_, !(motion_.velocity < 0.0), std::fabs(motion_.velocity));
}

void SteppedJoint::advance(double torque, double duration) {
  const base::Requirement require("SteppedJoint");
  require.finite("torque", torque);
  require.that(duration >= 0.0 && duration < 1e6, "duration", duration, "0 to 1e6");
  torque_ = std::clamp(torque, -joint_.torque_limit, joint_.torque_limit);
  if (duration == 0.0) return;
  const auto steps = static_cast<long>(std::ceil(duration / step_ - 1e-9));
  const double each = duration / static_cast<double>(steps);
  for (long i = 0; i < steps; ++i) simulate::advance(joint_, motion_, torque_, each);
  time_ += duration;
}

double SteppedJoint::link_torque() const {
  return dynamics(joint_, motion_, torque_).link_torque;
}

Observation SteppedJoint::observe() {
  return sensors_.observe({time_, motion_.position, motion_.velocity, link_torque()});
}

}  // namespace jointid::simulate
