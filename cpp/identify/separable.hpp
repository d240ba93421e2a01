#pragma once
// Exact elimination of the linear parameters under their bounds: what remains to search is the
// shape alone.

#include <Eigen/Core>

#include "base/pool.hpp"
#include "identify/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

struct SeparableResult {
  Eigen::VectorXd best;  ///< all parameters, ordered as the penalty's names
  double penalty = 0.0;  ///< by the direct sum
  int evaluations = 0;   ///< shapes tried
};

/// The best coefficients for given shapes, within the domain.
///
/// residual torque: bounded least squares. residual sensor: linear in u = 1/gain and g = c/gain,
/// where the box of each c becomes lower u <= g <= upper u. Throws std::invalid_argument when the
/// gain's bounds contain zero.
Eigen::VectorXd best_coefficients(const Penalty& penalty, const Eigen::VectorXd& shapes,
                                  const search::Domain& domain,
                                  const base::Cancel* cancel = nullptr);

/// The separable optimum: a scan over the shape (at most one free), then golden sections around the
/// best. Without a free shape it is a single solve.
SeparableResult minimise_separable(const Penalty& penalty, const search::Domain& domain,
                                   base::Pool& pool);

}  // namespace jointid::identify
