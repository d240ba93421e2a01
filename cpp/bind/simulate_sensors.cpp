#include "bind/simulate.hpp"

namespace jointid::bind {

void bind_sensors(py::module_& m) {
  using simulate::Sensors;
  value(
      m, "Sensors",
      R"(The sensors of a simulated joint. All effects are off by default: exact signals.

The torque sensor's gain and offset are the joint's: torque = gain · reading + offset. Its chain is
ripple, non-linearity and noise as torques at its input, then the filter, then the converter.)",
      Field{"encoder_counts", &Sensors::encoder_counts,
            "Counts of a motor turn, the lines of the encoder times 4; 0: exact position."},
      Field{"velocity", &Sensors::velocity,
            "\"exact\", \"difference\" (of the last two positions) or \"counts\" (6.3.1: over the "
            "time in which `velocity_counts` came in, held until then)."},
      Field{"velocity_counts", &Sensors::velocity_counts,
            "Counts at least, for a new estimate of the velocity."},
      Field{"velocity_time", &Sensors::velocity_time,
            "After which a new estimate is made in any case [s]."},
      Field{"torque_noise", &Sensors::torque_noise,
            "Standard deviation at the torque sensor's input [N·m], Gaussian, in each sample."},
      Field{"ripple", &Sensors::ripple, "Amplitude [N·m] of a strain-wave gear's ripple."},
      Field{"ripple_order", &Sensors::ripple_order, "Of the motor's angle."},
      Field{"ripple_phase", &Sensors::ripple_phase, "[rad]"},
      Field{"nonlinearity", &Sensors::nonlinearity,
            "Largest deviation as a share of the full scale: a cubic, 0 at 0 and full scale."},
      Field{"full_scale", &Sensors::full_scale, "Of the torque sensor [N·m]."},
      Field{"filter_order", &Sensors::filter_order,
            "Low-pass on the reading: 0 (none), 1, or 2 equal poles."},
      Field{"filter_frequency", &Sensors::filter_frequency, "Of its poles [Hz]."},
      Field{"converter_bits", &Sensors::converter_bits,
            "Of the analog-to-digital converter; 0: none."},
      Field{"converter_range", &Sensors::converter_range,
            "It takes readings from -range to range."},
      Field{"converter_noise", &Sensors::converter_noise,
            "Standard deviation of one conversion, in steps of the converter."},
      Field{"converter_samples", &Sensors::converter_samples,
            "Conversions averaged for one reading (over-sampling)."});
}

}  // namespace jointid::bind
