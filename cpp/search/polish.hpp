#pragma once
// A local search for the minimum of a sum of squares in a box: Levenberg-Marquardt with an active
// set for the bounds.

#include <Eigen/Core>
#include <functional>

#include "base/pool.hpp"
#include "search/domain.hpp"

namespace jointid::search {

/// Computes the residuals at theta and, if it is not null, the Jacobian, rows x parameters.
using ResidualFunction =
    std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&, Eigen::MatrixXd*)>;

struct PolishResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  int iterations = 0;
  bool converged = false;  ///< the next step would change the penalty by less than 1e-14 of it
};

/// Starts inside the domain and never returns a point worse than the start. The poll of `pool` runs
/// only between iterations.
PolishResult polish(const ResidualFunction& residuals, const Domain& domain,
                    const Eigen::VectorXd& start, base::Pool& pool, int iterations = 200);

}  // namespace jointid::search
