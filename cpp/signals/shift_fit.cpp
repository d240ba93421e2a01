#include "signals/shift_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/gram.hpp"
#include "base/quantile.hpp"

namespace jointid::signals {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNear = 1e-5;         // [s], the last step of the iteration
constexpr double kLongestStep = 1e-3;  // [s]
constexpr int kSteps = 6;
constexpr int kRounds = 2;          // of weights
constexpr double kClipped = 4.0;    // medians of the residual's size: more counts for less
constexpr double kCluster = 0.3;    // [s] of motion that counts as one observation
constexpr double kFarthest = 0.02;  // [s] of a delay that is searched from no shift
constexpr double kClearlyShorter = 0.5;
constexpr double kClearErrors = 6.0;
constexpr double kSingular = 1e-11;  // of the largest eigenvalue of the scaled normal equations
constexpr double kTiny = 1e-300;

/// The window means of a signal at any shift: the smoothed signal between samples, by a cubic.
class Levels {
 public:
  explicit Levels(const ShiftRows& rows) : rows_(rows) {
    for (const auto& each : rows.stretches) {
      smooth_.push_back(smoothed(each.signal, each.weight));
      Middles used;
      for (std::size_t i = 0; i < each.middles.size(); ++i) {
        if (each.kept[i]) used.push_back(each.middles[i]);
      }
      used_.push_back(std::move(used));
    }
  }

  [[nodiscard]] const std::vector<Middles>& used() const { return used_; }

  void at(double delay, VectorXd& level) const {
    level.resize(rows_.columns.rows());
    Index to = 0;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const VectorXd& smooth = smooth_[i];
      const double moved = delay / rows_.stretches[i].period - (rows_.held ? 0.5 : 0.0);
      const double floor = std::floor(moved);
      const auto whole = static_cast<std::int64_t>(floor);
      const double p = moved - floor;
      const double a = -p * (p - 1.0) * (p - 2.0) / 6.0;
      const double b = (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0;
      const double c = (p + 1.0) * p * (p - 2.0) / 2.0;
      const double d = (p + 1.0) * p * (p - 1.0) / 6.0;
      const std::int64_t last = smooth.size() - 3;
      for (const auto middle : used_[i]) {
        const double* y = smooth.data() + std::clamp<std::int64_t>(middle + whole, 1, last);
        level[to++] = a * y[-1] + b * y[0] - c * y[1] + d * y[2];
      }
    }
  }

 private:
  const ShiftRows& rows_;
  std::vector<VectorXd> smooth_;
  std::vector<Middles> used_;
};

/// Weighted least squares on the columns, by scaled normal equations.
class Projection {
 public:
  Projection(const Eigen::Ref<const MatrixXd>& columns, const VectorXd* weights)
      : columns_(columns) {
    if (weights != nullptr) weighted_ = weights->asDiagonal() * columns;
    const MatrixXd gram = base::symmetric_products(columns, weighted());
    VectorXd scale = gram.diagonal().cwiseSqrt();
    scale = (scale.array() > 0.0).select(scale, std::numeric_limits<double>::infinity());
    const VectorXd inverse = scale.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(inverse.asDiagonal() * gram *
                                                         inverse.asDiagonal());
    const VectorXd& values = solver.eigenvalues();
    const double least = kSingular * values[values.size() - 1];
    Index first = 0;
    while (first < values.size() && !(values[first] > least)) ++first;
    rank_ = values.size() - first;
    basis_ = inverse.asDiagonal() * solver.eigenvectors().rightCols(rank_) *
             values.tail(rank_).cwiseSqrt().cwiseInverse().asDiagonal();
  }

  [[nodiscard]] Index rank() const { return rank_; }
  [[nodiscard]] VectorXd coefficients(const VectorXd& signal) const {
    const VectorXd matched = base::products(weighted(), signal);
    const VectorXd inner = basis_.transpose() * matched;
    return basis_ * inner;
  }
  /// What the columns leave of a signal.
  void rest(const VectorXd& signal, VectorXd& result) const {
    result = signal;
    base::subtract_sum(columns_, coefficients(signal), result);
  }

 private:
  [[nodiscard]] Eigen::Ref<const MatrixXd> weighted() const {
    return weighted_.size() > 0 ? Eigen::Ref<const MatrixXd>(weighted_) : columns_;
  }

  const Eigen::Ref<const MatrixXd>& columns_;
  MatrixXd weighted_;
  MatrixXd basis_;
  Index rank_ = 0;
};

/// Rates of a fitted signal, from neighbouring windows; zero beside a window left out.
class Rates {
 public:
  explicit Rates(const ShiftRows& rows) : factor_(VectorXd::Zero(rows.columns.rows())) {
    Index row = 0;
    for (const auto& each : rows.stretches) {
      const double factor = 1.0 / (2.0 * static_cast<double>(each.stride) * each.period);
      bool before = false;
      for (std::size_t i = 0; i < each.kept.size(); ++i) {
        const bool here = each.kept[i];
        if (here) {
          if (before && i + 1 < each.kept.size() && each.kept[i + 1]) factor_[row] = factor;
          ++row;
        }
        before = here;
      }
    }
  }

  void of(const VectorXd& level, Eigen::Ref<VectorXd> rate) const {
    const Index inner = level.size() - 2;  // the first and the last row have no two neighbours
    rate[0] = 0.0;
    rate[inner + 1] = 0.0;
    rate.segment(1, inner) =
        (level.tail(inner) - level.head(inner)).cwiseProduct(factor_.segment(1, inner));
  }

 private:
  VectorXd factor_;  ///< of the difference of both neighbours; 0 where one of them is left out
};

/// The number of the piece of motion that each row belongs to.
std::vector<std::size_t> clusters_of(const ShiftRows& rows, const std::vector<Middles>& used) {
  std::vector<std::size_t> groups;
  std::size_t first = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto& each = rows.stretches[i];
    const double start = each.time[0];
    const double length = std::min(kCluster, (each.time[each.time.size() - 1] - start) / 20.0);
    for (const auto middle : used[i]) {
      groups.push_back(static_cast<std::size_t>((each.time[middle] - start) / length) + first);
    }
    if (!used[i].empty()) first = groups.back() + 1;
  }
  return groups;
}

/// Inverse of one or two products; a singular pair's by its eigenvectors.
MatrixXd inverse_of(const MatrixXd& gram) {
  if (gram.size() == 1) return gram.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(gram);
  const VectorXd& values = solver.eigenvalues();
  const double least = 1e-15 * values.cwiseAbs().maxCoeff();
  const VectorXd inverse = (values.array().abs() > least).select(values.cwiseInverse(), 0.0);
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

/// Standard errors: the larger of the classical ones and those clustered over pieces of the motion.
VectorXd errors_of(const MatrixXd& slopes, const VectorXd& missed, const VectorXd& weights,
                   const std::vector<std::size_t>& groups, Index rank) {
  const MatrixXd weighted = weights.asDiagonal() * slopes;
  const MatrixXd inverse = inverse_of(slopes.transpose() * weighted);
  const auto count = static_cast<Index>(groups.empty() ? 0 : groups.back() + 1);
  MatrixXd sums = MatrixXd::Zero(count, slopes.cols());
  for (Index part = 0; part < slopes.cols(); ++part) {
    const double* slope = weighted.col(part).data();
    double* sum = sums.col(part).data();
    for (std::size_t row = 0; row < groups.size(); ++row) {
      sum[groups[row]] += slope[row] * missed[static_cast<Index>(row)];
    }
  }
  std::size_t pieces = groups.empty() ? 0 : 1;  // they come in order
  for (std::size_t row = 1; row < groups.size(); ++row) {
    pieces += groups[row] != groups[row - 1] ? 1 : 0;
  }
  const double used = std::max(2.0, static_cast<double>(pieces));
  const MatrixXd clustered = inverse * (sums.transpose() * sums) * inverse * used / (used - 1.0);
  const double noise = missed.dot(weights.cwiseProduct(missed)) /
                       static_cast<double>(std::max<Index>(1, missed.size() - rank - 1));
  return clustered.diagonal().cwiseMax(noise * inverse.diagonal()).cwiseSqrt();
}

double least_misfit(const ShiftRows& rows, const Levels& levels, const Projection& projection,
                    double reach, const base::Cancel* cancel) {
  const double period = rows.stretches.front().period;
  const double count = std::min(48.0, std::ceil(2.0 * reach / std::min(0.5 * period, 5e-4)));
  double found = 0.0;
  double least = std::numeric_limits<double>::infinity();
  VectorXd level;
  VectorXd rest;
  for (int k = 0; k <= static_cast<int>(count); ++k) {
    if (cancel != nullptr) cancel->check();
    const double delay = k == static_cast<int>(count) ? reach : k * (2.0 * reach / count) - reach;
    levels.at(delay, level);
    projection.rest(level, rest);
    const double misfit = rest.squaredNorm() / std::max(level.squaredNorm(), kTiny);
    if (misfit < least) {
      found = delay;
      least = misfit;
    }
  }
  return found;
}

double median_size(const VectorXd& values) {
  const auto count = static_cast<std::size_t>(values.size());
  return base::quantile(count, count, 0.5, [&](std::size_t i, double& out) {
    out = std::fabs(values[static_cast<Index>(i)]);
    return true;
  });
}

}  // namespace

std::optional<FittedShift> fit_shift(const ShiftRows& rows, const ShiftSearch& search,
                                     const base::Cancel* cancel) {
  const Index count = rows.columns.rows();
  const Index width = rows.columns.cols();
  if (count < 3 * width + 20) return std::nullopt;
  const Levels levels(rows);
  const Rates rates(rows);
  std::optional<Projection> projection(std::in_place, rows.columns, nullptr);
  double delay =
      search.reach > 0.0 ? least_misfit(rows, levels, *projection, search.reach, cancel) : 0.0;
  const double bound = search.reach > 0.0 ? 2.0 * search.reach : kFarthest;
  const bool rubs = rows.conservative < width;
  const int rounds = search.robust ? kRounds : 1;
  VectorXd weights = VectorXd::Ones(count);
  VectorXd level;
  VectorXd rest;
  VectorXd fitted;
  VectorXd rate(count);
  VectorXd slope;
  VectorXd missed;
  VectorXd total;
  MatrixXd slopes(count, rubs ? 2 : 1);
  VectorXd unshifted;
  bool none = false;
  for (int turn = 0; turn < rounds; ++turn) {
    double step = 0.0;
    double energy = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      if (cancel != nullptr) cancel->check();
      levels.at(delay, level);
      const VectorXd found = projection->coefficients(level);
      if (turn == 0 && i == 0 && delay == 0.0) unshifted = found;
      rest = level;
      for (Index part = 0; part < slopes.cols(); ++part) {
        const Index first = part == 0 ? 0 : rows.conservative;
        const Index columns = part == 0 ? rows.conservative : width - rows.conservative;
        fitted =
            base::sum_of(rows.columns.middleCols(first, columns), found.segment(first, columns));
        rest -= fitted;
        rates.of(fitted, rate);
        projection->rest(rate, slope);
        slopes.col(part) = slope;
      }
      total = slopes.rowwise().sum();
      energy = total.dot(weights.cwiseProduct(total));
      if (!(energy > 0.0)) return std::nullopt;
      step = -total.dot(weights.cwiseProduct(rest)) / energy;
      step = std::clamp(step, -kLongestStep, kLongestStep);
      delay += step;
      if (std::fabs(delay) > bound) return std::nullopt;
      if (std::fabs(step) < kNear || std::fabs(delay) < kClearlyShorter * search.least) break;
    }
    missed = rest + step * total;
    const double noise = missed.squaredNorm() / static_cast<double>(count - projection->rank());
    none = std::fabs(delay) + kClearErrors * std::sqrt(noise / energy) < search.least;
    if (none) break;
    if (turn + 1 < rounds) {
      const double usual = kClipped * median_size(missed) + kTiny;
      weights = (missed.cwiseAbs() / usual).cwiseMax(1.0).cwiseInverse();
      projection.emplace(rows.columns, &weights);
    }
  }
  const auto groups = clusters_of(rows, levels.used());
  const double own = errors_of(total, missed, weights, groups, projection->rank())[0];
  FittedShift result{{delay, own}, {delay, own}, {delay, own}, 0.0, std::move(unshifted)};
  if (rubs && !none) {
    const MatrixXd inverse = inverse_of(slopes.transpose() * weights.asDiagonal() * slopes);
    const VectorXd apart = -inverse * (slopes.transpose() * weights.cwiseProduct(rest));
    const VectorXd errors =
        errors_of(slopes, rest + slopes * apart, weights, groups, projection->rank());
    result.conservative = {delay + apart[0], errors[0]};
    result.friction = {delay + apart[1], errors[1]};
  }
  const double mean = level.mean();
  result.unexplained =
      missed.squaredNorm() / std::max((level.array() - mean).square().sum(), kTiny);
  return result;
}

Eigen::VectorXd shift_coefficients(const ShiftRows& rows) {
  VectorXd level;
  Levels(rows).at(0.0, level);
  return Projection(rows.columns, nullptr).coefficients(level);
}

}  // namespace jointid::signals
