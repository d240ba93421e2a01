#pragma once
// Noise of a reading that the torque repeats: products of third differences, in which smooth motion
// does not appear.

#include <optional>
#include <vector>

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

/// A reading and the torque of the same samples.
struct NoisyPair {
  Signal reading;
  Signal torque;
};

/// Noise of the reading in the torque.
struct RepeatedNoise {
  double earlier;  ///< by how many samples the torque has it earlier
  double error;    ///< standard error [samples]
  double share;    ///< correlation of both noises
};

constexpr Eigen::Index kShortestNoise = 100;  ///< samples of a pair

/// Nothing where the torque does not repeat the readings' noise at one delay.
std::optional<RepeatedNoise> repeated_noise(const std::vector<NoisyPair>& pairs);

}  // namespace jointid::signals
