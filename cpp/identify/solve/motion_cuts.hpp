#pragma once
// Division of a motion's windows into segments: between reversals, merged or divided to a usual
// length.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace jointid::identify {

/// Windows in the order of time: start and stop of each, and the travel of the joint in it.
struct MovingWindows {
  Eigen::Ref<const Eigen::VectorXd> start;   ///< [s]
  Eigen::Ref<const Eigen::VectorXd> stop;    ///< [s]
  Eigen::Ref<const Eigen::VectorXd> travel;  ///< [rad or m]
};

/// Ends of the segments of one recording's windows, `first` to `last` - 1. Each end is the first
/// window of the next segment.
std::vector<std::int64_t> motion_cuts(const MovingWindows& windows, Eigen::Index first,
                                      Eigen::Index last, double length);

}  // namespace jointid::identify
