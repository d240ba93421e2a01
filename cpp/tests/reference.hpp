#pragma once
// Slow and simple solvers for comparison: every combination of active bounds is tried. Also
// matrices of random numbers as inputs.

#include <Eigen/Core>
#include <limits>

#include "base/random.hpp"

namespace jointid::tests {

/// Uniform in (-1, 1), by columns.
Eigen::MatrixXd drawn(base::Random& random, Eigen::Index rows, Eigen::Index columns);

/// min |a x - b| in a box of a few variables. Each variable is free, at its lower or at its upper
/// bound. The answer is the best combination inside the box.
Eigen::VectorXd box_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

struct ConstrainedReference {
  Eigen::VectorXd x;
  double square =
      std::numeric_limits<double>::infinity();  ///< infinity: no x satisfies all constraints
};

/// min |a x - b| subject to g x >= h. Each subset of the constraints holds with equality. The
/// answer is the best one that satisfies all.
ConstrainedReference constrained_reference(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                           const Eigen::MatrixXd& g, const Eigen::VectorXd& h);

}  // namespace jointid::tests
