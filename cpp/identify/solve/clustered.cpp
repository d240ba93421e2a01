#include "identify/solve/clustered.hpp"

#include <algorithm>
#include <cstddef>

#include "base/decompositions.hpp"
#include "base/gram.hpp"

namespace jointid::identify {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Remaining freedom of a direction that one segment determines completely.
constexpr double kLeast = 0.05;
// Largest norm of a segment's shares at which the series of its correction takes fewer operations
// than eigenvalues.
constexpr double kSmallShare = 0.5;

/// scores -> (1 - shares)^(-1/2) scores, by the binomial series; false if it converges slowly.
bool correct_by_series(const MatrixXd& shares, VectorXd& scores) {
  if (!(shares.norm() < kSmallShare)) return false;
  const double enough = 1e-17 * scores.norm();
  VectorXd term = scores;
  VectorXd next(term.size());
  for (double k = 1.0; term.norm() > enough; k += 1.0) {
    next.setZero();
    for (Index j = 0; j < next.size(); ++j) next += shares.col(j) * term[j];
    term = next * ((k - 0.5) / k);
    scores += term;
  }
  return true;
}

}  // namespace

MatrixXd whitened_rows(const Eigen::Ref<const MatrixXd>& jacobian, const MatrixXd& whitening) {
  MatrixXd rows(jacobian.rows(), whitening.rows());
  for (Index i = 0; i < rows.cols(); ++i) {
    rows.col(i) = base::sum_of(jacobian, whitening.row(i).transpose());
  }
  return rows;
}

Clustered cluster(const MatrixXd& rows, const VectorXd& residual, const MatrixXd& whitening,
                  const std::vector<std::int64_t>& cuts) {
  const auto count = static_cast<Index>(cuts.size()) - 1;
  const Index parameters = whitening.cols();
  const VectorXd unit = whitening.colwise().squaredNorm();
  Clustered result;
  result.segments = count;
  result.covariance.setZero(parameters, parameters);
  result.freedom = VectorXd::Ones(parameters);
  if (rows.cols() == 0) return result;  // nothing is determined
  VectorXd even = VectorXd::Zero(parameters);
  double pooled = 0.0;
  MatrixXd shares;
  MatrixXd whitened;
  VectorXd scores;
  VectorXd corrected;
  VectorXd effect;
  for (Index i = 0; i < count; ++i) {
    const Index first = cuts[static_cast<std::size_t>(i)];
    const Index length = cuts[static_cast<std::size_t>(i) + 1] - first;
    const auto mine = rows.middleRows(first, length);
    shares = base::symmetric_products(mine, mine);
    scores = base::products(mine, residual.segment(first, length));
    if (!correct_by_series(shares, scores)) {
      const auto [values, vectors] = base::eigenpairs(shares);
      corrected.noalias() = vectors.transpose() * scores;
      corrected.array() /= (1.0 - values.array()).max(kLeast).sqrt();
      scores.noalias() = vectors * corrected;
    }
    effect.noalias() = whitening.transpose() * scores;
    result.covariance.noalias() += effect * effect.transpose();
    result.size += scores.squaredNorm();
    pooled += shares.squaredNorm();
    // Share of each parameter's variance that this segment contributes if the residuals are white.
    whitened.noalias() = shares * whitening;
    for (Index p = 0; p < parameters; ++p) {
      const double part = whitened.col(p).dot(whitening.col(p));
      const double share = std::clamp(unit[p] > 0.0 ? part / unit[p] : part, 0.0, 1.0);
      even[p] += share * share;
    }
  }
  result.freedom = even.unaryExpr([](double value) { return value > 0.0 ? 1.0 / value : 1.0; });
  const auto directions = static_cast<double>(rows.cols());
  result.pooled_freedom = directions * directions / std::max(pooled, 1e-300);
  return result;
}

VectorXd variances_of_rows(const MatrixXd& rows, const VectorXd& residual,
                           const MatrixXd& whitening) {
  VectorXd total(whitening.cols());
  for (Index p = 0; p < total.size(); ++p) {
    total[p] = base::sum_of(rows, whitening.col(p)).cwiseProduct(residual).squaredNorm();
  }
  return total;
}

}  // namespace jointid::identify
