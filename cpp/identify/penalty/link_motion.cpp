#include "identify/penalty/link_motion.hpp"

#include "base/circle.hpp"

namespace jointid::identify {

Eigen::MatrixXd link_motion(const Penalty& penalty, const Penalty::Masked& recordings,
                            const std::vector<double>& periods) {
  const Eigen::Index rows = penalty.window_count();
  Eigen::MatrixXd result(rows, Eigen::Index{kLinkMotion});
  Eigen::VectorXd angle(rows);
  result.col(kDuration) = penalty.usable_duration();
  result.col(kStep) = penalty.torque_steps(recordings);
  for (Eigen::Index w = 0; w < rows; ++w) {
    const auto run = static_cast<std::size_t>(penalty.recording_of()[static_cast<std::size_t>(w)]);
    const auto& recording = recordings[run]->recording();
    const auto [first, last] = penalty.windows()[static_cast<std::size_t>(w)];
    const double lasting = recording.time[last] - recording.time[first];
    result(w, kFaster) = recording.velocity[last] - recording.velocity[first];
    angle[w] = 0.5 * (recording.position[last] + recording.position[first]);
    result(w, kStep) *= periods[run];
    result(w, kLasting) = lasting;
    result(w, kSpeed) = (recording.position[last] - recording.position[first]) / lasting;
  }
  base::circle(angle.data(), static_cast<std::size_t>(rows), result.col(kCosine).data(),
               result.col(kSine).data());
  result.col(kCosine).array() *= penalty.usable_duration().array();
  result.col(kSine).array() *= penalty.usable_duration().array();
  return result;
}

}  // namespace jointid::identify
