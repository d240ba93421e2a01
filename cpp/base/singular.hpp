#pragma once
// Singular values and right singular vectors of a small matrix.

#include <Eigen/Core>

namespace jointid::base {

struct Singular {
  Eigen::VectorXd values;      ///< the largest first; one per column of the matrix
  Eigen::MatrixXd directions;  ///< one per column
};

/// One-sided Jacobi rotations (Hestenes 1958). They keep small singular values to full relative
/// accuracy, also with columns of very different size.
Singular singular(Eigen::MatrixXd matrix);

}  // namespace jointid::base
