#pragma once
// Uncertainty of a least-squares estimate: covariance, correlations, the least determined
// direction.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace jointid::identify {

/// Columns of a gain and of its offset, and the mean of the signal that the gain multiplies.
struct Centre {
  Eigen::Index gain;
  Eigen::Index offset;
  double mean;
};

/// First rows of the segments, followed by the number of rows; one or several clusterings.
using Cuts = std::vector<std::vector<std::int64_t>>;

struct Covariance {
  Eigen::MatrixXd matrix;
  /// Inverse of the covariance; zero along directions that the data do not determine (infinite
  /// variance).
  Eigen::MatrixXd information;
  Eigen::VectorXd stderr_;
  Eigen::VectorXd freedom;      ///< degrees of freedom of Student's t
  bool white = true;            ///< whether no test rejects independent residuals
  Eigen::MatrixXd correlation;  ///< after centring
  double condition = 1.0;       ///< of the centred Jacobian with columns of unit norm
  Eigen::VectorXd weakest;      ///< direction in those scaled columns
};

/// For a fit of at least one parameter; `triangle` is that of the Jacobian's QR decomposition.
///
/// If no test rejects white residuals, the variance of each parameter is the larger of two: the
/// classical one, and that of clusters of one row (White's, which allows for noise that depends on
/// the motion). Otherwise it is the mean of the clusterings.
Covariance covariance_of(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                         const Eigen::VectorXd& residual, const Eigen::MatrixXd& triangle,
                         const Cuts& cuts, const std::optional<Centre>& centre);

}  // namespace jointid::identify
