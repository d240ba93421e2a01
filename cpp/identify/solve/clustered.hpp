#pragma once
// Variances of a least-squares estimate from the scores of segments of windows.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace jointid::identify {

/// The sandwich of one clustering. The scores are corrected for the freedom that the fit took from
/// them (CR2: Bell and McCaffrey 2002).
struct Clustered {
  std::int64_t segments = 0;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd freedom;  ///< degrees of freedom of each parameter's variance (Satterthwaite)
  double size = 0.0;        ///< sum of squares of all corrected scores
  double pooled_freedom = 0.0;
};

/// The rows of the Jacobian in the directions of `whitening`, one column per direction.
Eigen::MatrixXd whitened_rows(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                              const Eigen::MatrixXd& whitening);

/// From whitened rows; a segment extends from one cut to the next.
Clustered cluster(const Eigen::MatrixXd& rows, const Eigen::VectorXd& residual,
                  const Eigen::MatrixXd& whitening, const std::vector<std::int64_t>& cuts);

/// White's variances: each row is a segment, with uncorrected scores.
Eigen::VectorXd variances_of_rows(const Eigen::MatrixXd& rows, const Eigen::VectorXd& residual,
                                  const Eigen::MatrixXd& whitening);

}  // namespace jointid::identify
