#include <span>

#include "identify/penalty/penalty.hpp"

// What the windows of a penalty hold, beside the integrals of its terms.

namespace jointid::identify {

Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2> Penalty::window_bounds() const {
  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2> bounds(window_count(), 2);
  for (std::size_t w = 0; w < windows_.size(); ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    bounds(row, 0) = windows_[w].begin;
    bounds(row, 1) = windows_[w].end;
  }
  return bounds;
}

Eigen::VectorXd Penalty::torque_steps(const Masked& recordings) const {
  Eigen::VectorXd steps(window_count());
  for (std::size_t from = 0; from < windows_.size();) {
    std::size_t to = from;
    while (to < windows_.size() && recording_of_[to] == recording_of_[from]) ++to;
    const auto& masked = *recordings.at(static_cast<std::size_t>(recording_of_[from]));
    sum_torque_steps(
        masked.recording(), masked.usable(), std::span(windows_).subspan(from, to - from),
        steps.segment(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(to - from)));
    from = to;
  }
  return steps;
}

}  // namespace jointid::identify
