#include "base/decompositions.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace jointid::base {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Orthogonal orthogonal(const MatrixXd& matrix) {
  const Eigen::HouseholderQR<MatrixXd> qr(matrix);
  return {qr.householderQ() * MatrixXd::Identity(matrix.rows(), matrix.cols()),
          qr.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>()};
}

Reduced reduced(const MatrixXd& matrix, const VectorXd& right) {
  const Eigen::HouseholderQR<MatrixXd> qr(matrix);
  const VectorXd turned = qr.householderQ().adjoint() * right;
  return {qr.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>(),
          turned.head(matrix.cols())};
}

VectorXd least_squares(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

MatrixXd outside(const MatrixXd& columns, const MatrixXd& matrix) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(columns);
  MatrixXd turned = matrix;
  turned.applyOnTheLeft(qr.householderQ().adjoint());
  return turned.bottomRows(matrix.rows() - qr.rank());
}

Eigenpairs eigenpairs(const MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<MatrixXd> cholesky(const MatrixXd& symmetric) {
  const Eigen::LLT<MatrixXd> factor(symmetric);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return factor.matrixL();
}

VectorXd solve_semidefinite(const MatrixXd& system, const VectorXd& right) {
  return system.ldlt().solve(right);
}

MatrixXd solve_upper(const MatrixXd& upper, const MatrixXd& right) {
  return upper.triangularView<Eigen::Upper>().solve(right);
}

MatrixXd solve_lower(const MatrixXd& lower, const MatrixXd& right) {
  return lower.triangularView<Eigen::Lower>().solve(right);
}

}  // namespace jointid::base
