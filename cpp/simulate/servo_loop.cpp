#include "simulate/servo_loop.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "base/require.hpp"
#include "simulate/integration_step.hpp"

namespace jointid::simulate {

namespace {

constexpr double kFarthest = 1e6;  // [rad]; larger motions have no meaning

/// The duty that acts now: the latest one older than the delay.
class DelayedDuty {
 public:
  explicit DelayedDuty(double delay) : delay_(delay) {}

  double at(double time, double duty) {
    if (delay_ <= 0.0) return duty;
    coming_.emplace_back(time, duty);
    while (!coming_.empty() && coming_.front().first <= time - delay_ + kSameTime) {
      acting_ = coming_.front().second;
      coming_.pop_front();
    }
    return acting_;
  }

 private:
  static constexpr double kSameTime = 1e-12;
  double delay_;
  double acting_ = 0.0;
  std::deque<std::pair<double, double>> coming_;
};

/// Gear, motor and joint over one step with a held duty.
class Servo {
 public:
  explicit Servo(const ServoLoop& loop) : loop_(loop), driven_(loop.joint), free_(loop.joint) {
    driven_.friction.push_back({model::SpeedBasis::linear, loop.back_emf, loop.back_emf});
    motion.position = loop.position;
    motion.velocity = loop.velocity;
    motion.varying = model::varying(loop.joint, !(loop.velocity < 0.0), std::fabs(loop.velocity));
  }

  MotionOf<double> motion;

  void advance(double voltage, bool driven, double step) {
    const model::Joint& joint = driven ? driven_ : free_;
    const double torque = driven ? loop_.torque_per_voltage * voltage : 0.0;
    const double back_emf = driven ? loop_.back_emf : 0.0;
    const double there = motion.position + 0.5 * step * motion.velocity;
    const double load = gravity(joint, there);
    const double push = torque - load - drive_torque(joint, there);
    // Motor and load act on the gear from its two sides. During a hold both press the teeth.
    const auto dry_load = [&](double velocity) {
      return loop_.load_friction * std::fabs(load + torque - back_emf * velocity);
    };
    MotionOf<double> first = motion;
    advance_pushed(joint, first, push, dry_load(motion.velocity), step);
    // The back-EMF follows the mean velocity, which is known after a first attempt.
    const double mean = 0.5 * (motion.velocity + first.velocity);
    advance_pushed(joint, motion, push, dry_load(mean), step);
  }

 private:
  const ServoLoop& loop_;
  model::Joint driven_, free_;
};

}  // namespace

void ServoLoop::validate() const {
  const base::Requirement require("ServoLoop");
  joint.validate();
  require.finite("torque_per_voltage", torque_per_voltage);
  require.at_least_zero("back_emf", back_emf);
  require.at_least_zero("load_friction", load_friction);
  require.finite("gain", gain);
  require.above_zero("saturation", saturation);
  require.at_least_zero("delay", delay);
  require.finite("position", position);
  require.finite("velocity", velocity);
}

ServoMotion roll_out(const ServoLoop& loop, const ServoLog& log, double step,
                     const base::Cancel& cancel) {
  Servo servo(loop);
  DelayedDuty delayed(loop.delay);
  const std::size_t count = log.time.size();
  ServoMotion result;
  result.position.reserve(count);
  result.velocity.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double position = servo.motion.position;
    if (!(std::fabs(position) < kFarthest)) {
      throw base::InputError("the simulation diverges", "ServoLoop", base::as_value(position));
    }
    result.position.push_back(position);
    result.velocity.push_back(servo.motion.velocity);
    if (i + 1 == count) break;
    if (i % 256 == 0) cancel.check();
    const double span = log.time[i + 1] - log.time[i];
    const double parts = std::max(1.0, std::ceil(span / step - 1e-9));
    const double part = span / parts;
    for (double k = 0.0; k < parts; k += 1.0) {
      double duty = log.command[i];
      // In the middle of the step, like all inputs of the step. Otherwise the loop would be late by
      // half a step.
      const double there = servo.motion.position + 0.5 * part * servo.motion.velocity;
      if (loop.closed) duty = loop.gain * (duty - there);
      duty = std::clamp(duty, -loop.saturation, loop.saturation);
      const double acting = delayed.at(log.time[i] + k * part, duty);
      servo.advance(acting * log.supply[i], log.driven[i] > 0.5, part);
    }
  }
  return result;
}

std::vector<ServoMotion> roll_out(std::span<const ServoLoop> loops, std::span<const ServoLog> logs,
                                  double step, base::Pool& pool) {
  base::Requirement("roll_out").above_zero("step", step);
  for (const auto& loop : loops) loop.validate();
  std::vector<ServoMotion> motions(loops.size());
  pool.for_each(
      loops.size(),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          motions[i] = roll_out(loops[i], logs[i], step, pool.cancel());
        }
      },
      1);
  return motions;
}

}  // namespace jointid::simulate
