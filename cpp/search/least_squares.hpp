#pragma once
// Linear least squares under linear inequalities, small and dense: min |A x - b| subject to G x >=
// h. Lawson and Hanson, "Solving Least Squares Problems" (1974), ch. 23: reduced by QR to the least
// distance problem, and that to non-negative least squares.

#include <Eigen/Core>

namespace jointid::search {

struct LeastSquaresResult {
  Eigen::VectorXd x;
  bool feasible = false;  ///< some x satisfies G x >= h
};

/// Non-negative least squares: min |A x - b|, x >= 0 (active set; A has few columns).
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Columns of A are scaled to unit norm and damped by 1e-9, so that collinear ones share instead of
/// exploding; columns of zeros get x = what the constraints ask, nearest to 0. G may have no rows.
LeastSquaresResult constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                             const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

}  // namespace jointid::search
