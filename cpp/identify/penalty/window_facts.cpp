#include <span>

#include "identify/penalty/penalty.hpp"

// Facts about the windows of a penalty, in addition to the integrals of its terms.

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

template <class Work>
void Penalty::each_recording(const Masked& recordings, Work work) const {
  for (std::size_t from = 0; from < windows_.size();) {
    std::size_t to = from;
    while (to < windows_.size() && recording_of_[to] == recording_of_[from]) ++to;
    work(*recordings.at(static_cast<std::size_t>(recording_of_[from])),
         std::span(windows_).subspan(from, to - from), static_cast<Eigen::Index>(from));
    from = to;
  }
}

Eigen::VectorXd Penalty::torque_steps(const Masked& recordings) const {
  Eigen::VectorXd steps(window_count());
  each_recording(recordings, [&](const MaskedRecording& masked, std::span<const Window> windows,
                                 Eigen::Index first) {
    sum_torque_steps(masked.recording(), masked.usable(), windows,
                     steps.segment(first, static_cast<Eigen::Index>(windows.size())));
  });
  return steps;
}

Eigen::VectorXd Penalty::bending(const Masked& recordings, const Eigen::VectorXd& theta) const {
  check(theta);
  Eigen::VectorXd bent = Eigen::VectorXd::Zero(window_count());
  Eigen::VectorXd column(window_count());
  for (const auto& shaped : shaped_) {
    Eigen::VectorXd shapes(static_cast<Eigen::Index>(shaped.shapes.size()));
    for (Eigen::Index i = 0; i < shapes.size(); ++i) {
      shapes[i] = theta[coefficients() + shaped.shapes[static_cast<std::size_t>(i)]];
    }
    each_recording(recordings, [&](const MaskedRecording& masked, std::span<const Window> windows,
                                   Eigen::Index first) {
      integrate_bending(shaped.term, shapes, masked.recording(), masked.usable(), windows,
                        column.segment(first, static_cast<Eigen::Index>(windows.size())));
    });
    bent += theta[shaped.coefficient] * column;
  }
  return bent;
}

}  // namespace jointid::identify
