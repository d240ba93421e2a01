#pragma once
// Closed loops: joint, sensors and controller along one trajectory, for one run or many. Runs of
// joints with one structure advance in parallel lanes, and groups of them run on the pool's
// threads. The bits of a run depend on neither.

#include <cstdint>
#include <span>
#include <vector>

#include "base/pool.hpp"
#include "model/joint.hpp"
#include "simulate/controller.hpp"
#include "simulate/sensors.hpp"
#include "simulate/trajectory.hpp"

namespace jointid::simulate {

/// Settings that all runs of a batch share.
struct Scenario {
  double duration = 1.0;
  double control_period = 1e-3;    ///< time for which a command is held
  double integration_step = 5e-4;  ///< the control period is a multiple of it
  int sample_every = 1;            ///< control periods per recorded sample
  double settling = 0.0;           ///< time at the start that the tracking error leaves out [s]
  Sensors sensors{};

  void validate() const;
  [[nodiscard]] std::size_t instants() const;
  [[nodiscard]] int substeps() const;
};

/// One run.
struct Setup {
  model::Joint joint{};
  Controller controller{};
  double gear_ratio = 1.0;
  double sensor_gain = 1.0;
  double sensor_offset = 0.0;
  double position = 0.0;  ///< at the start
  double velocity = 0.0;
  std::uint64_t seed = 0;  ///< of the noise

  void validate() const;
};

/// Recorded signals, one value per sample: the sensors' values and the true values.
struct Signals {
  std::vector<double> position, velocity, torque, reading, reference;
  std::vector<double> true_position, true_velocity, true_acceleration, friction, link_torque;

  /// Calls visit(signal) for each signal.
  template <class Visit>
  void each(Visit visit) {
    for (auto* signal : {&position, &velocity, &torque, &reading, &reference, &true_position,
                         &true_velocity, &true_acceleration, &friction, &link_torque}) {
      visit(*signal);
    }
  }
};

struct Outcome {
  Signals signals{};  ///< empty unless requested
  double rms_error = 0.0;
  double peak_error = 0.0;
  std::int64_t saturations = 0;
};

/// Selection of the signals that a run stores.
enum class Kept {
  nothing,
  all,
  truth,  ///< true_position, true_velocity, true_acceleration, torque, reading and link_torque
};

/// Largest number of runs that advance in parallel.
inline constexpr std::size_t kSideBySide = 8;

/// The same runs on the calling thread, along references that are known at each control instant.
/// Scenario and setups must be valid.
void simulate_on_this_thread(const Scenario& scenario, std::span<const Reference> wanted,
                             std::span<const Setup> setups, std::span<Outcome> outcomes, Kept kept,
                             const base::Cancel& cancel);

/// One Outcome per setup, in order. Throws base::InputError when a simulation diverges.
std::vector<Outcome> simulate(const Scenario& scenario, const Trajectory& trajectory,
                              const std::vector<Setup>& setups, bool signals, base::Pool& pool);

}  // namespace jointid::simulate
