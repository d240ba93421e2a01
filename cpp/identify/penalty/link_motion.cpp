#include "identify/penalty/link_motion.hpp"

#include <cmath>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::identify {

namespace {

/// Multiplies the column of the speed by the duration, and fills the columns of friction that does
/// not grow with the speed are filled, too.
JOINTID_CLONES void frictions(double* speed, const double* duration, double slow, std::size_t count,
                              double* dry, double* fading) {
  for (std::size_t i = 0; i < count; ++i) {
    const double v = speed[i];
    const double side = v > 0.0 ? duration[i] : (v < 0.0 ? -duration[i] : 0.0);
    dry[i] = side;
    fading[i] = side * base::exp(-std::fabs(v) / slow);
    speed[i] = v * duration[i];
  }
}

}  // namespace

Eigen::MatrixXd link_motion(const Penalty& penalty, const Penalty::Masked& recordings,
                            const std::vector<double>& periods, double slow) {
  const Eigen::Index rows = penalty.window_count();
  Eigen::MatrixXd result(rows, Eigen::Index{kLinkMotion});
  Eigen::VectorXd angle(rows);
  result.col(kDuration) = penalty.usable_duration();
  result.col(kStep) = penalty.torque_steps(recordings);
  result.col(kTorque) = penalty.target();
  result.col(kReading) = penalty.reading();
  const Window* window = penalty.windows().data();
  const int* run = penalty.recording_of().data();
  double* faster = result.col(kFaster).data();
  double* step = result.col(kStep).data();
  double* speed = result.col(kViscous).data();
  double* lasting = result.col(kLasting).data();
  for (Eigen::Index w = 0; w < rows;) {
    const int now = run[w];
    const auto& recording = recordings[static_cast<std::size_t>(now)]->recording();
    const double* time = recording.time.data();
    const double* position = recording.position.data();
    const double* velocity = recording.velocity.data();
    const double period = periods[static_cast<std::size_t>(now)];
    for (; w < rows && run[w] == now; ++w) {
      const auto [first, last] = window[w];
      faster[w] = velocity[last] - velocity[first];
      angle[w] = 0.5 * (position[last] + position[first]);
      step[w] *= period;
      lasting[w] = time[last] - time[first];
      speed[w] = (position[last] - position[first]) / lasting[w];
    }
  }
  frictions(speed, penalty.usable_duration().data(), slow, static_cast<std::size_t>(rows),
            result.col(kDry).data(), result.col(kSlow).data());
  base::circle(angle.data(), static_cast<std::size_t>(rows), result.col(kCosine).data(),
               result.col(kSine).data());
  result.col(kCosine).array() *= penalty.usable_duration().array();
  result.col(kSine).array() *= penalty.usable_duration().array();
  return result;
}

}  // namespace jointid::identify
