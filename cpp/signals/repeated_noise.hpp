#pragma once
// Noise of a reading that the torque repeats, from products of third differences. Smooth motion
// does not appear in them.

#include <optional>
#include <vector>

#include "signals/signal.hpp"

namespace jointid::signals {

/// Standard deviation of a signal's third differences, from the median of every second one.
double roughness(const Signal& signal);

/// Means of the reading's third differences times the torque's, for each of `blocks` parts (rows).
/// Columns: the number of samples by which the torque is earlier, from -longest to longest.
/// Differences count in standard deviations, at most `clipped` of them, because the jump at a
/// reversal is not noise. No rows if there is no noise.
Eigen::MatrixXd noise_products(const Signal& reading, const Signal& torque, Eigen::Index blocks,
                               Eigen::Index longest, double clipped);

/// A reading and the torque at the same samples.
struct NoisyPair {
  Signal reading;
  Signal torque;
};

/// Noise of the reading that the torque repeats.
struct RepeatedNoise {
  double earlier;  ///< number of samples by which the torque has the noise earlier
  double error;    ///< standard error [samples]
  double share;    ///< correlation of the two noises
};

constexpr Eigen::Index kShortestNoise = 100;  ///< least number of samples of a pair

/// Nothing if the torque does not repeat the readings' noise at one delay.
std::optional<RepeatedNoise> repeated_noise(const std::vector<NoisyPair>& pairs);

}  // namespace jointid::signals
