#include "identify/solve/covariance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/singular.hpp"
#include "base/student.hpp"
#include "identify/solve/clustered.hpp"

namespace jointid::identify {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Residuals that are white are refused as such in one of a hundred cases, by each of two tests.
constexpr double kCertain = 0.01;
constexpr double kCertainNormal = 2.326;
constexpr double kOpposed = 0.2;  // correlation of neighbours; by their noise alone it is -0.5
// A parameter that fewer segments determine borrows the missing degrees of freedom from the others.
constexpr double kFewest = 5.0;
constexpr double kKnown = 1e-10;     // of the largest singular value
constexpr double kInvolved = 1e-3;   // of a direction that is not known
constexpr double kExact = 1e-40;     // noise of a fit without residuals
constexpr double kSingular = 1e-10;  // least eigenvalue of correlations that are inverted
// Of the largest singular value: two identical columns are fully correlated.
constexpr double kFloor = 1e-12;

/// The same with ones for what is not above zero.
VectorXd or_one(const VectorXd& sizes) {
  return (sizes.array() > 0.0).select(sizes, 1.0);
}

/// Scaled to ones on the diagonal.
MatrixXd correlations(const MatrixXd& matrix, const VectorXd& sizes) {
  const VectorXd inverse = sizes.cwiseInverse();
  return inverse.asDiagonal() * matrix * inverse.asDiagonal();
}

/// Whether neighbouring windows, or windows of a segment, agree more than independent ones would,
/// or far less: what the velocity's noise adds to one window it takes from the next, and sums over
/// a segment know it.
bool contradicted(const VectorXd& residual, double pooled, double pooled_freedom) {
  const Index n = residual.size();
  const double neighbours = residual.tail(n - 1).dot(residual.head(n - 1)) / residual.squaredNorm();
  const double freedom = std::max(pooled_freedom - 1.0, 1.0);
  const double limit = base::chi_square_quantile(kCertain, freedom) / freedom;
  return neighbours * std::sqrt(static_cast<double>(n)) > kCertainNormal ||
         neighbours < -kOpposed || pooled > limit;
}

/// Mean of two matrices of correlations; with one weight for all pairs it is one, too.
MatrixXd mean_correlation(const MatrixXd& clustered, const MatrixXd& classical, double weight) {
  const auto scaled = [](const MatrixXd& matrix) {
    return correlations(matrix, or_one(matrix.diagonal().cwiseSqrt()));
  };
  MatrixXd found = weight * scaled(clustered) + (1.0 - weight) * scaled(classical);
  found.diagonal().setOnes();
  return found;
}

/// The inverse of a covariance, whatever the units.
MatrixXd inverse_of(const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(correlations(covariance, scale));
  // Of segments fewer than parameters the correlations are barely a matrix of correlations.
  const VectorXd inverse = solver.eigenvalues().cwiseMax(kSingular).cwiseInverse();
  const auto& vectors = solver.eigenvectors();
  return correlations(vectors * inverse.asDiagonal() * vectors.transpose(), scale);
}

/// Correlations, condition and the least determined direction, of columns after centring.
void correlate(MatrixXd triangle, const std::optional<Centre>& centre, Covariance& result) {
  if (centre) {
    const VectorXd offset = triangle.col(centre->offset);
    triangle.col(centre->gain) -= centre->mean * offset;
  }
  const VectorXd norms = or_one(triangle.colwise().norm().transpose());
  const Index least = std::min(triangle.rows(), triangle.cols()) - 1;
  const auto found = base::singular(triangle * norms.cwiseInverse().asDiagonal());
  const double largest = found.values[0];
  const VectorXd inverse =
      found.values.cwiseMax(kFloor * largest + 1e-150).cwiseInverse().cwiseAbs2();
  const MatrixXd spread = found.directions * inverse.asDiagonal() * found.directions.transpose();
  result.correlation =
      correlations(spread, spread.diagonal().cwiseSqrt()).cwiseMax(-1.0).cwiseMin(1.0);
  result.correlation.diagonal().setOnes();
  const double smallest = found.values[least];
  result.condition = smallest > 0.0 ? largest / smallest : std::numeric_limits<double>::infinity();
  result.weakest = found.directions.col(least);
}

}  // namespace

Stretch stretch_of(const Eigen::Ref<const MatrixXd>& jacobian, const VectorXd& residual,
                   const MatrixXd& whitening, const Cuts& cuts) {
  const Index directions = whitening.rows();
  const auto count = static_cast<double>(residual.size());
  const double freedom = std::max(1.0, count - static_cast<double>(directions));
  const double variance = residual.squaredNorm() / freedom;
  const VectorXd unit = whitening.colwise().squaredNorm();
  const VectorXd classical = or_one(unit * variance);
  Stretch result;
  result.ratio.setOnes(unit.size());
  result.freedom.setConstant(unit.size(), freedom);
  if (directions == 0 || !(variance > 0.0)) return result;
  const MatrixXd rows = whitened_rows(jacobian, whitening);
  const auto ways = static_cast<double>(cuts.size());
  double size = 0.0;
  double pooled_freedom = 0.0;
  MatrixXd covariance = MatrixXd::Zero(unit.size(), unit.size());
  VectorXd own = VectorXd::Zero(unit.size());
  for (const auto& each : cuts) {
    const auto found = cluster(rows, residual, whitening, each);
    if (found.segments < 3) return result;
    size += found.size / ways;
    pooled_freedom += found.pooled_freedom / ways;
    covariance += found.covariance / ways;
    own += found.freedom / ways;
  }
  const double pooled = size / (static_cast<double>(directions) * variance);
  if (!contradicted(residual, pooled, pooled_freedom)) {
    const VectorXd alone = variances_of_rows(rows, residual, whitening) * (count / freedom);
    result.ratio = alone.cwiseQuotient(classical).cwiseMax(1.0);
    return result;
  }
  // One is lost to the mean that the fit took from each direction.
  own = (own.array() - 1.0).max(1.0);
  const VectorXd borrowed = (kFewest - own.array()).max(0.0);
  const VectorXd together = own + borrowed;
  const VectorXd ratio = covariance.diagonal().cwiseQuotient(classical);
  result.ratio = (own.cwiseProduct(ratio) + borrowed * pooled).cwiseQuotient(together);
  result.freedom = together;
  result.white = false;
  result.correlation = mean_correlation(covariance, whitening.transpose() * whitening,
                                        own.cwiseQuotient(together).minCoeff());
  return result;
}

Covariance covariance_of(const Eigen::Ref<const MatrixXd>& jacobian, const VectorXd& residual,
                         const MatrixXd& triangle, const Cuts& cuts,
                         const std::optional<Centre>& centre) {
  const Index parameters = jacobian.cols();
  const Index left = jacobian.rows() - parameters;
  const VectorXd norms = triangle.colwise().norm();
  const VectorXd scale = or_one(norms);
  const auto found = base::singular(triangle * scale.cwiseInverse().asDiagonal());
  const double least = kKnown * found.values[0];
  Index known = 0;
  while (known < parameters && found.values[known] > least) ++known;
  const auto sizes = found.values.head(known);
  const auto directions = found.directions.leftCols(known);
  const double noise = residual.squaredNorm() / static_cast<double>(std::max<Index>(1, left));
  const MatrixXd whitening = sizes.cwiseInverse().asDiagonal() * directions.transpose() *
                             scale.cwiseInverse().asDiagonal();
  const auto stretch = stretch_of(jacobian, residual, whitening, cuts);
  const VectorXd wider = stretch.ratio.cwiseSqrt();
  Covariance result;
  result.freedom = stretch.freedom;
  result.white = stretch.white;
  result.matrix =
      wider.asDiagonal() * (whitening.transpose() * whitening * noise).eval() * wider.asDiagonal();
  if (stretch.correlation) {
    const VectorXd error = result.matrix.diagonal().cwiseSqrt();
    result.matrix = error.asDiagonal() * *stretch.correlation * error.asDiagonal();
  }
  Eigen::Array<bool, Eigen::Dynamic, 1> unknown(parameters);
  for (Index i = 0; i < parameters; ++i) {
    const auto hidden = found.directions.row(i).tail(parameters - known);
    unknown[i] = norms[i] == 0.0 || (hidden.array().abs() > kInvolved).any();
  }
  if (left <= 0) unknown.setConstant(true);  // no degree of freedom to estimate the noise
  if (left <= 0) {
    result.information.setZero(parameters, parameters);
  } else if (stretch.correlation && !unknown.any()) {
    result.information = inverse_of(result.matrix);
  } else {
    const VectorXd of_all = scale.cwiseQuotient(wider) / std::max(std::sqrt(noise), kExact);
    const MatrixXd inner = directions * sizes.cwiseAbs2().asDiagonal() * directions.transpose();
    result.information = of_all.asDiagonal() * inner * of_all.asDiagonal();
  }
  for (Index i = 0; i < parameters; ++i) {
    if (unknown[i]) result.matrix(i, i) = std::numeric_limits<double>::infinity();
  }
  result.stderr_ = result.matrix.diagonal().cwiseSqrt();
  correlate(triangle, centre, result);
  return result;
}

}  // namespace jointid::identify
