#include "identify/compressed/compressed_penalty.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/clones.hpp"
#include "base/decompositions.hpp"
#include "base/digits.hpp"

namespace jointid::identify {

namespace {

constexpr double kTolerance = 1e-14;  // share of the shaped columns' squared norm
constexpr int kAttempts = 3;
constexpr double kDenser = 1.4;
constexpr int kDegree = 11;
constexpr std::size_t kWidest = 512;   // most functions of a table, and most rows
constexpr Eigen::Index kBatch = 4096;  // candidates between two polls
constexpr std::size_t kLanes = ShapeTable::kLanes;

/// Data of the inner loop as plain numbers.
struct View {
  const ShapeTable* table;
  const double* triangle;  ///< padded rows by columns; the target is last
  std::size_t rows;
  std::size_t padded;
  const Eigen::Index* constant;
  std::size_t constants;
  const Eigen::Index* shaped;
  std::size_t shapeds;
  Eigen::Index coefficients;
  Eigen::Index gain;  ///< -1: residual torque
};

inline double penalty_of(const View& v, const double* theta) {
  std::array<double, kWidest> functions;
  std::array<double, kWidest> residual;
  const double* column = v.triangle + v.constants * v.padded;
  for (std::size_t r = 0; r < v.padded; ++r) residual[r] = column[r];
  for (std::size_t j = 0; j < v.constants; ++j) {
    column = v.triangle + j * v.padded;
    const double c = theta[v.constant[j]];
    for (std::size_t r = 0; r < v.padded; ++r) residual[r] -= c * column[r];
  }
  double remainder = 0.0;
  if (v.shapeds > 0) {
    v.table->values(theta[v.coefficients], functions.data());
    const double* product = functions.data() + v.shapeds * v.rows;
    for (std::size_t j = 0; j < v.shapeds; ++j) {
      const double s = theta[v.shaped[j]];
      const double* own = functions.data() + j * v.rows;
      for (std::size_t r = 0; r < v.rows; ++r) residual[r] -= s * own[r];
      for (std::size_t i = 0; i < j; ++i) remainder += 2.0 * s * theta[v.shaped[i]] * *product++;
      remainder += s * s * *product++;
    }
  }
  double sum = remainder > 0.0 ? remainder : 0.0;
  for (std::size_t r = 0; r < v.rows; ++r) sum += residual[r] * residual[r];
  if (v.gain >= 0) {
    const double scale = 1.0 / theta[v.gain];
    sum *= scale * scale;
  }
  return sum;
}

JOINTID_CLONES void penalties_of(const View& view, const double* theta, Eigen::Index stride,
                                 Eigen::Index count, double* penalties) {
  for (Eigen::Index i = 0; i < count; ++i) penalties[i] = penalty_of(view, theta + i * stride);
}

/// The transposed Cholesky factor of the inner products of the remainders, zero where they vanish.
/// With `slope`, which holds the derivatives of the inner products, also the factor's derivative.
Eigen::MatrixXd root_of(const double* products, Eigen::Index size, const double* slope,
                        Eigen::MatrixXd* derivative) {
  const auto square = [&](const double* from) {
    Eigen::MatrixXd full(size, size);
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i <= j; ++i) full(i, j) = full(j, i) = *from++;
    }
    return full;
  };
  const Eigen::MatrixXd full = square(products);
  const auto factor = base::cholesky(full);
  if (derivative != nullptr) derivative->setZero(size, size);
  if (!factor || !(full.diagonal().minCoeff() > 0.0)) {
    return full.diagonal().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  }
  const Eigen::MatrixXd& lower = *factor;
  if (slope != nullptr) {
    // dL = L F(L^-1 dG L^-T), where F takes the lower triangle with half the diagonal.
    const Eigen::MatrixXd left = base::solve_lower(lower, square(slope));
    Eigen::MatrixXd both = base::solve_lower(lower, left.transpose());
    both.diagonal() *= 0.5;
    const Eigen::MatrixXd inner = both.triangularView<Eigen::Lower>();
    *derivative = (lower * inner).transpose();
  }
  return lower.transpose();
}

}  // namespace

CompressedPenalty::CompressedPenalty(const Penalty& frame)
    : names_(frame.names()),
      coefficients_(frame.coefficients()),
      residual_(frame.residual()),
      gain_index_(frame.gain_index()) {
  for (Eigen::Index j = 0; j < coefficients_; ++j) {
    (frame.is_shaped(j) ? shaped_ : constant_).push_back(j);
  }
  rows_ = static_cast<Eigen::Index>(constant_.size()) + 1;
  if (has_too_many_terms()) reason_ = "the model has too many terms";
  if (!frame.is_linear()) reason_ = "load friction acts on the sum of all other terms";
}

CompressedPenalty::CompressedPenalty(const Penalty& penalty, const search::Domain& domain,
                                     base::Pool& pool)
    : CompressedPenalty(penalty) {
  domain.validate();
  if (domain.size() != penalty.parameters()) {
    throw std::invalid_argument("domain must have " + std::to_string(penalty.parameters()) +
                                " parameters, got " + std::to_string(domain.size()));
  }
  if (reason_.empty()) build(penalty, domain, pool);
}

CompressedPenalty::CompressedPenalty(const Penalty& frame, const std::optional<ShapeNodes>& nodes,
                                     const Digest& whole)
    : CompressedPenalty(frame) {
  if (reason_.empty()) assemble(nodes, whole);
}

bool CompressedPenalty::has_too_many_terms() const {
  const auto shaped = static_cast<Eigen::Index>(shaped_.size());
  return static_cast<std::size_t>(rows_ * (shaped + 1) + pairs(shaped)) + 2 * kLanes > kWidest;
}

void CompressedPenalty::build(const Penalty& penalty, const search::Domain& domain,
                              base::Pool& pool) {
  if (shaped_.empty()) {
    assemble(std::nullopt, digest_all(penalty, {}, pool));
    return;
  }
  const double speed = penalty.peak_speed();
  double density = 1.0;
  for (int attempt = 0; attempt < kAttempts && !exact_; ++attempt, density *= kDenser) {
    const auto nodes = shape_nodes(penalty, domain, speed, density, reason_);
    if (!nodes) return;
    assemble(nodes, digest_all(penalty, nodes->rates, pool));
  }
}

void CompressedPenalty::take_triangle(const Eigen::MatrixXd& triangle) {
  const auto lanes = static_cast<Eigen::Index>(kLanes);
  triangle_ = Eigen::MatrixXd::Zero((rows_ + lanes - 1) / lanes * lanes, rows_);
  triangle_.topRows(rows_) = triangle;
  target_ = Eigen::VectorXd::Zero(rows_ + static_cast<Eigen::Index>(shaped_.size()));
  target_.head(rows_) = triangle.col(rows_ - 1);
}

void CompressedPenalty::compare(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected,
                                double scale) {
  const auto size = static_cast<Eigen::Index>(shaped_.size()) * rows_;
  error_ = 0.0;
  if (found.cols() > 0) {
    const Eigen::MatrixXd difference = (found - expected).cwiseAbs();
    error_ = std::max(0.1 * difference.topRows(size).maxCoeff() / std::sqrt(scale),
                      difference.bottomRows(difference.rows() - size).maxCoeff() / scale);
  }
  exact_ = error_ <= kTolerance;
  reason_ = exact_ ? ""
                   : "the shapes' functions could not be interpolated to " +
                         base::with_digits(kTolerance, 2) + ": an error of " +
                         base::with_digits(error_, 2) + " is left after " +
                         std::to_string(passes_) + " shapes";
}

void CompressedPenalty::assemble(const std::optional<ShapeNodes>& nodes, const Digest& whole) {
  take_triangle(whole.triangle);
  exact_ = true;
  if (!nodes) return;
  const Eigen::MatrixXd functions = functions_of(whole);
  passes_ = functions.cols();
  // The probes give the error of the table between the nodes.
  const auto probes = static_cast<Eigen::Index>(nodes->probes.size());
  const Eigen::MatrixXd at_nodes = functions.leftCols(functions.cols() - probes);
  table_.emplace(nodes->axis, at_nodes, kDegree);
  const auto size = static_cast<Eigen::Index>(shaped_.size()) * rows_;
  const auto products = at_nodes.bottomRows(at_nodes.rows() - size).cwiseAbs().colwise().sum();
  // Squared norm of the shaped columns.
  const double scale = std::max(
      1e-300, at_nodes.topRows(size).colwise().squaredNorm().maxCoeff() + products.maxCoeff());
  Eigen::MatrixXd found(functions.rows(), probes);
  std::vector<double> values(table_->width());
  for (Eigen::Index i = 0; i < probes; ++i) {
    table_->values(nodes->probes[static_cast<std::size_t>(i)], values.data());
    found.col(i) = Eigen::Map<const Eigen::VectorXd>(values.data(), found.rows());
  }
  compare(found, functions.rightCols(probes), scale);
}

void CompressedPenalty::require_made() const {
  if (target_.size() == 0) throw std::invalid_argument("it is not compressed: " + reason_);
}

void CompressedPenalty::require_inside(double shape) const {
  const double lower = table_->axis().lower();
  const double upper = table_->axis().upper();
  if (shape >= lower && shape <= upper) return;
  throw std::invalid_argument(names_[static_cast<std::size_t>(coefficients_)] +
                              " must lie within the bounds it was compressed for, " +
                              std::to_string(lower) + " to " + std::to_string(upper) + ", got " +
                              std::to_string(shape));
}

void CompressedPenalty::columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
                                const base::Cancel* /*cancel*/) const {
  require_made();
  result.setZero(target_.size(), coefficients_);
  for (std::size_t j = 0; j < constant_.size(); ++j) {
    result.col(constant_[j]).head(rows_) = triangle_.col(static_cast<Eigen::Index>(j)).head(rows_);
  }
  if (!table_) return;
  require_inside(shapes[0]);
  const Eigen::MatrixXd shaped = shaped_columns(shapes[0]);
  for (std::size_t j = 0; j < shaped_.size(); ++j) {
    result.col(shaped_[j]) = shaped.col(static_cast<Eigen::Index>(j));
  }
}

Eigen::MatrixXd CompressedPenalty::shaped_columns(double shape) const {
  const auto count = static_cast<Eigen::Index>(shaped_.size());
  std::array<double, kWidest> functions;
  table_->values(shape, functions.data());
  Eigen::MatrixXd result(rows_ + count, count);
  result.topRows(rows_) = Eigen::Map<const Eigen::MatrixXd>(functions.data(), rows_, count);
  result.bottomRows(count) = root_of(functions.data() + rows_ * count, count, nullptr, nullptr);
  return result;
}

Eigen::MatrixXd CompressedPenalty::shaped_slopes(double shape) const {
  const auto count = static_cast<Eigen::Index>(shaped_.size());
  std::array<double, kWidest> functions;
  std::array<double, kWidest> slopes;
  table_->values(shape, functions.data());
  table_->slopes(shape, slopes.data());
  Eigen::MatrixXd lower;
  root_of(functions.data() + rows_ * count, count, slopes.data() + rows_ * count, &lower);
  Eigen::MatrixXd result(rows_ + count, count);
  result.topRows(rows_) = Eigen::Map<const Eigen::MatrixXd>(slopes.data(), rows_, count);
  result.bottomRows(count) = lower;
  return result;
}

double CompressedPenalty::operator()(const Eigen::VectorXd& theta,
                                     const base::Cancel* /*cancel*/) const {
  check(theta);
  Eigen::VectorXd penalty(1);
  base::Pool pool(1);
  evaluate(theta, penalty, pool);
  return penalty[0];
}

void CompressedPenalty::residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                                  Eigen::MatrixXd* jacobian, const base::Cancel* /*cancel*/) const {
  check(theta);
  Eigen::MatrixXd all;
  columns(theta.tail(parameters() - coefficients_), all);
  residual = target_;
  residual.noalias() -= all * theta.head(coefficients_);
  if (jacobian != nullptr) {
    jacobian->setZero(target_.size(), parameters());
    jacobian->leftCols(coefficients_) = -all;
    if (table_) {
      const auto count = static_cast<Eigen::Index>(shaped_.size());
      Eigen::VectorXd s(count);
      for (Eigen::Index j = 0; j < count; ++j) s[j] = theta[shaped_[static_cast<std::size_t>(j)]];
      jacobian->col(coefficients_) = -shaped_slopes(theta[coefficients_]) * s;
    }
  }
  if (residual_ != Residual::sensor) return;
  const double scale = 1.0 / theta[gain_index_];
  residual *= scale;
  if (jacobian != nullptr) {
    *jacobian *= scale;
    jacobian->col(gain_index_) -= scale * residual;
  }
}

void CompressedPenalty::evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                                 base::Pool& pool) const {
  require_made();
  const View view{table_ ? &*table_ : nullptr,
                  triangle_.data(),
                  static_cast<std::size_t>(rows_),
                  static_cast<std::size_t>(triangle_.rows()),
                  constant_.data(),
                  constant_.size(),
                  shaped_.data(),
                  shaped_.size(),
                  coefficients_,
                  residual_ == Residual::sensor ? gain_index_ : -1};
  penalties.resize(candidates.cols());
  // With so little work per candidate, threads would cost more.
  for (Eigen::Index begin = 0; begin < candidates.cols(); begin += kBatch) {
    if (begin > 0) pool.poll();
    const Eigen::Index count = std::min(kBatch, candidates.cols() - begin);
    for (Eigen::Index i = begin; table_ && i < begin + count; ++i) {
      require_inside(candidates(coefficients_, i));
    }
    penalties_of(view, candidates.col(begin).data(), candidates.rows(), count,
                 penalties.data() + begin);
  }
}

}  // namespace jointid::identify
