#pragma once
// Noise of one signal that another one repeats: products of third differences, in which smooth
// motion does not appear.

#include "signals/signal.hpp"

namespace jointid::signals {

/// Standard deviation of a signal's third differences, as the median of every second one tells it.
double roughness(const Signal& signal);

/// Of each of `blocks` parts (rows): means of the reading's third differences times the torque's,
/// by how many samples earlier the torque is, -longest to longest (columns). Differences count in
/// standard deviations, at most `clipped` of them: a reversal's jump is not noise. No rows without
/// noise.
Eigen::MatrixXd noise_products(const Signal& reading, const Signal& torque, Eigen::Index blocks,
                               Eigen::Index longest, double clipped);

}  // namespace jointid::signals
