#include "simulate/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "base/input_error.hpp"
#include "base/lanes.hpp"
#include "simulate/integration_step.hpp"

namespace jointid::simulate {

namespace {

using Wide = base::Lanes<kSideBySide / 2>;
using Narrow = base::Lanes<kSideBySide / 4>;  ///< with half as many runs, no lane is idle
constexpr double kOutOfBounds = 1e12;         // radians: beyond, the loop diverges
constexpr std::size_t kBlock = 64;            // control periods between checks of the cancel flag

std::int64_t rounded(double value) {
  return static_cast<std::int64_t>(std::floor(value + 0.5));
}

template <class Number>
JointOf<Number> joined(std::span<const Setup> setups) {
  const model::Joint& first = setups.front().joint;
  JointOf<Number> joint;
  joint.friction.resize(first.friction.size());
  for (std::size_t i = 0; i < first.friction.size(); ++i) {
    joint.friction[i].basis = first.friction[i].basis;
  }
  joint.bristles = first.bristles;
  joint.weights.resize(first.weights.size());
  joint.harmonics.resize(first.harmonics.size());
  for (std::size_t i = 0; i < first.harmonics.size(); ++i) {
    joint.harmonics[i].order = first.harmonics[i].order;
  }
  for (std::size_t lane = 0; lane < base::lanes_of<Number>; ++lane) {
    const auto& source = setups[std::min(lane, setups.size() - 1)].joint;
    model::each_number(joint, source,
                       [&](Number& to, const double& from) { base::set_lane(to, lane, from); });
  }
  return joint;
}

/// One run's part of the loop: its samples, commands and signals at a control instant.
class Loop {
 public:
  Loop(const Scenario& scenario, const Setup& setup, Outcome& outcome, Kept kept)
      : sensors_(scenario.sensors, setup.gear_ratio, setup.sensor_gain, setup.sensor_offset,
                 scenario.control_period, setup.seed),
        control_(setup.controller, scenario.control_period, setup.joint.torque_limit),
        outcome_(&outcome),
        kept_(kept) {
    if (kept_ != Kept::nothing) {
      const auto every = static_cast<std::size_t>(scenario.sample_every);
      const std::size_t samples = (scenario.instants() + every - 1) / every;
      outcome.signals.each([&](std::vector<double>& signal) {
        signal.clear();
        signal.reserve(samples);  // not filled, because a run of days may end early
      });
    }
  }

  double command(double time, const Reference& wanted, Faded* faded, double position,
                 double velocity, const Dynamics<double>& acting, bool sample, bool settled) {
    if (!(std::fabs(position) < kOutOfBounds && std::fabs(velocity) < kOutOfBounds)) {
      throw base::InputError("the simulation diverges " + std::to_string(time) +
                             " s after its start: the loop is not stable");
    }
    const Observation shown = sensors_.observe({time, position, velocity, acting.link_torque});
    const double torque = control_.step(
        {time, shown.position, shown.velocity, shown.reading, wanted, control_.period(), faded});
    outcome_->saturations = control_.saturations();
    if (settled) {
      const double error = position - wanted.position;
      sum_ += error * error;
      ++count_;
      outcome_->peak_error = std::max(outcome_->peak_error, std::fabs(error));
    }
    if (kept_ == Kept::nothing) return torque;
    Signals& s = outcome_->signals;
    if (sample) {
      held_ = 0.0;
      commands_ = 0;
      s.torque.push_back(torque);
      s.reading.push_back(shown.reading);
      s.true_position.push_back(position);
      s.true_velocity.push_back(velocity);
      s.true_acceleration.push_back(acting.acceleration);
      s.link_torque.push_back(acting.link_torque);
      if (kept_ == Kept::all) {
        s.position.push_back(shown.position);
        s.velocity.push_back(shown.velocity);
        s.reference.push_back(wanted.position);
        s.friction.push_back(acting.friction);
      }
    }
    // The recorded torque of a sample is the mean of the commands until the next sample.
    held_ += torque;
    ++commands_;
    if (commands_ > 1) s.torque.back() = held_ / commands_;
    return torque;
  }
  void finish() {
    outcome_->rms_error = count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0.0;
  }

 private:
  SensorChain sensors_;
  ControlRun control_;
  Outcome* outcome_;
  Kept kept_;
  double sum_ = 0.0;
  std::int64_t count_ = 0;
  double held_ = 0.0;  ///< sum of the commands since the last sample
  int commands_ = 0;
};

/// Simulates as many runs as Number has lanes, or fewer. Then the last run is repeated, and the
/// copies are dropped. `reference(k)` is the desired motion at control instant k.
template <class Number, class Wanted>
void run(const Scenario& scenario, const Wanted& reference, std::span<const Setup> setups,
         std::span<Outcome> outcomes, Kept kept, const base::Cancel& cancel) {
  const JointOf<Number> joint = joined<Number>(setups);
  std::vector<Loop> loops;
  loops.reserve(setups.size());
  MotionOf<Number> motion;
  for (std::size_t i = 0; i < base::lanes_of<Number>; ++i) {
    const Setup& setup = setups[std::min(i, setups.size() - 1)];
    base::set_lane(motion.position, i, setup.position);
    base::set_lane(motion.velocity, i, setup.velocity);
    if (i < setups.size()) loops.emplace_back(scenario, setup, outcomes[i], kept);
  }
  motion.varying =
      model::varying(joint, !(motion.velocity < Number(0.0)), base::absolute(motion.velocity));
  const int substeps = scenario.substeps();
  const double step = scenario.control_period / substeps;
  const auto every = static_cast<std::size_t>(scenario.sample_every);
  const std::size_t instants = scenario.instants();
  Number torque = 0.0;
  Faded faded;  // laws that use the reference need the same share in each run
  for (std::size_t k = 0; k < instants; ++k) {
    if (k % kBlock == 0) cancel.check();
    const double time = static_cast<double>(k) * scenario.control_period;
    const Reference wanted = reference(k);
    const auto acting = dynamics(joint, motion, torque);
    for (std::size_t i = 0; i < loops.size(); ++i) {
      const Dynamics<double> own{base::lane(acting.acceleration, i), base::lane(acting.friction, i),
                                 base::lane(acting.link_torque, i),
                                 base::lane(acting.drive_torque, i)};
      const double command = loops[i].command(time, wanted, &faded, base::lane(motion.position, i),
                                              base::lane(motion.velocity, i), own, k % every == 0,
                                              time >= scenario.settling);
      base::set_lane(torque, i, command);
    }
    for (int s = 0; s < substeps; ++s) advance(joint, motion, torque, step);
  }
  for (auto& loop : loops) loop.finish();
}

template <class Wanted>
void run_group(const Scenario& scenario, const Wanted& reference, std::span<const Setup> setups,
               std::span<Outcome> outcomes, Kept kept, const base::Cancel& cancel) {
  if (setups.size() == 1) {
    run<double>(scenario, reference, setups, outcomes, kept, cancel);
  } else if (setups.size() <= Narrow::width) {
    run<Narrow>(scenario, reference, setups, outcomes, kept, cancel);
  } else {
    run<Wide>(scenario, reference, setups, outcomes, kept, cancel);
  }
}

/// Neighbours with one structure, at most one per lane.
std::vector<std::span<const Setup>> groups(std::span<const Setup> setups) {
  std::vector<std::span<const Setup>> result;
  for (std::size_t begin = 0; begin < setups.size();) {
    std::size_t end = begin + 1;
    while (end < setups.size() && end - begin < Wide::width &&
           model::same_structure(setups[begin].joint, setups[end].joint)) {
      ++end;
    }
    result.emplace_back(setups.data() + begin, end - begin);
    begin = end;
  }
  return result;
}

}  // namespace

void Scenario::validate() const {
  const base::Requirement require("Scenario");
  require.above_zero("control_period", control_period);
  require.above_zero("integration_step", integration_step);
  require.above_zero("duration", duration);
  require.that(duration / control_period <= 1e9, "duration", duration,
               "at most 1e9 control periods");
  require.that(rounded(duration / control_period) >= 1, "duration", duration,
               "at least a control period");
  const double ratio = control_period / integration_step;
  require.that(ratio > 0.999999 && ratio <= 1e6, "integration_step", integration_step,
               "at most the control period, and a millionth of it at least");
  require.that(std::fabs(ratio - std::floor(ratio + 0.5)) < 1e-6 * ratio, "integration_step",
               integration_step, "a whole part of the control period");
  require.that(sample_every >= 1, "sample_every", sample_every, "at least 1");
  require.at_least_zero("settling", settling);
  sensors.validate();
}

std::size_t Scenario::instants() const {
  return static_cast<std::size_t>(rounded(duration / control_period));
}

int Scenario::substeps() const {
  return static_cast<int>(rounded(control_period / integration_step));
}

void Setup::validate() const {
  const base::Requirement require("Setup");
  joint.validate();
  require.that(gear_ratio != 0.0 && std::isfinite(gear_ratio), "gear_ratio", gear_ratio,
               "finite and not 0");
  require.that(sensor_gain != 0.0 && std::isfinite(sensor_gain), "sensor_gain", sensor_gain,
               "finite and not 0");
  require.finite("sensor_offset", sensor_offset);
  require.finite("position", position);
  require.finite("velocity", velocity);
}

std::vector<Outcome> simulate(const Scenario& scenario, const Trajectory& trajectory,
                              const std::vector<Setup>& setups, bool signals, base::Pool& pool) {
  scenario.validate();
  for (const auto& setup : setups) setup.validate();
  std::vector<Outcome> outcomes(setups.size());
  const auto parts = groups(setups);
  const Kept kept = signals ? Kept::all : Kept::nothing;
  const auto reference = [&](std::size_t k) {
    return trajectory.at(static_cast<double>(k) * scenario.control_period);
  };
  pool.for_each(parts.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto first = static_cast<std::size_t>(parts[i].data() - setups.data());
      const std::span<Outcome> own(outcomes.data() + first, parts[i].size());
      run_group(scenario, reference, parts[i], own, kept, pool.cancel());
    }
  });
  return outcomes;
}

void simulate_on_this_thread(const Scenario& scenario, std::span<const Reference> wanted,
                             std::span<const Setup> setups, std::span<Outcome> outcomes, Kept kept,
                             const base::Cancel& cancel) {
  const auto reference = [&](std::size_t k) { return wanted[k]; };
  for (const auto& part : groups(setups)) {
    const auto first = static_cast<std::size_t>(part.data() - setups.data());
    run_group(scenario, reference, part, outcomes.subspan(first, part.size()), kept, cancel);
  }
}

}  // namespace jointid::simulate
