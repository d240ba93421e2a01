#pragma once
// Weighted sums of signals over short windows around given samples.

#include <cstdint>
#include <vector>

#include "signals/signal.hpp"

namespace jointid::signals {

/// Middle samples of windows.
using Middles = std::vector<std::int64_t>;

/// Of each window the sum of weight times signal; every window lies within the signal, and they
/// come in order. The weight has as many samples before the middle as behind it, or one more before
/// it.
void window_means(const Signal& signal, const Eigen::VectorXd& weight, const Middles& middles,
                  double* means);

/// The same of windows that begin `first[w] - before`, from a signal that may be read up to three
/// samples beyond each window: for weights filled up with zeros to whole fours.
void sum_windows(const double* signal, const double* weight, std::size_t width,
                 const std::int64_t* first, std::size_t count, double* sums);

/// A weight, and zeros up to whole fours.
Eigen::VectorXd filled_up(const Eigen::VectorXd& weight);

/// At each sample the sum over the window around it; zeros beyond the signal's ends. The weight has
/// an odd number of samples.
Eigen::VectorXd smoothed(const Signal& signal, const Eigen::VectorXd& weight);

/// Cosine and sine of an angle, sample by sample.
struct Circle {
  Eigen::VectorXd cosine;
  Eigen::VectorXd sine;
};
Circle circle_of(const Signal& angle);

}  // namespace jointid::signals
