#pragma once
// Linear least squares under linear inequalities, small and dense: min |A x - b| subject to G x >=
// h. Lawson and Hanson, "Solving Least Squares Problems" (1974), ch. 23: reduced by QR to the least
// distance problem, and that to non-negative least squares. Normal equations inside a box by
// exchanges.

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

/// The minimum of x'Sx / 2 + g'x inside a box; S positive semidefinite, bounds may be infinite.
/// What ends at a bound is exactly that bound; of a direction that S lacks, the shortest x.
/// Parameters outside are held, held ones that the gradient pulls inside are freed: all together
/// first, then one by one, which ends always (Murty 1974; Judice and Pires 1994).
Eigen::VectorXd box_minimum(const Eigen::MatrixXd& square, const Eigen::VectorXd& gradient,
                            const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace jointid::search
