#pragma once
// Singular values and right singular vectors of a small matrix.

#include <Eigen/Core>

namespace jointid::base {

struct Singular {
  Eigen::VectorXd values;      ///< the largest first; as many as the matrix has columns
  Eigen::MatrixXd directions;  ///< a column each
};

/// By one-sided Jacobi rotations (Hestenes 1958), which keep small singular values of columns of
/// unlike size to full relative accuracy.
Singular singular(Eigen::MatrixXd matrix);

}  // namespace jointid::base
