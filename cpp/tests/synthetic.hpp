#pragma once
// Recordings made from known parameters: piecewise linear velocity, and in each sample interval the
// torque with the integral of the model. The arithmetic is written a second time, plainly and in
// long double, so that it checks the core's.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "base/random.hpp"
#include "identify/recording/recording.hpp"

namespace jointid::tests {

struct Truth {
  double inertia = 2.5;
  double coulomb = 25.0;
  double static_excess = 15.0;
  double viscous = 18.0;
  double torque_offset = 0.0;
  double stribeck = 60.0;
  double sensor_gain = 1.4;
  double sensor_offset = -3.0;
};

inline long double sign_of(long double v) {
  return v > 0 ? 1 : (v < 0 ? -1 : 0);
}

/// Integral of sgn v h(|v|) over one interval of linear velocity v0 to v1: trapezoidal rule on the
/// speed, divided at the reversal if there is one.
template <class Speed>
long double friction_over(long double v0, long double v1, long double step, Speed h) {
  if (v0 * v1 >= 0) return step * (sign_of(v0) * h(v0) + sign_of(v1) * h(v1)) / 2;
  const long double before = step * v0 / (v0 - v1);
  return (sign_of(v0) * before * (h(v0) + h(0)) + sign_of(v1) * (step - before) * (h(0) + h(v1))) /
         2;
}

/// Two sines, so that all columns differ; no sample is at rest. Time steps vary with `jitter`.
inline identify::Recording moving(int samples, double period, bool jitter, std::uint64_t seed) {
  identify::Recording r;
  r.time.resize(samples);
  r.position.resize(samples);
  r.velocity.resize(samples);
  base::Random random(seed, 0, 0, 0);
  const double phase = 6.28 * random.uniform();
  double time = 0.0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    r.time[k] = time;
    r.position[k] = 0.5 * std::sin(4.1 * time + phase) + 0.2 * std::sin(9.7 * time);
    r.velocity[k] = 2.05 * std::cos(4.1 * time + phase) + 1.94 * std::cos(9.7 * time);
    time += period * (jitter ? 0.5 + random.uniform() : 1.0);
  }
  return r;
}

/// Fills torque (held) and sensor (`units` per newton metre) such that the model holds in every
/// interval.
inline void add_torque(identify::Recording& r, const Truth& truth, bool with_sensor,
                       double units = 1.0) {
  const Eigen::Index n = r.samples();
  r.torque = Eigen::VectorXd::Zero(n);
  r.torque_hold = identify::Hold::zero_order;
  if (with_sensor) r.sensor.resize(n);
  for (Eigen::Index k = 0; k < n && with_sensor; ++k) {
    r.sensor[k] = units * (8.0 * std::sin(2.3 * r.time[k]) + 5.0 * std::cos(6.1 * r.time[k] + 1.0));
  }
  const auto one = [](long double) { return 1.0L; };
  const auto decay = [&](long double v) { return std::exp(-truth.stribeck * v * v); };
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const long double v0 = r.velocity[k];
    const long double v1 = r.velocity[k + 1];
    const long double step = static_cast<long double>(r.time[k + 1]) - r.time[k];
    long double sum =
        truth.inertia * (v1 - v0) + truth.coulomb * friction_over(v0, v1, step, one) +
        truth.static_excess * friction_over(v0, v1, step, decay) +
        truth.viscous * (static_cast<long double>(r.position[k + 1]) - r.position[k]) +
        truth.torque_offset * step;
    if (with_sensor) {
      const long double reading = static_cast<long double>(r.sensor[k]) + r.sensor[k + 1];
      sum += step * (truth.sensor_gain * reading / 2 + truth.sensor_offset);
    }
    r.torque[k] = static_cast<double>(sum / step);
  }
}

/// Adds uniform noise to the torque, so that the penalty is not zero at the optimum.
inline void add_noise(identify::Recording& r, double amplitude, std::uint64_t seed) {
  base::Random random(seed, 1, 0, 0);
  for (double& value : r.torque) value += amplitude * (2.0 * random.uniform() - 1.0);
}

}  // namespace jointid::tests
