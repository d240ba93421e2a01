#pragma once
// Decompositions of dense matrices. Eigen's templates take most of a file's compile time, so they
// are instantiated only in decompositions.cpp.

#include <Eigen/Core>
#include <optional>

namespace jointid::base {

struct Orthogonal {
  Eigen::MatrixXd basis;     ///< orthonormal columns, the same number as in the matrix
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

/// Coordinates of the part of `matrix` outside the range of `columns`.
Eigen::MatrixXd outside(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& matrix);

struct Eigenpairs {
  Eigen::VectorXd values;   ///< the smallest first
  Eigen::MatrixXd vectors;  ///< one per column
};

Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The lower Cholesky factor; nothing if the matrix is not positive definite.
std::optional<Eigen::MatrixXd> cholesky(const Eigen::MatrixXd& symmetric);

/// The solution of a positive semidefinite system.
Eigen::VectorXd solve_semidefinite(const Eigen::MatrixXd& system, const Eigen::VectorXd& right);

/// Reads only the upper triangle of `upper`.
Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& upper, const Eigen::MatrixXd& right);

/// Reads only the lower triangle of `lower`.
Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& right);

}  // namespace jointid::base
