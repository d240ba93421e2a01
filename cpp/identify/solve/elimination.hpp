#pragma once
// Exact elimination of the linear parameters under their bounds.

#include <Eigen/Core>

#include "identify/penalty/penalty_function.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// A linear balance for these shapes, in any orthonormal basis, with columns of all coefficients.
struct Balance {
  const Eigen::MatrixXd& columns;
  const Eigen::VectorXd& target;
  Residual residual;
  Eigen::Index gain;  ///< index of sensor_gain, or -1
};

/// The best coefficients of a balance, within the domain; see below.
Eigen::VectorXd best_coefficients(const Balance& balance, const search::Domain& domain);

/// The best coefficients for these shapes, within the domain.
///
/// Residual torque: bounded least squares. Residual sensor: linear in u = 1/gain and g = c/gain,
/// where the box of each c becomes lower u <= g <= upper u. If the balance is not linear, the
/// result is only near the best. Throws std::invalid_argument if the gain's bounds contain zero.
Eigen::VectorXd best_coefficients(const PenaltyFunction& penalty, const Eigen::VectorXd& shapes,
                                  const search::Domain& domain,
                                  const base::Cancel* cancel = nullptr);

}  // namespace jointid::identify
