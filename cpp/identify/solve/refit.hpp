#pragma once
// The minimum over other windows, from the minimum over some: near by, so that a few Gauss-Newton
// steps reach it.

#include <Eigen/Core>

#include "identify/penalty/penalty_parts.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// Gauss-Newton in a box, each step from sums over the parts, damped when one leads uphill; ends
/// when the way left is below 2e-5 standard errors.
Eigen::VectorXd refit(const PenaltyParts& parts, const search::Domain& domain,
                      const Eigen::VectorXd& start, base::Pool* pool);

}  // namespace jointid::identify
