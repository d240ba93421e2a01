#pragma once
// The minimum over other windows, from the minimum over some: near by, so that a few Gauss-Newton
// steps reach it.

#include <Eigen/Core>
#include <functional>

#include "identify/penalty/penalty_parts.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// What a step of Gauss-Newton needs at one point: sums over the windows.
struct Balanced {
  Eigen::MatrixXd square;    ///< J'J
  Eigen::VectorXd gradient;  ///< J'r
  double penalty = 0.0;
};

/// Gauss-Newton in a box, each step from sums over the parts, damped when one leads uphill; ends
/// when the way left is below 2e-5 standard errors.
Eigen::VectorXd refit(const PenaltyParts& parts, const search::Domain& domain,
                      const Eigen::VectorXd& start, base::Pool* pool);

/// The same from such sums, of which `first` are those at the start, within the domain. `alike` has
/// the same parameters. Ends, too, where the next step is expected to be less than `share` of this.
Eigen::VectorXd descend(const std::function<Balanced(const Eigen::VectorXd&)>& at,
                        const PenaltyParts& alike, Eigen::Index windows,
                        const search::Domain& domain, const Eigen::VectorXd& start,
                        const Balanced& first, double share);

}  // namespace jointid::identify
