#pragma once
// The reduction of least squares over very many windows: the triangle of a tall matrix.

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "base/pool.hpp"

namespace jointid::identify {

/// R of the QR decomposition of a tall matrix, by blocks of rows and then of their triangles. Least
/// squares needs nothing else of the matrix (Golub and Van Loan, 5.2).
Eigen::MatrixXd triangle(const Eigen::Ref<const Eigen::MatrixXd>& matrix, base::Pool* pool);

/// Least-squares coefficients of some columns for another one, and the norm of the remainder. None
/// unless the columns, scaled to unit norm, are clearly independent.
std::optional<std::pair<Eigen::VectorXd, double>> solve_independent(
    const Eigen::Ref<const Eigen::MatrixXd>& triangle, const std::vector<Eigen::Index>& columns,
    Eigen::Index target);

}  // namespace jointid::identify
