#pragma once
// Weighted sums of signals over short windows around given samples.

#include <cstdint>
#include <vector>

#include "signals/signal.hpp"

namespace jointid::signals {

/// Middle samples of windows.
using Middles = std::vector<std::int64_t>;

/// For each window the sum of weight times signal. Every window lies within the signal, and windows
/// are in order. The weight has the same number of samples before and after the middle, or one more
/// before it.
void window_means(const Signal& signal, const Eigen::VectorXd& weight, const Middles& middles,
                  double* means);

/// The same for windows that begin at `first[w]`. The weights are filled up with zeros to whole
/// fours, so the signal must be readable up to three samples beyond each window.
void sum_windows(const double* signal, const double* weight, std::size_t width,
                 const std::int64_t* first, std::size_t count, double* sums);

/// A weight, followed by zeros up to whole fours.
Eigen::VectorXd filled_up(const Eigen::VectorXd& weight);

/// For each sample the sum over the window around it. The signal counts as zero beyond its ends.
/// The weight has an odd number of samples.
Eigen::VectorXd smoothed(const Signal& signal, const Eigen::VectorXd& weight);

/// Cosine and sine of an angle at each sample.
struct Circle {
  Eigen::VectorXd cosine;
  Eigen::VectorXd sine;
};
Circle circle_of(const Signal& angle);

}  // namespace jointid::signals
