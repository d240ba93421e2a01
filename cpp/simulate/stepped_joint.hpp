#pragma once
// A joint that an external caller moves step by step, for example an emulated drive.

#include <cmath>
#include <cstdint>

#include "model/joint.hpp"
#include "simulate/integration_step.hpp"
#include "simulate/sensors.hpp"

namespace jointid::simulate {

/// Initial state and settings of a stepped joint.
struct SteppedSetup {
  model::Joint joint;
  Sensors sensors;
  double gear_ratio = 1.0;
  double sensor_gain = 1.0;
  double sensor_offset = 0.0;
  double period = 1e-3;  ///< time between observations, for the sensors' filter
  double step = 2.5e-4;  ///< largest step of the integration
  double position = 0.0;
  double velocity = 0.0;
  std::uint64_t seed = 0;
};

class SteppedJoint {
 public:
  explicit SteppedJoint(const SteppedSetup& setup);

  /// Holds a torque of the drive for a time, cut at the joint's limit.
  void advance(double torque, double duration);
  /// Returns the values of the sensors; advances their noise and filter.
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
