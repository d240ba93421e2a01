#pragma once
// A joint that is moved step by step from outside: behind an emulated drive, for one.

#include <cmath>
#include <cstdint>

#include "model/joint.hpp"
#include "simulate/integration_step.hpp"
#include "simulate/sensors.hpp"

namespace jointid::simulate {

/// What a stepped joint starts from.
struct SteppedSetup {
  model::Joint joint;
  Sensors sensors;
  double gear_ratio = 1.0;
  double sensor_gain = 1.0;
  double sensor_offset = 0.0;
  double period = 1e-3;  ///< between observations, for the sensors' filter
  double step = 2.5e-4;  ///< of the integration, at most
  double position = 0.0;
  double velocity = 0.0;
  std::uint64_t seed = 0;
};

class SteppedJoint {
 public:
  explicit SteppedJoint(const SteppedSetup& setup);

  /// The drive's torque, held for a time; cut at the joint's limit.
  void advance(double torque, double duration);
  /// What the sensors show now; advances their noise and filter.
  Observation observe();

  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double position() const { return motion_.position; }
  [[nodiscard]] double velocity() const { return motion_.velocity; }
  [[nodiscard]] double link_torque() const;

 private:
  model::Joint joint_;
  SensorChain sensors_;
  MotionOf<double> motion_{};
  double step_;
  double time_ = 0.0;
  double torque_ = 0.0;
};

}  // namespace jointid::simulate
