#include "identify/solve/covariance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/decompositions.hpp"
#include "base/singular.hpp"
#include "base/student.hpp"
#include "identify/solve/clustered.hpp"

namespace jointid::identify {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Each of two tests rejects white residuals in one of a hundred cases.
constexpr double kCertain = 0.01;
constexpr double kCertainNormal = 2.326;
constexpr double kOpposed =
    0.2;  // correlation of neighbours; the velocity's noise alone gives -0.5
// A parameter that fewer segments determine borrows the missing degrees of freedom from the others.
constexpr double kFewest = 5.0;
constexpr double kKnown = 1e-10;  // of the largest singular value
constexpr double kInvolved =
    1e-3;                         // share of an unknown direction from which a parameter is unknown
constexpr double kExact = 1e-40;  // noise of a fit without residuals
constexpr double kSingular = 1e-10;  // least eigenvalue of inverted correlation matrices
// Of the largest singular value: two identical columns are fully correlated.
constexpr double kIdentical = 1e-12;

// Plain loops over a few parameters: Eigen's expressions made a wheel 3 kB larger.

/// values[i] *= factor[i] factor[j]
void scale(MatrixXd& values, const double* factor) {
  for (Index j = 0; j < values.cols(); ++j) {
    for (Index i = 0; i < values.rows(); ++i) values(i, j) *= factor[i] * factor[j];
  }
}

/// The sum of weight[k] d_k d_k' over the first `count` columns.
MatrixXd weighted_squares(const MatrixXd& columns, const double* weight, Index count) {
  MatrixXd sum = MatrixXd::Zero(columns.rows(), columns.rows());
  for (Index k = 0; k < count; ++k) {
    for (Index j = 0; j < sum.cols(); ++j) {
      const double with = weight[k] * columns(j, k);
      for (Index i = 0; i < sum.rows(); ++i) sum(i, j) += with * columns(i, k);
    }
  }
  return sum;
}

VectorXd norms_of(const MatrixXd& columns) {
  VectorXd norms(columns.cols());
  for (Index j = 0; j < norms.size(); ++j) norms[j] = columns.col(j).norm();
  return norms;
}

/// The inverse of each value; 1 for values that are not above zero.
VectorXd inverse_or_one(VectorXd sizes) {
  for (double& size : sizes) size = size > 0.0 ? 1.0 / size : 1.0;
  return sizes;
}

/// The roots of a diagonal, or their inverses (1 where one is zero).
VectorXd errors_of(const MatrixXd& matrix, bool inverse) {
  VectorXd errors(matrix.rows());
  for (Index i = 0; i < errors.size(); ++i) errors[i] = std::sqrt(matrix(i, i));
  return inverse ? inverse_or_one(std::move(errors)) : errors;
}

/// Scales to ones on the diagonal, and clamps to -1 .. 1.
void make_correlation(MatrixXd& matrix) {
  scale(matrix, errors_of(matrix, true).data());
  for (double& value : matrix.reshaped()) value = std::clamp(value, -1.0, 1.0);
  for (Index i = 0; i < matrix.rows(); ++i) matrix(i, i) = 1.0;
}

/// Whether neighbouring windows, or windows of a segment, agree more than independent ones would,
/// or much less. Noise of the velocity adds to one window and subtracts from the next; sums over a
/// segment already contain this.
bool contradicted(const VectorXd& residual, double pooled, double pooled_freedom) {
  const Index n = residual.size();
  double neighbours = 0.0;
  for (Index i = 1; i < n; ++i) neighbours += residual[i] * residual[i - 1];
  neighbours /= residual.squaredNorm();
  const double freedom = std::max(pooled_freedom - 1.0, 1.0);
  const double limit = base::chi_square_quantile(kCertain, freedom) / freedom;
  return neighbours * std::sqrt(static_cast<double>(n)) > kCertainNormal ||
         neighbours < -kOpposed || pooled > limit;
}

/// The inverse of a covariance, independent of the units.
MatrixXd inverse_of(MatrixXd covariance) {
  const VectorXd units = errors_of(covariance, true);
  scale(covariance, units.data());
  auto [inverse, vectors] = base::eigenpairs(covariance);
  // With fewer segments than parameters, the correlation matrix is nearly singular.
  for (double& value : inverse) value = 1.0 / std::max(value, kSingular);
  MatrixXd result = weighted_squares(vectors, inverse.data(), inverse.size());
  scale(result, units.data());
  return result;
}

MatrixXd scaled_columns(MatrixXd matrix, const VectorXd& factor) {
  for (Index j = 0; j < matrix.cols(); ++j) matrix.col(j) *= factor[j];
  return matrix;
}

/// Correlations, condition and the least determined direction of the columns after centring.
void correlate(MatrixXd triangle, const std::optional<Centre>& centre, Covariance& result) {
  if (centre) {
    for (Index i = 0; i < triangle.rows(); ++i) {
      triangle(i, centre->gain) -= centre->mean * triangle(i, centre->offset);
    }
  }
  const VectorXd factor = inverse_or_one(norms_of(triangle));
  const Index least = std::min(triangle.rows(), triangle.cols()) - 1;
  const auto found = base::singular(scaled_columns(std::move(triangle), factor));
  const double largest = found.values[0];
  const double smallest = found.values[least];
  VectorXd inverse = found.values;
  for (double& value : inverse) {
    const double size = std::max(value, kIdentical * largest + 1e-150);
    value = 1.0 / (size * size);
  }
  result.correlation = weighted_squares(found.directions, inverse.data(), least + 1);
  make_correlation(result.correlation);
  result.condition = smallest > 0.0 ? largest / smallest : std::numeric_limits<double>::infinity();
  result.weakest = found.directions.col(least);
}

/// Ratio of the variances to those of white residuals with one variance.
struct Widening {
  VectorXd ratio;
  VectorXd freedom;  ///< of each variance
  bool white = true;
  /// Correlations of the parameters from segments; none if the classical ones hold. If few segments
  /// determine a parameter, the classical correlations have the weight of the borrowed freedom.
  std::optional<MatrixXd> correlation;
};

/// `whitening` scales the scores of the determined directions to unit variance. Its product with
/// itself, `unit`, is the covariance for residuals of unit variance.
Widening widening_of(const Eigen::Ref<const MatrixXd>& jacobian, const VectorXd& residual,
                     const MatrixXd& whitening, const MatrixXd& unit, const Cuts& cuts) {
  const Index parameters = whitening.cols();
  const auto directions = static_cast<double>(whitening.rows());
  const auto count = static_cast<double>(residual.size());
  const double freedom = std::max(1.0, count - directions);
  const double variance = residual.squaredNorm() / freedom;
  Widening result;
  result.ratio.setOnes(parameters);
  result.freedom.setConstant(parameters, freedom);
  if (whitening.rows() == 0 || !(variance > 0.0)) return result;
  VectorXd inverse = unit.diagonal() * variance;
  inverse = inverse_or_one(std::move(inverse));
  const MatrixXd rows = whitened_rows(jacobian, whitening);
  const auto ways = static_cast<double>(cuts.size());
  double size = 0.0;
  double pooled_freedom = 0.0;
  MatrixXd covariance = MatrixXd::Zero(parameters, parameters);
  VectorXd own = VectorXd::Zero(parameters);
  for (const auto& each : cuts) {
    const auto found = cluster(rows, residual, whitening, each);
    if (found.segments < 3) return result;
    size += found.size / ways;
    pooled_freedom += found.pooled_freedom / ways;
    covariance += found.covariance;
    own += found.freedom;
  }
  const double pooled = size / (directions * variance);
  if (!contradicted(residual, pooled, pooled_freedom)) {
    const VectorXd alone = variances_of_rows(rows, residual, whitening);
    for (Index i = 0; i < parameters; ++i) {
      result.ratio[i] = std::max(alone[i] * (count / freedom) * inverse[i], 1.0);
    }
    return result;
  }
  double weight = 1.0;
  for (Index i = 0; i < parameters; ++i) {
    // One degree is lost to the mean that the fit removed from each direction.
    const double mine = std::max(own[i] / ways - 1.0, 1.0);
    const double borrowed = std::max(kFewest - mine, 0.0);
    const double together = mine + borrowed;
    result.ratio[i] =
        (mine * (covariance(i, i) / ways * inverse[i]) + borrowed * pooled) / together;
    result.freedom[i] = together;
    weight = std::min(weight, mine / together);
  }
  result.white = false;
  // The mean of two correlation matrices with one weight for all pairs is a correlation matrix.
  MatrixXd classical = unit;
  make_correlation(covariance);
  make_correlation(classical);
  result.correlation = weight * covariance + (1.0 - weight) * classical;
  return result;
}

}  // namespace

Covariance covariance_of(const Eigen::Ref<const MatrixXd>& jacobian, const VectorXd& residual,
                         const MatrixXd& triangle, const Cuts& cuts,
                         const std::optional<Centre>& centre) {
  const Index parameters = jacobian.cols();
  const Index left = jacobian.rows() - parameters;
  const VectorXd norms = norms_of(triangle);
  if (!norms.allFinite()) throw std::invalid_argument("the triangle must be finite");
  const VectorXd factor = inverse_or_one(norms);
  const auto found = base::singular(scaled_columns(triangle, factor));
  const double least = kKnown * found.values[0];
  Index known = 0;
  while (known < parameters && found.values[known] > least) ++known;
  const double noise = residual.squaredNorm() / static_cast<double>(std::max<Index>(1, left));
  MatrixXd whitening(known, parameters);
  VectorXd squares(known);
  VectorXd inverse_squares(known);
  for (Index k = 0; k < known; ++k) {
    const double value = found.values[k];
    squares[k] = value * value;
    inverse_squares[k] = 1.0 / squares[k];
    for (Index j = 0; j < parameters; ++j) {
      whitening(k, j) = found.directions(j, k) / value * factor[j];
    }
  }
  Covariance result;
  result.matrix = weighted_squares(found.directions, inverse_squares.data(), known);
  scale(result.matrix, factor.data());
  auto stretch = widening_of(jacobian, residual, whitening, result.matrix, cuts);
  result.white = stretch.white;
  VectorXd wider(parameters);
  VectorXd of_all(parameters);
  Eigen::Array<bool, Eigen::Dynamic, 1> unknown(parameters);
  bool any = false;
  const double size = std::sqrt(noise);
  for (Index i = 0; i < parameters; ++i) {
    const double root = std::sqrt(stretch.ratio[i]);
    wider[i] = root * size;
    of_all[i] = 1.0 / (factor[i] * root * std::max(size, kExact));
    unknown[i] = left <= 0;  // there is no data left to estimate the noise
    for (Index k = known; k < parameters; ++k) {
      unknown[i] = unknown[i] || std::fabs(found.directions(i, k)) > kInvolved;
    }
    any = any || unknown[i];
  }
  scale(result.matrix, wider.data());
  if (stretch.correlation) {
    const VectorXd errors = errors_of(result.matrix, false);
    result.matrix = *stretch.correlation;
    scale(result.matrix, errors.data());
  }
  if (left <= 0) {
    result.information.setZero(parameters, parameters);
  } else if (stretch.correlation && !any) {
    result.information = inverse_of(result.matrix);
  } else {
    result.information = weighted_squares(found.directions, squares.data(), known);
    scale(result.information, of_all.data());
  }
  for (Index i = 0; i < parameters; ++i) {
    if (unknown[i]) result.matrix(i, i) = std::numeric_limits<double>::infinity();
  }
  result.stderr_ = errors_of(result.matrix, false);
  result.freedom = std::move(stretch.freedom);
  correlate(triangle, centre, result);
  return result;
}

}  // namespace jointid::identify
