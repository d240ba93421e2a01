#pragma once
// Closed loops: joint, sensors and controller along one trajectory, one run or many. Runs whose
// joints have one structure advance side by side in lanes, groups of them on the pool's threads;
// the bits of a run depend on neither.

#include <cstdint>
#include <span>
#include <vector>

#include "base/pool.hpp"
#include "model/joint.hpp"
#include "simulate/controller.hpp"
#include "simulate/sensors.hpp"
#include "simulate/trajectory.hpp"

namespace jointid::simulate {

/// What all runs of a batch share.
struct Scenario {
  double duration = 1.0;
  double control_period = 1e-3;    ///< the command is held so long
  double integration_step = 5e-4;  ///< a whole number of them is a control period
  int sample_every = 1;            ///< control periods a recorded sample
  double settling = 0.0;           ///< left out of the tracking error [s]
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

/// Recorded signals, one value a sample; what the sensors saw, and what was.
struct Signals {
  std::vector<double> position, velocity, torque, reading, reference;
  std::vector<double> true_position, true_velocity, true_acceleration, friction, link_torque;

  /// Calls visit(signal) for each.
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

/// What a run keeps of its signals.
enum class Kept {
  nothing,
  all,
  truth,  ///< true_position, true_velocity, true_acceleration, torque, reading and link_torque
};

/// Most runs that advance side by side.
inline constexpr std::size_t kSideBySide = 8;

/// The same runs on the calling thread, along references that are known at each control instant.
/// Scenario and setups are taken as valid.
void simulate_on_this_thread(const Scenario& scenario, std::span<const Reference> wanted,
                             std::span<const Setup> setups, std::span<Outcome> outcomes, Kept kept,
                             const base::Cancel& cancel);

/// One Outcome a setup, in order. Throws base::InputError when a motion leaves all bounds.
std::vector<Outcome> simulate(const Scenario& scenario, const Trajectory& trajectory,
                              const std::vector<Setup>& setups, bool signals, base::Pool& pool);

}  // namespace jointid::simulate
