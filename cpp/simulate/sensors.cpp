#include "simulate/sensors.hpp"

#include <algorithm>
#include <cmath>

#include "base/elementary.hpp"
#include "base/require.hpp"
#include "simulate/gaussian.hpp"

namespace jointid::simulate {

namespace {

constexpr double kTurn = 0x1.921fb54442d18p+2;
constexpr std::uint32_t kTorqueNoise = 0;
constexpr std::uint32_t kConverterNoise = 1;

}  // namespace

void Sensors::validate() const {
  const base::Requirement require("Sensors");
  require.at_least_zero("encoder_counts", encoder_counts);
  require.that(velocity_counts >= 1, "velocity_counts", velocity_counts, "at least 1");
  require.above_zero("velocity_time", velocity_time);
  require.at_least_zero("torque_noise", torque_noise);
  require.at_least_zero("ripple", ripple);
  require.above_zero("ripple_order", ripple_order);
  require.finite("ripple_phase", ripple_phase);
  require.at_least_zero("nonlinearity", nonlinearity);
  require.above_zero("full_scale", full_scale);
  require.that(filter_order >= 0 && filter_order <= 2, "filter_order", filter_order, "0, 1 or 2");
  require.above_zero("filter_frequency", filter_frequency);
  require.that(converter_bits >= 0 && converter_bits <= 32, "converter_bits", converter_bits,
               "0 to 32");
  require.above_zero("converter_range", converter_range);
  require.at_least_zero("converter_noise", converter_noise);
  require.that(converter_samples >= 1 && converter_samples <= 4096, "converter_samples",
               converter_samples, "1 to 4096");
}

SensorChain::SensorChain(const Sensors& sensors, double gear_ratio, double gain, double offset,
                         double period, std::uint64_t seed)
    : sensors_(sensors),
      torque_{gain,
              offset,
              sensors.ripple,
              sensors.ripple_order,
              sensors.ripple_phase,
              sensors.nonlinearity,
              sensors.full_scale},
      gear_ratio_(gear_ratio),
      resolution_(sensors.encoder_counts > 0.0
                      ? kTurn / (sensors.encoder_counts * std::fabs(gear_ratio))
                      : 0.0),
      share_(1.0 - base::exp(-kTurn * sensors.filter_frequency * period)),
      seed_(seed) {}

Observation SensorChain::observe(const Seen& seen) {
  Observation shown;
  const double counts = resolution_ > 0.0 ? std::floor(seen.position / resolution_ + 0.5) : 0.0;
  shown.position = resolution_ > 0.0 ? counts * resolution_ : seen.position;
  shown.velocity = velocity(seen.time, shown.position, counts, seen.velocity);
  const double noise = sensors_.torque_noise > 0.0
                           ? sensors_.torque_noise * gaussian(seed_, kTorqueNoise, sample_, 0)
                           : 0.0;
  const double raw = torque_.reading(seen.link_torque, gear_ratio_ * seen.position, noise);
  shown.reading = converted(filtered(raw), sample_);
  ++sample_;
  return shown;
}

double SensorChain::velocity(double time, double position, double counts, double exact) {
  if (sensors_.velocity == VelocityEstimate::exact) return exact;
  if (sample_ > 0) {
    const double elapsed = time - last_time_;
    if (sensors_.velocity == VelocityEstimate::counts) {
      // Without an encoder every change is a count.
      const double came = resolution_ > 0.0 ? std::fabs(counts - last_counts_)
                                            : static_cast<double>(sensors_.velocity_counts);
      // Half a nanosecond, because sums of periods miss the limit by rounding.
      if (came < sensors_.velocity_counts && elapsed < sensors_.velocity_time - 5e-10) {
        return last_velocity_;
      }
    }
    last_velocity_ = (position - last_position_) / elapsed;
  }
  last_time_ = time;
  last_position_ = position;
  last_counts_ = counts;
  return last_velocity_;
}

double SensorChain::filtered(double reading) {
  double value = reading;
  for (int stage = 0; stage < sensors_.filter_order; ++stage) {
    double& state = filter_[static_cast<std::size_t>(stage)];
    state = sample_ == 0 ? value : state + share_ * (value - state);
    value = state;
  }
  return value;
}

double SensorChain::converted(double reading, std::uint32_t sample) const {
  if (sensors_.converter_bits == 0) return reading;
  const double largest = std::ldexp(1.0, sensors_.converter_bits - 1);
  const double step = sensors_.converter_range / largest;
  double sum = 0.0;
  for (int i = 0; i < sensors_.converter_samples; ++i) {
    double level = reading / step;
    if (sensors_.converter_noise > 0.0) {
      level += sensors_.converter_noise *
               gaussian(seed_, kConverterNoise, sample, static_cast<std::uint32_t>(i));
    }
    sum += std::clamp(std::floor(level + 0.5), -largest, largest - 1.0);
  }
  return step * sum / sensors_.converter_samples;
}

}  // namespace jointid::simulate
