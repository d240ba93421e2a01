#pragma once
// Slow and simple solvers to compare with: every combination of active bounds is tried. And
// matrices of random numbers to feed them.

#include <Eigen/Core>
#include <limits>

#include "base/random.hpp"

namespace jointid::tests {

/// Uniform in (-1, 1), column by column.
Eigen::MatrixXd drawn(base::Random& random, Eigen::Index rows, Eigen::Index columns);

/// min |a x - b| in a box of a few variables: each variable is free, at its lower or at its upper
/// bound; the best combination that lies in the box is the answer.
Eigen::VectorXd box_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

struct ConstrainedReference {
  Eigen::VectorXd x;
  double square = std::numeric_limits<double>::infinity();  ///< infinity: no x satisfies all
};

/// min |a x - b| subject to g x >= h: each subset of the constraints holds with equality; the best
/// answer that satisfies all is the answer.
ConstrainedReference constrained_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                           const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

}  // namespace jointid::tests
