#pragma once
// The minimum over other windows, from a known minimum. The two are near, so a few Gauss-Newton
// steps suffice.

#include <Eigen/Core>
#include <functional>

#include "identify/penalty/penalty_parts.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// Sums over the windows for a Gauss-Newton step at one point.
struct Balanced {
  Eigen::MatrixXd square;    ///< J'J
  Eigen::VectorXd gradient;  ///< J'r
  double penalty = 0.0;
};

/// Gauss-Newton in a box. Each step comes from sums over the parts, and is damped if it increases
/// the penalty. Ends when the remaining distance is below 2e-5 standard errors.
Eigen::VectorXd refit(const PenaltyParts& parts, const search::Domain& domain,
                      const Eigen::VectorXd& start, base::Pool* pool);

/// The same from such sums; `first` are those at the start, within the domain. `alike` has the same
/// parameters. Also ends when the next step is expected to be less than `share` of this one.
Eigen::VectorXd descend(const std::function<Balanced(const Eigen::VectorXd&)>& at,
                        const PenaltyParts& alike, Eigen::Index windows,
                        const search::Domain& domain, const Eigen::VectorXd& start,
                        const Balanced& first, double share);

}  // namespace jointid::identify
