#include "signals/shift_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/clones.hpp"
#include "base/decompositions.hpp"
#include "base/gram.hpp"
#include "base/quantile.hpp"

namespace jointid::signals {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLastStep = 1e-5;     // [s], the last step of the iteration
constexpr double kLongestStep = 1e-3;  // [s]
constexpr int kSteps = 6;
constexpr int kRounds = 2;  // updates of the weights
constexpr double kOutlying =
    4.0;  // medians of the residual's size: larger residuals have less weight
constexpr double kCluster = 0.3;    // [s] of motion that counts as one observation
constexpr double kFarthest = 0.02;  // [s], longest delay of a search that starts without a shift
constexpr double kClearlyShorter = 0.5;
constexpr double kClearErrors = 6.0;
constexpr double kSingular = 1e-11;  // of the largest eigenvalue of the scaled normal equations
constexpr double kTiny = 1e-300;

double period_of(const ShiftedStretch& stretch) {
  const Signal& time = stretch.time;
  return (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
}

/// The window means of a signal at any shift: the smoothed signal, interpolated by a cubic.
class Levels {
 public:
  explicit Levels(const ShiftRows& rows) : rows_(rows) {
    for (const auto& each : rows.stretches) {
      smooth_.push_back(smoothed(each.signal, each.windows.weight));
    }
  }

  void at(double delay, VectorXd& level) const {
    level.resize(rows_.columns.rows());
    double* to = level.data();
    for (std::size_t i = 0; i < smooth_.size(); ++i) {
      const VectorXd& smooth = smooth_[i];
      const Middles& used = rows_.stretches[i].windows.used;
      if (used.empty()) continue;
      const double moved = delay / period_of(rows_.stretches[i]) - (rows_.held ? 0.5 : 0.0);
      const double floor = std::floor(moved);
      const auto whole = static_cast<std::int64_t>(floor);
      const double p = moved - floor;
      const double a = -p * (p - 1.0) * (p - 2.0) / 6.0;
      const double b = (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0;
      const double c = (p + 1.0) * p * (p - 2.0) / 2.0;
      const double d = (p + 1.0) * p * (p - 1.0) / 6.0;
      const auto between = [&](const double* y) {
        return a * y[-1] + b * y[0] - c * y[1] + d * y[2];
      };
      const std::int64_t last = smooth.size() - 3;
      if (used.front() + whole >= 1 && used.back() + whole <= last) {
        for (const auto middle : used) *to++ = between(smooth.data() + middle + whole);
      } else {
        for (const auto middle : used) {
          *to++ = between(smooth.data() + std::clamp<std::int64_t>(middle + whole, 1, last));
        }
      }
    }
  }

 private:
  const ShiftRows& rows_;
  std::vector<VectorXd> smooth_;
};

/// Weighted least squares on the columns, by scaled normal equations.
class Projection {
 public:
  explicit Projection(const Eigen::Ref<const MatrixXd>& columns)
      : columns_(columns), gram_(base::symmetric_products(columns, columns)) {
    decompose(gram_);
  }

  /// Rows have weights of at most 1. The missing weight is subtracted from the normal equations.
  void weigh(const VectorXd& weights) {
    weights_ = &weights;
    std::vector<Index> less;
    for (Index row = 0; row < weights.size(); ++row) {
      if (weights[row] < 1.0) less.push_back(row);
    }
    const auto count = static_cast<Index>(less.size());
    if (count == 0) return;
    MatrixXd rows(count, columns_.cols());
    VectorXd lacking(count);
    for (Index i = 0; i < count; ++i) {
      lacking[i] = std::sqrt(1.0 - weights[less[static_cast<std::size_t>(i)]]);
    }
    for (Index j = 0; j < rows.cols(); ++j) {
      const double* column = columns_.col(j).data();
      double* to = rows.col(j).data();
      for (Index i = 0; i < count; ++i) {
        to[i] = lacking[i] * column[less[static_cast<std::size_t>(i)]];
      }
    }
    decompose(gram_ - base::symmetric_products(rows, rows));
  }

  [[nodiscard]] Index rank() const { return basis_.cols(); }
  [[nodiscard]] VectorXd coefficients(const Eigen::Ref<const VectorXd>& signal) const {
    const VectorXd matched = weights_ == nullptr
                                 ? base::products(columns_, signal)
                                 : base::products(columns_, signal.cwiseProduct(*weights_));
    const VectorXd inner = basis_.transpose() * matched;
    return basis_ * inner;
  }
  /// Leaves the part of a signal that the columns cannot explain.
  void take_from(Eigen::Ref<VectorXd> signal) const {
    base::subtract_sum(columns_, coefficients(signal), signal);
  }

 private:
  void decompose(const MatrixXd& gram) {
    VectorXd scale = gram.diagonal().cwiseMax(0.0).cwiseSqrt();
    scale = (scale.array() > 0.0).select(scale, std::numeric_limits<double>::infinity());
    const VectorXd inverse = scale.cwiseInverse();
    const MatrixXd scaled = inverse.asDiagonal() * gram * inverse.asDiagonal();
    if (const auto factor = base::cholesky(scaled)) {
      // The trace of the inverse bounds its largest eigenvalue; the width bounds the largest
      // eigenvalue of the equations.
      const auto width = static_cast<double>(gram.rows());
      basis_ = base::solve_upper(factor->transpose(), MatrixXd::Identity(gram.rows(), gram.rows()));
      if (basis_.squaredNorm() * kSingular * width < 1.0) {
        basis_ = inverse.asDiagonal() * basis_;
        return;
      }
    }
    const auto [values, vectors] = base::eigenpairs(scaled);
    const double least = kSingular * values[values.size() - 1];
    Index first = 0;
    while (first < values.size() && !(values[first] > least)) ++first;
    const Index rank = values.size() - first;
    basis_ = inverse.asDiagonal() * vectors.rightCols(rank) *
             values.tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
  }

  const Eigen::Ref<const MatrixXd>& columns_;
  const VectorXd* weights_ = nullptr;
  MatrixXd gram_;  ///< without weights
  MatrixXd basis_;
};

JOINTID_CLONES void take_rates(const double* level, const double* between, std::size_t count,
                               double* rate) {
  for (std::size_t i = 1; i + 1 < count; ++i) rate[i] = (level[i + 1] - level[i - 1]) * between[i];
}

/// Rates of a fitted signal, from neighbouring windows; zero next to an omitted window.
class Rates {
 public:
  explicit Rates(const ShiftRows& rows) : between_(rows.columns.rows()) {
    Index row = 0;
    for (const auto& each : rows.stretches) {
      const VectorXd& own = each.windows.between;
      between_.segment(row, own.size()) = own;
      row += own.size();
    }
  }

  void of(const VectorXd& level, Eigen::Ref<VectorXd> rate) const {
    const auto count = static_cast<std::size_t>(level.size());
    take_rates(level.data(), between_.data(), count, rate.data());
    rate[0] = 0.0;  // the first and the last row lack a neighbour
    rate[level.size() - 1] = 0.0;
  }

 private:
  VectorXd between_;  ///< 1 over the time between the two neighbours; 0 where one is omitted
};

/// Ends (one past the last row) of each piece of the motion that counts as one observation.
std::vector<Index> pieces_of(const ShiftRows& rows) {
  std::vector<Index> ends;
  Index row = 0;
  for (const auto& each : rows.stretches) {
    const double start = each.time[0];
    const double length = std::min(kCluster, (each.time[each.time.size() - 1] - start) / 20.0);
    std::int64_t piece = -1;
    for (const auto middle : each.windows.used) {
      const auto own = static_cast<std::int64_t>((each.time[middle] - start) / length);
      if (own != piece) ends.push_back(row);
      piece = own;
      ++row;
    }
  }
  if (!ends.empty()) ends.erase(ends.begin());
  ends.push_back(row);
  return ends;
}

/// Inverse for one or two unknowns; a singular pair by its eigenvectors.
MatrixXd inverse_of(const MatrixXd& gram) {
  if (gram.size() == 1) return gram.cwiseInverse();
  const auto [values, vectors] = base::eigenpairs(gram);
  const double least = 1e-15 * values.cwiseAbs().maxCoeff();
  const VectorXd inverse = (values.array().abs() > least).select(values.cwiseInverse(), 0.0);
  return vectors * inverse.asDiagonal() * vectors.transpose();
}

/// Standard errors: the larger of the classical ones and those clustered over pieces of the motion.
/// `weighted` has the slopes times the weights.
VectorXd errors_of(const Eigen::Ref<const MatrixXd>& slopes,
                   const Eigen::Ref<const MatrixXd>& weighted, const VectorXd& missed,
                   const VectorXd& weights, const std::vector<Index>& pieces, Index rank) {
  const Index width = slopes.cols();
  const MatrixXd inverse = inverse_of(base::symmetric_products(slopes, weighted));
  MatrixXd sums(static_cast<Index>(pieces.size()), width);
  for (Index part = 0; part < width; ++part) {
    const VectorXd scores = weighted.col(part).cwiseProduct(missed);
    Index first = 0;
    Index piece = 0;
    for (const Index end : pieces) {
      sums(piece++, part) = scores.segment(first, end - first).sum();
      first = end;
    }
  }
  const double used = std::max(2.0, static_cast<double>(pieces.size()));
  const MatrixXd clustered = inverse * (sums.transpose() * sums) * inverse * used / (used - 1.0);
  const double noise = missed.dot(weights.cwiseProduct(missed)) /
                       static_cast<double>(std::max<Index>(1, missed.size() - rank - 1));
  return clustered.diagonal().cwiseMax(noise * inverse.diagonal()).cwiseSqrt();
}

double least_misfit(const ShiftRows& rows, const Levels& levels, const Projection& projection,
                    double reach, const base::Cancel* cancel) {
  const double period = period_of(rows.stretches.front());
  const double count = std::min(48.0, std::ceil(2.0 * reach / std::min(0.5 * period, 5e-4)));
  double found = 0.0;
  double least = std::numeric_limits<double>::infinity();
  VectorXd level;
  VectorXd rest;
  for (int k = 0; k <= static_cast<int>(count); ++k) {
    if (cancel != nullptr) cancel->check();
    const double delay = k == static_cast<int>(count) ? reach : k * (2.0 * reach / count) - reach;
    levels.at(delay, level);
    rest = level;
    projection.take_from(rest);
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
  Projection projection(rows.columns);
  double delay =
      search.reach > 0.0 ? least_misfit(rows, levels, projection, search.reach, cancel) : 0.0;
  const double bound = search.reach > 0.0 ? 2.0 * search.reach : kFarthest;
  const bool rubs = rows.conservative < width;
  const int rounds = search.robust ? kRounds : 1;
  VectorXd weights = VectorXd::Ones(count);
  VectorXd level;
  VectorXd rest;
  VectorXd fitted;
  VectorXd missed;
  VectorXd total;
  VectorXd heavy;  // the total slope times the weights
  MatrixXd slopes(count, rubs ? 2 : 1);
  std::optional<double> leading;
  bool none = false;
  for (int turn = 0; turn < rounds; ++turn) {
    double step = 0.0;
    double energy = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      if (cancel != nullptr) cancel->check();
      levels.at(delay, level);
      const VectorXd found = projection.coefficients(level);
      if (turn == 0 && i == 0 && delay == 0.0) leading = found[0];
      rest = level;
      for (Index part = 0; part < slopes.cols(); ++part) {
        const Index first = part == 0 ? 0 : rows.conservative;
        const Index columns = part == 0 ? rows.conservative : width - rows.conservative;
        fitted =
            base::sum_of(rows.columns.middleCols(first, columns), found.segment(first, columns));
        rest -= fitted;
        rates.of(fitted, slopes.col(part));
        projection.take_from(slopes.col(part));
      }
      total = slopes.col(0);
      if (rubs) total += slopes.col(1);
      heavy = weights.cwiseProduct(total);
      energy = total.dot(heavy);
      if (!(energy > 0.0)) return std::nullopt;
      step = std::clamp(-heavy.dot(rest) / energy, -kLongestStep, kLongestStep);
      delay += step;
      if (std::fabs(delay) > bound) return std::nullopt;
      if (std::fabs(step) < kLastStep || std::fabs(delay) < kClearlyShorter * search.least) break;
    }
    missed = rest + step * total;
    const double noise = missed.squaredNorm() / static_cast<double>(count - projection.rank());
    none = std::fabs(delay) + kClearErrors * std::sqrt(noise / energy) < search.least;
    if (none) break;
    if (turn + 1 < rounds) {
      const double usual = kOutlying * median_size(missed) + kTiny;
      weights = (missed.cwiseAbs() / usual).cwiseMax(1.0).cwiseInverse();
      projection.weigh(weights);
    }
  }
  const double unexplained = missed.squaredNorm();
  const auto pieces = pieces_of(rows);
  const double own = errors_of(total, heavy, missed, weights, pieces, projection.rank())[0];
  FittedShift result{{delay, own}, {delay, own}, {delay, own}, 0.0, leading};
  if (rubs && !none) {
    const MatrixXd weighted = weights.asDiagonal() * slopes;
    const MatrixXd inverse = inverse_of(base::symmetric_products(slopes, weighted));
    const VectorXd apart = -inverse * base::products(weighted, rest);
    missed = rest + slopes * apart;
    const VectorXd errors = errors_of(slopes, weighted, missed, weights, pieces, projection.rank());
    result.conservative = {delay + apart[0], errors[0]};
    result.friction = {delay + apart[1], errors[1]};
  }
  const double mean = level.mean();
  result.unexplained = unexplained / std::max((level.array() - mean).square().sum(), kTiny);
  return result;
}

double leading_coefficient(const ShiftRows& rows) {
  VectorXd level;
  Levels(rows).at(0.0, level);
  return Projection(rows.columns).coefficients(level)[0];
}

}  // namespace jointid::signals
