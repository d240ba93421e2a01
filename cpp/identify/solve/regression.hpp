#pragma once
// What least squares over very many windows comes down to: the triangle of a tall matrix, and sums
// of its rows over segments.

#include <Eigen/Core>

#include "base/pool.hpp"

namespace jointid::identify {

/// R of the QR decomposition of a tall matrix, by blocks of rows and then of their triangles; all
/// that least squares needs of the matrix (Golub and Van Loan, 5.2).
Eigen::MatrixXd triangle(const Eigen::Ref<const Eigen::MatrixXd>& matrix, base::Pool* pool);

/// Products of the directions `whitening` makes of the Jacobian's rows, over each segment of rows.
struct SegmentSums {
  std::vector<Eigen::MatrixXd> shares;  ///< with each other
  Eigen::MatrixXd scores;               ///< with the residual; directions x segments
};

/// Segments are from one cut to the next.
SegmentSums segment_sums(const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                         const Eigen::VectorXd& residual, const Eigen::MatrixXd& whitening,
                         const std::vector<std::int64_t>& cuts);

}  // namespace jointid::identify
