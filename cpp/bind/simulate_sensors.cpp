#include "bind/simulate.hpp"

namespace jointid::bind {

void bind_sensors(py::module_& m) {
  using simulate::Sensors;
  value(m, "Sensors",
        R"(The sensors of a simulated joint. All effects are off by default: signals are exact.

The torque sensor's gain and offset belong to the joint: torque = gain · reading + offset. Ripple,
non-linearity and noise come first, as torques at the sensor's input. The filter and the converter follow.)",
        Field{"encoder_counts", &Sensors::encoder_counts,
              "Counts per motor revolution: the lines of the encoder times 4; 0: exact position."},
        Field{"velocity", &Sensors::velocity,
              "\"exact\", \"difference\" (of the last two positions) or \"counts\" (6.3.1: over "
              "the time in which `velocity_counts` arrived, held until the next estimate)."},
        Field{"velocity_counts", &Sensors::velocity_counts,
              "Least number of counts for a new estimate of the velocity."},
        Field{"velocity_time", &Sensors::velocity_time,
              "Time after which a new estimate is made in any case [s]."},
        Field{"torque_noise", &Sensors::torque_noise,
              "Standard deviation at the torque sensor's input [N·m]; Gaussian, in each sample."},
        Field{"ripple", &Sensors::ripple, "Amplitude of a strain-wave gear's ripple [N·m]."},
        Field{"ripple_order", &Sensors::ripple_order, "Order of the ripple in the motor's angle."},
        Field{"ripple_phase", &Sensors::ripple_phase, "[rad]"},
        Field{"nonlinearity", &Sensors::nonlinearity,
              "Largest deviation as a share of the full scale; a cubic that is 0 at 0 and at full "
              "scale."},
        Field{"full_scale", &Sensors::full_scale, "Full scale of the torque sensor [N·m]."},
        Field{"filter_order", &Sensors::filter_order,
              "Low-pass filter on the reading: 0 (none), 1, or 2 equal poles."},
        Field{"filter_frequency", &Sensors::filter_frequency,
              "Frequency of the filter's poles [Hz]."},
        Field{"converter_bits", &Sensors::converter_bits,
              "Bits of the analog-to-digital converter; 0: none."},
        Field{"converter_range", &Sensors::converter_range,
              "Range of the converter: it takes readings from -range to range."},
        Field{"converter_noise", &Sensors::converter_noise,
              "Standard deviation of one conversion, in steps of the converter."},
        Field{"converter_samples", &Sensors::converter_samples,
              "Conversions averaged for one reading (oversampling)."});
}

}  // namespace jointid::bind
