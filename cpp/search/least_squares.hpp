#pragma once
// Linear least squares under linear inequalities, small and dense: min |A x - b| subject to G x >=
// h. Lawson and Hanson, "Solving Least Squares Problems" (1974), ch. 23: QR reduces the problem to
// the least distance problem, which becomes non-negative least squares. Also normal equations
// inside a box, by exchanges.

#include <Eigen/Core>

namespace jointid::search {

struct LeastSquaresResult {
  Eigen::VectorXd x;
  bool feasible = false;  ///< some x satisfies G x >= h
};

/// Non-negative least squares: min |A x - b|, x >= 0 (active set; A has few columns).
Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Columns of A are scaled to unit norm and damped by 1e-9, so that collinear columns share instead
/// of exploding. Columns of zeros get the x nearest to 0 that satisfies the constraints. G may have
/// no rows.
LeastSquaresResult constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                             const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

/// The minimum of x'Sx / 2 + g'x inside a box. S is positive semidefinite; bounds may be infinite.
/// A parameter at a bound equals that bound exactly. In a direction that S lacks, x is the
/// shortest. Parameters outside are fixed, and fixed ones that the gradient pulls inside are freed:
/// first all together, then one by one, which always ends (Murty 1974; Judice and Pires 1994).
Eigen::VectorXd box_minimum(const Eigen::MatrixXd& square, const Eigen::VectorXd& gradient,
                            const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace jointid::search
