#pragma once
// Where the windows of a motion are cut into segments: between reversals, merged or divided to a
// usual length.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace jointid::identify {

/// Windows in the order of time: start and stop of each, and how far the joint travels in it.
struct MovingWindows {
  Eigen::Ref<const Eigen::VectorXd> start;   ///< [s]
  Eigen::Ref<const Eigen::VectorXd> stop;    ///< [s]
  Eigen::Ref<const Eigen::VectorXd> travel;  ///< [rad or m]
};

/// Ends of the segments of one recording's windows, `first` to `last` - 1: each is the first window
/// of the next one.
std::vector<std::int64_t> motion_cuts(const MovingWindows& windows, Eigen::Index first,
                                      Eigen::Index last, double length);

}  // namespace jointid::identify
