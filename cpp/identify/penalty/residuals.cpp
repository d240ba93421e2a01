// Columns, residuals and their derivatives at a parameter vector.

#include "identify/penalty/penalty.hpp"

namespace jointid::identify {

void Penalty::columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
                      const base::Cancel* cancel) const {
  result = columns_;
  for (const auto& s : shaped_) {
    shaped_column(s, shapes.data(), cancel, result.col(s.coefficient));
  }
  if (cumulative_ && load_ >= 0) {
    for (Eigen::Index j = 0; j < result.cols(); ++j) {
      if (!is_shaped(j)) accumulate(result.col(j));
    }
  }
}

double Penalty::operator()(const Eigen::VectorXd& theta, const base::Cancel* cancel) const {
  Eigen::VectorXd residual;
  residuals(theta, residual, nullptr, cancel);
  return residual.squaredNorm();
}

void Penalty::residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                        Eigen::MatrixXd* jacobian, const base::Cancel* cancel) const {
  balance(theta, residual, jacobian, nullptr, cancel);
}

double Penalty::linearise(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                          Eigen::MatrixXd& jacobian, Eigen::MatrixXd& columns) const {
  balance(theta, residual, &jacobian, &columns, nullptr);
  const double penalty = residual.squaredNorm();
  observe(theta, residual);
  if (first_stage_) columns.col(gain_index_) = reading_;
  return penalty;
}

void Penalty::balance(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                      Eigen::MatrixXd* jacobian, Eigen::MatrixXd* columns,
                      const base::Cancel* cancel) const {
  check(theta);
  const Eigen::Index p = coefficients();
  if (load_ >= 0) {
    if (columns != nullptr) this->columns(theta.tail(parameters() - p), *columns, cancel);
    loaded_residuals(theta, residual, jacobian, cancel);
    divide_by_gain(theta, residual, jacobian);
    return;
  }
  if (jacobian != nullptr) {
    jacobian->resize(window_count(), parameters());
    jacobian->leftCols(p) = -columns_;
    jacobian->rightCols(parameters() - p).setZero();
  }
  if (columns != nullptr) *columns = columns_;
  residual = target_;
  residual.noalias() -= columns_ * theta.head(p);
  Eigen::MatrixXd own(shaped_.empty() ? 0 : window_count(), 1);
  const double* shapes = theta.data() + p;
  for (const auto& s : shaped_) {
    const double coefficient = theta[s.coefficient];
    if (jacobian == nullptr) {
      shaped_column(s, shapes, cancel, own.col(0));
    } else {
      shaped_slopes(s, shapes, cancel, own);
    }
    residual.noalias() -= coefficient * own.col(0);
    if (columns != nullptr) columns->col(s.coefficient) = own.col(0);
    if (jacobian == nullptr) continue;
    jacobian->col(s.coefficient) -= own.col(0);
    for (std::size_t i = 0; i < s.shapes.size(); ++i) {
      jacobian->col(p + s.shapes[i]) -= coefficient * own.col(static_cast<Eigen::Index>(i) + 1);
    }
  }
  divide_by_gain(theta, residual, jacobian);
}

void Penalty::divide_by_gain(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                             Eigen::MatrixXd* jacobian) const {
  if (residual_ != Residual::sensor) return;
  const double scale = 1.0 / theta[gain_index_];
  residual *= scale;
  if (jacobian != nullptr) {
    *jacobian *= scale;
    jacobian->col(gain_index_) -= scale * residual;
  }
}

void Penalty::evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                       base::Pool& pool) const {
  penalties.resize(candidates.cols());
  pool.for_each(
      static_cast<std::size_t>(candidates.cols()), [&](std::size_t begin, std::size_t end) {
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
          penalties[i] = (*this)(candidates.col(i), &pool.cancel());
        }
      });
}

}  // namespace jointid::identify
