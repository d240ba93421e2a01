#pragma once
// What all windows say about every general decay: the moments of their speeds, split into
// projections on the constant columns and what remains of them.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/pool.hpp"
#include "identify/compressed/speed_pieces.hpp"
#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

struct SpeedMoments {
  Eigen::MatrixXd triangle;     ///< m x m, upper: constant columns, target
  Eigen::MatrixXd projections;  ///< m x (shaped * moments)
  /// Inner products of what remains of the moments' columns.
  Eigen::MatrixXd products;
  /// The functions of a GeneralTable at the probes, by direct sums: functions x probes.
  Eigen::MatrixXd expected;
};

/// Shapes, velocity and exponent, at which direct sums are made.
using Probes = std::vector<std::array<double, 2>>;

/// One pass over the samples, over the pool's threads when it is a long one.
SpeedMoments speed_moments(const Penalty& penalty, const SpeedPieces& pieces, const Probes& probes,
                           base::Pool& pool);

}  // namespace jointid::identify
