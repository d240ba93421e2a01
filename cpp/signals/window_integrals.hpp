#pragma once
// Integrals of any signal over windows, by the trapezoidal rule over the intervals that count.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "signals/signal.hpp"

namespace jointid::signals {

/// First and last sample of each window.
using Bounds = Eigen::Map<const Eigen::Matrix<std::int64_t, Eigen::Dynamic, 2, Eigen::RowMajor>>;
/// Values of each sample, or of each window, next to each other.
using SideBySide = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Quantity that is summed over the intervals of a window.
enum class Summed {
  area,  ///< the mean of both ends times the interval's weight
  rise,  ///< the difference of both ends, where the interval has a weight
};

/// `values`: `width` values per sample. `weights`: one per interval [s]; 0 where the interval does
/// not count. Every window must lie within the samples.
SideBySide window_integrals(const double* values, std::size_t width, const Signal& weights,
                            const Bounds& windows, Summed summed);

}  // namespace jointid::signals
