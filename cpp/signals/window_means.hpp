#pragma once
// Weighted means of signals over short windows around given samples.

#include <cstdint>
#include <vector>

#include "signals/signal.hpp"

namespace jointid::signals {

/// Middle samples of windows.
using Middles = std::vector<std::int64_t>;

/// Of each window the sum of weight times signal; the weight has an odd number of samples, and
/// every window lies within the signal.
Eigen::VectorXd window_means(const Signal& signal, const Signal& weight, const Middles& middles);

/// At each sample the sum over the window around it; zeros beyond the signal's ends.
Eigen::VectorXd smoothed(const Signal& signal, const Signal& weight);

/// Cosine and sine of an angle, sample by sample.
struct Circle {
  Eigen::VectorXd cosine;
  Eigen::VectorXd sine;
};
Circle circle_of(const Signal& angle);

/// What friction may be a sum of.
struct Rubbing {
  Signal velocity;
  Signal smooth;  ///< the velocity from which decays are computed
  Signal cosine;
  Signal sine;
};

/// Window means of friction as any smooth function of the speed that may depend on direction, angle
/// and time; windows x columns. Decays exp(-(speed / limit)^2) at `longest` of the peak speed, each
/// next one at half the speed.
Eigen::MatrixXd friction_means(const Rubbing& rubbing, double longest, const Signal& weight,
                               const Middles& middles);

}  // namespace jointid::signals
