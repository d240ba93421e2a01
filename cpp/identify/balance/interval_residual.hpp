#pragma once
// The residual of the torque balance at known coefficients and shapes, for each sample interval.
// For windows of few samples this is cheaper than one column per term.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "identify/balance/terms.hpp"
#include "identify/recording/recording.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::identify {

/// A term of a balance with known parameters.
struct KnownTerm {
  Term term;
  double coefficient;
  Eigen::VectorXd shapes;
};

/// Integral of the torque minus the terms over each window's usable intervals. Friction is
/// integrated as in `integrate_friction`. No term may be load friction.
void integrate_residual(const std::vector<KnownTerm>& terms, double gear_ratio,
                        const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                        std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result);

namespace detail {

constexpr std::size_t kMostIntervals = 1024;

/// The residual over each of `count` intervals from `first` on, at most kMostIntervals.
void interval_residuals(const std::vector<KnownTerm>& terms, double gear_ratio,
                        const RecordingView& recording, std::int64_t first, std::size_t count,
                        double* result);

}  // namespace detail

}  // namespace jointid::identify
