#pragma once
// A local search for a sum of squares in a box: Levenberg-Marquardt with the bounds kept by an
// active set.

#include <Eigen/Core>
#include <functional>

#include "base/pool.hpp"
#include "search/domain.hpp"

namespace jointid::search {

/// Residuals at theta, and when asked (not null) the Jacobian, rows x parameters.
using ResidualFunction =
    std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&, Eigen::MatrixXd*)>;

struct PolishResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  int iterations = 0;
  bool converged = false;  ///< the next step would change the penalty by less than 1e-14 of it
};

/// Starts inside the domain; never returns anything worse than the start. `pool` is asked between
/// iterations only.
PolishResult polish(const ResidualFunction& residuals, const Domain& domain,
                    const Eigen::VectorXd& start, base::Pool& pool, int iterations = 200);

}  // namespace jointid::search
