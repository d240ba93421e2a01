#include "identify/balance/interval_residual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/scans.hpp"
#include "identify/balance/friction_nodes.hpp"
#include "identify/balance/quadrature.hpp"

namespace jointid::identify::detail {

namespace {

using Samples = std::array<double, kMostIntervals + 1>;

constexpr std::size_t kTogether = 64;  // samples per check whether all are too fast for a decay

/// A friction's coefficient in each direction of motion.
struct Sides {
  double forward;
  double backward;  ///< of the signed friction: below 0 if it opposes the motion
};

Sides sides_of(const KnownTerm& known) {
  const auto direction = known.term.direction;
  return {direction == model::Direction::negative ? 0.0 : known.coefficient,
          direction == model::Direction::positive ? 0.0 : -known.coefficient};
}

JOINTID_CLONES void add_signs(const double* velocity, std::size_t count, double forward,
                              double backward, double* sum) {
  for (std::size_t i = 0; i < count; ++i) {
    const double v = velocity[i];
    sum[i] += (v > 0.0 ? forward : 0.0) + (v < 0.0 ? backward : 0.0);
  }
}

JOINTID_CLONES void add_decays(const double* velocity, std::size_t count, double rate,
                               double forward, double backward, double* sum) {
  for (std::size_t i = 0; i < count; ++i) {
    const double v = velocity[i];
    const double side = (v > 0.0 ? forward : 0.0) + (v < 0.0 ? backward : 0.0);
    sum[i] += side * base::exp_decay(rate * v * v);
  }
}

JOINTID_CLONES void add_general(const double* velocity, std::size_t count, const double* shapes,
                                double origin, double forward, double backward, double* sum) {
  const double scale = shapes[0];
  const double exponent = shapes[1];
  for (std::size_t i = 0; i < count; ++i) {
    const double v = velocity[i];
    const double side = (v > 0.0 ? forward : 0.0) + (v < 0.0 ? backward : 0.0);
    const double scaled = model::log_speed(std::fabs(v)) - origin;
    sum[i] += side * model::general_decay(scaled, scale, exponent).value;
  }
}

JOINTID_CLONES void set(double* values, std::size_t count, double value) {
  for (std::size_t i = 0; i < count; ++i) values[i] = value;
}

JOINTID_CLONES void add_scaled(const double* signal, std::size_t count, double factor,
                               double* sum) {
  for (std::size_t i = 0; i < count; ++i) sum[i] += factor * signal[i];
}

/// Subtracts the contribution of a signal's change over each interval.
JOINTID_CLONES void take_changes(const double* signal, std::size_t count, double factor,
                                 double* result) {
  for (std::size_t i = 0; i < count; ++i) result[i] -= factor * (signal[i + 1] - signal[i]);
}

/// Subtracts the trapezoids of two sums at the samples.
JOINTID_CLONES void take_trapezoids(const double* one, const double* other, const double* time,
                                    std::size_t count, double* result) {
  for (std::size_t i = 0; i < count; ++i) {
    const double ends = (one[i] + one[i + 1]) + (other[i] + other[i + 1]);
    result[i] -= 0.5 * ends * (time[i + 1] - time[i]);
  }
}

JOINTID_CLONES void hold(const double* torque, const double* time, std::size_t count,
                         double* result) {
  for (std::size_t i = 0; i < count; ++i) result[i] = torque[i] * (time[i + 1] - time[i]);
}

/// Adds a friction at the samples, and its value just above zero speed to `at_rest`.
void add_friction(const KnownTerm& known, const double* velocity, std::size_t count, double* sum,
                  Sides& at_rest) {
  const auto [forward, backward] = sides_of(known);
  const double* shapes = known.shapes.data();
  switch (known.term.basis) {
    case model::SpeedBasis::linear:
      for (std::size_t i = 0; i < count; ++i) {
        sum[i] += std::fabs(velocity[i]) * (velocity[i] > 0.0 ? forward : backward);
      }
      break;
    case model::SpeedBasis::constant:
      add_signs(velocity, count, forward, backward, sum);
      break;
    case model::SpeedBasis::gaussian:
      for (std::size_t i = 0; i < count; i += kTogether) {
        const std::size_t some = std::min(kTogether, count - i);
        if (has_vanished(shapes[0], velocity + i, some)) continue;
        add_decays(velocity + i, some, shapes[0], forward, backward, sum + i);
      }
      break;
    case model::SpeedBasis::general:
      add_general(velocity, count, shapes, base::log(shapes[0]), forward, backward, sum);
      break;
    default:
      for (std::size_t i = 0; i < count; ++i) {
        const double v = velocity[i];
        const double side = (v > 0.0 ? forward : 0.0) + (v < 0.0 ? backward : 0.0);
        sum[i] += side * model::basis_value(known.term.basis, std::fabs(v), shapes);
      }
  }
  const double rest = model::facts_of(known.term.basis).at_rest;
  at_rest.forward += rest * forward;
  at_rest.backward += rest * backward;
}

/// Corrects the trapezoids of friction where the joint reverses within an interval: there friction
/// changes its sign at the zero crossing.
void part_reversals(const double* velocity, const double* time, const double* friction,
                    std::size_t count, const Sides& at_rest, double* result) {
  for (std::size_t i = 0; i < count;) {
    const std::size_t run = base::one_sided(velocity + i, count + 1 - i);
    if (run == 0) {  // at rest, where friction is 0 at the interval's end
      ++i;
      continue;
    }
    i += run;
    if (i > count || velocity[i] == 0.0) continue;
    const double before = std::fabs(shares(velocity[i - 1], velocity[i]).before);
    const bool forward = velocity[i - 1] > 0.0;
    const double first = friction[i - 1] + (forward ? at_rest.forward : at_rest.backward);
    const double second = friction[i] + (forward ? at_rest.backward : at_rest.forward);
    const double parted = before * first + (1.0 - before) * second;
    const double whole = friction[i - 1] + friction[i];
    result[i - 1] -= 0.5 * (parted - whole) * (time[i] - time[i - 1]);
  }
}

}  // namespace

void interval_residuals(const std::vector<KnownTerm>& terms, double gear_ratio,
                        const RecordingView& r, std::int64_t first, std::size_t count,
                        double* result) {
  const double* time = r.time.data() + first;
  const double* velocity = r.velocity.data() + first;
  const double* position = r.position.data() + first;
  const double* torque = r.torque.data() + first;
  const std::size_t samples = count + 1;
  Samples smooth;
  Samples friction;
  set(smooth.data(), samples, 0.0);
  set(friction.data(), samples, 0.0);
  Sides at_rest{0.0, 0.0};
  if (r.torque_hold == Hold::linear) {
    set(result, count, 0.0);
    add_scaled(torque, samples, -1.0, smooth.data());
  } else {
    hold(torque, time, count, result);
  }
  for (const auto& known : terms) {
    const double coefficient = known.coefficient;
    if (coefficient == 0.0) continue;
    switch (known.term.integral) {
      case Integral::velocity_change:
        take_changes(velocity, count, coefficient, result);
        break;
      case Integral::displacement:
        take_changes(position, count, coefficient, result);
        break;
      case Integral::duration:
        take_changes(time, count, coefficient, result);
        break;
      case Integral::own:
        take_changes(own_series(r, known.term.name).data() + first, count, coefficient, result);
        break;
      case Integral::sensor:
        add_scaled(r.sensor.data() + first, samples, coefficient, smooth.data());
        break;
      case Integral::cosine:
      case Integral::sine: {
        const bool motor = known.term.harmonic == Harmonic::motor;
        const double frequency = known.term.order * (motor ? gear_ratio : 1.0);
        Samples angle;
        Samples cosine;
        Samples sine;
        for (std::size_t i = 0; i < samples; ++i) angle[i] = frequency * position[i];
        base::circle(angle.data(), samples, cosine.data(), sine.data());
        const auto& wanted = known.term.integral == Integral::cosine ? cosine : sine;
        add_scaled(wanted.data(), samples, coefficient, smooth.data());
        break;
      }
      case Integral::friction:
        add_friction(known, velocity, samples, friction.data(), at_rest);
        break;
      case Integral::load_friction:
      case Integral::link_friction:
        throw std::logic_error("load friction has no integral of its own");
    }
  }
  take_trapezoids(smooth.data(), friction.data(), time, count, result);
  part_reversals(velocity, time, friction.data(), count, at_rest, result);
}

}  // namespace jointid::identify::detail
