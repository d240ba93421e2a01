#pragma once
// Measurements of a joint for a controller and a recording: encoder, velocity estimator, torque
// sensor, filter, converter. All effects are off by default: signals are exact.

#include <array>
#include <cstdint>
#include <string_view>

#include "base/choices.hpp"
#include "model/torque_sensor.hpp"

namespace jointid::simulate {

enum class VelocityEstimate {
  exact,
  difference,  ///< difference of the last two positions
  counts,      ///< (6.3.1) over the time in which a least number of counts arrived
};

struct Sensors {
  double encoder_counts = 0.0;  ///< counts per motor revolution; 0: exact position
  VelocityEstimate velocity = VelocityEstimate::exact;
  int velocity_counts = 5;       ///< least number of counts for a new estimate
  double velocity_time = 0.010;  ///< time after which a new estimate is made in any case [s]

  double torque_noise = 0.0;  ///< standard deviation at the torque sensor's input [N·m]
  double ripple = 0.0;
  double ripple_order = 2.0;
  double ripple_phase = 0.0;
  double nonlinearity = 0.0;
  double full_scale = 650.0;
  int filter_order = 0;              ///< order of the filter: 0 (none), 1, 2
  double filter_frequency = 5000.0;  ///< [Hz]

  int converter_bits = 0;        ///< bits of the converter; 0: none
  double converter_range = 1.0;  ///< the converter takes readings from -range to range
  double converter_noise = 0.0;  ///< noise of one conversion, in steps
  int converter_samples = 1;     ///< conversions averaged for one reading

  void validate() const;
};

/// Values of the sensors at one instant.
struct Observation {
  double position = 0.0;
  double velocity = 0.0;
  double reading = 0.0;
};

/// The true state that the sensors measure.
struct Seen {
  double time = 0.0;
  double position = 0.0;
  double velocity = 0.0;
  double link_torque = 0.0;
};

/// Sensors of one joint in one run. The noise depends only on seed and sample number.
class SensorChain {
 public:
  SensorChain(const Sensors& sensors, double gear_ratio, double gain, double offset, double period,
              std::uint64_t seed);
  Observation observe(const Seen& seen);

 private:
  double velocity(double time, double position, double counts, double exact);
  double filtered(double reading);
  double converted(double reading, std::uint32_t sample) const;

  Sensors sensors_;
  model::TorqueSensor torque_;
  double gear_ratio_;
  double resolution_;  ///< [rad] at the output; 0: exact
  double share_;       ///< share of the distance to its input that the filter moves in a period
  std::uint64_t seed_;
  std::uint32_t sample_ = 0;
  double last_time_ = 0.0;
  double last_position_ = 0.0;
  double last_counts_ = 0.0;
  double last_velocity_ = 0.0;
  std::array<double, 2> filter_{};
};

}  // namespace jointid::simulate

template <>
struct jointid::base::Words<jointid::simulate::VelocityEstimate> {
  static constexpr std::string_view field = "Sensors.velocity";
  static constexpr std::array<std::string_view, 3> all{"exact", "difference", "counts"};
};
