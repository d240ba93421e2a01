#pragma once
// A servo without a torque signal: a motor, driven by a voltage, around a simulated joint. The
// servo's position loop or a log chooses the voltage. Simulated along a log's time stamps, for one
// run or many.

#include <span>
#include <vector>

#include "base/pool.hpp"
#include "model/joint.hpp"

namespace jointid::simulate {

/// Motor and position loop of a servo; output side of the gear, SI units.
struct ServoLoop {
  model::Joint joint{};             ///< without friction of the load, see load_friction
  double torque_per_voltage = 1.0;  ///< k_t / R [N·m/V]
  double back_emf = 0.0;            ///< k_t² / R [N·m·s/rad], while the motor is driven
  /// Dry friction per torque through the gear, which is the motor's torque minus the load's [1].
  double load_friction = 0.0;
  bool closed =
      true;  ///< whether the command is the desired position; otherwise it is the duty itself
  double gain = 1.0;        ///< duty per error of position [1/rad]
  double saturation = 1.0;  ///< limit of the duty's magnitude
  double delay = 0.0;       ///< delay from the error to the duty [s]
  double position = 0.0;    ///< at the start
  double velocity = 0.0;

  void validate() const;
};

/// The log of a run, one value per sample. Each value is held until the next.
struct ServoLog {
  std::span<const double> time;     ///< [s], increasing
  std::span<const double> command;  ///< desired position [rad], or duty if the loop is not closed
  std::span<const double> supply;   ///< [V]
  std::span<const double> driven;   ///< 0 where the motor turns freely
};

/// Position and velocity at each sample of the log.
struct ServoMotion {
  std::vector<double> position, velocity;
};

/// Uses steps of at most `step` seconds. Throws base::InputError when the simulation diverges.
ServoMotion roll_out(const ServoLoop& loop, const ServoLog& log, double step,
                     const base::Cancel& cancel);

/// One motion per loop, in order, on the pool's threads.
std::vector<ServoMotion> roll_out(std::span<const ServoLoop> loops, std::span<const ServoLog> logs,
                                  double step, base::Pool& pool);

}  // namespace jointid::simulate
