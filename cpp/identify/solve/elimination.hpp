#pragma once
// Exact elimination of the linear parameters under their bounds.

#include <Eigen/Core>

#include "identify/penalty/penalty_function.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// A linear balance for given shapes, in any orthonormal basis: columns of all coefficients.
struct Balance {
  const Eigen::MatrixXd& columns;
  const Eigen::VectorXd& target;
  Residual residual;
  Eigen::Index gain;  ///< position of sensor_gain, or -1
};

/// The best coefficients of a balance, within the domain; see below.
Eigen::VectorXd best_coefficients(const Balance& balance, const search::Domain& domain);

/// The best coefficients for given shapes, within the domain.
///
/// residual torque: bounded least squares. residual sensor: linear in u = 1/gain and g = c/gain,
/// where the box of each c becomes lower u <= g <= upper u. Near the best only where the balance is
/// not linear. Throws std::invalid_argument when the
/// gain's bounds contain zero.
Eigen::VectorXd best_coefficients(const PenaltyFunction& penalty, const Eigen::VectorXd& shapes,
                                  const search::Domain& domain,
                                  const base::Cancel* cancel = nullptr);

}  // namespace jointid::identify
