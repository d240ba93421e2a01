#pragma once
// Decompositions of dense matrices. Eigen's templates behind them take most of a file's time in the
// compiler, so they are instantiated here alone.

#include <Eigen/Core>
#include <optional>

namespace jointid::base {

struct Orthogonal {
  Eigen::MatrixXd basis;     ///< orthonormal columns, as many as the matrix has
  Eigen::MatrixXd triangle;  ///< matrix = basis triangle
};

/// The QR decomposition of a matrix with at least as many rows as columns.
Orthogonal orthogonal(const Eigen::MatrixXd& matrix);

struct Reduced {
  Eigen::MatrixXd triangle;
  Eigen::VectorXd right;  ///< triangle x = right has the least-squares solution
};

/// A least-squares problem with at least as many rows as columns, reduced to its triangle.
Reduced reduced(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// The least-squares solution; dependent columns get zero.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Coordinates of what the columns of `matrix` have outside the range of `columns`.
Eigen::MatrixXd outside(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& matrix);

struct Eigenpairs {
  Eigen::VectorXd values;   ///< the smallest first
  Eigen::MatrixXd vectors;  ///< a column each
};

Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The lower Cholesky factor; none of a matrix that is not positive definite.
std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& symmetric);

/// The solution of a positive semidefinite system.
Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& system, const Eigen::VectorXd& right);

/// The upper triangle alone of `upper` is read.
Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& upper, const Eigen::MatrixXd& right);

/// The lower triangle alone of `lower` is read.
Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& right);

}  // namespace jointid::base
