#include "identify/compressed/general_table.hpp"

#include <algorithm>
#include <cmath>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/gram.hpp"
#include "identify/compressed/shape_table.hpp"
#include "model/friction.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kSumLanes = 8;
constexpr std::size_t kMostPoints = 2048;
constexpr std::size_t kMostRows = 1024;        // of all shaped columns together
constexpr Eigen::Index kMostRemainders = 128;  // remainders
constexpr double kNothing = 3e-16;             // of the largest column, squared: rounding
// Shapes among which the remainders are found: some, and more for a large domain.
constexpr int kSpread = 80;
constexpr double kSpreadDensity = 12.0;
constexpr double kLargest = 100.0;
constexpr double kNegligible = 1e-30;  // decay or slope: nothing beside the sums' rounding
constexpr std::size_t kTogether = 4;   // points between two looks at the sums

JOINTID_CLONES void decays(const double* points, std::size_t count, double velocity,
                           double exponent, double origin, double* value) {
  for (std::size_t k = 0; k < count; ++k) {
    value[k] = model::general_decay(points[k] - origin, velocity, exponent).value;
  }
}

JOINTID_CLONES void decay_slopes(const double* points, std::size_t count, double velocity,
                                 double exponent, double origin, double* by_velocity,
                                 double* by_exponent) {
  for (std::size_t k = 0; k < count; ++k) {
    const auto decay = model::general_decay(points[k] - origin, velocity, exponent);
    by_velocity[k] = decay.by_velocity;
    by_exponent[k] = decay.by_exponent;
  }
}

/// sum[r] = sum over k of factor[k] matrix[k * rows + r], in that order.
JOINTID_CLONES void weighted_rows(const double* factor, std::size_t count, const double* matrix,
                                  std::size_t rows, double* sum) {
  for (std::size_t r = 0; r < rows; ++r) sum[r] = 0.0;
  std::size_t k = 0;
  for (; k + kTogether <= count; k += kTogether) {
    const double* row = matrix + k * rows;
    const double* f = factor + k;
    for (std::size_t r = 0; r < rows; ++r) {
      double s = sum[r] + f[0] * row[r];
      s = s + f[1] * row[rows + r];
      s = s + f[2] * row[2 * rows + r];
      sum[r] = s + f[3] * row[3 * rows + r];
    }
  }
  for (; k < count; ++k) {
    for (std::size_t r = 0; r < rows; ++r) sum[r] += factor[k] * matrix[k * rows + r];
  }
}

/// Calls with each piece's first moment, their number, and the matrix from values at the points
/// (a row each) to coefficients.
template <class Work>
void each_piece(const SpeedPieces& pieces, Work work) {
  Eigen::MatrixXd series;
  for (std::size_t p = 0; p < pieces.pieces(); ++p) {
    const auto first = static_cast<Eigen::Index>(pieces.first[p]);
    const auto size = static_cast<Eigen::Index>(pieces.first[p + 1]) - first;
    if (series.rows() != size) {
      series = chebyshev_coefficients(Eigen::MatrixXd::Identity(size, size));
    }
    work(first, size, series);
  }
}

/// The share of a number's digits behind the point, mirrored (van der Corput).
double mirrored(int number, int base) {
  double result = 0.0;
  double digit = 1.0;
  for (; number > 0; number /= base) {
    digit /= base;
    result += digit * (number % base);
  }
  return result;
}

/// Shapes spread evenly over the logarithms of a domain (Halton), its corners first.
Probes spread(const std::array<double, 2>& lower, const std::array<double, 2>& upper) {
  const auto at = [&](double velocity, double exponent) {
    const std::array<double, 2> share{velocity, exponent};
    std::array<double, 2> shape{};
    for (std::size_t i = 0; i < 2; ++i) {
      shape[i] = lower[i] * base::exp(share[i] * base::log(upper[i] / lower[i]));
    }
    return shape;
  };
  Probes result{at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0), at(1.0, 1.0)};
  const double length = base::log(upper[0] / lower[0]);
  const double height = base::log(upper[1] / lower[1]);
  const int count =
      kSpread + static_cast<int>(kSpreadDensity * std::min(length * height, kLargest));
  for (int i = 1; i <= count; ++i) {  // every other one among high exponents, which differ most
    const double share = mirrored(i, 3);
    result.push_back(at(mirrored(i, 2), i % 2 == 0 ? share : std::sqrt(share)));
  }
  return result;
}

}  // namespace

GeneralTable::GeneralTable(const GeneralRange& range, const SpeedPieces& pieces,
                           const SpeedMoments& moments, std::size_t shaped)
    : lower_{range.velocity_low, range.exponent_low},
      upper_{range.velocity_high, range.exponent_high},
      shaped_(shaped),
      rows_(static_cast<std::size_t>(moments.projections.rows())),
      pieces_(pieces),
      points_(pieces.points()) {
  const Eigen::MatrixXd rest = remainders(moments.products);
  rank_ = static_cast<std::size_t>(rest.rows());
  padded_ = (rows_ + rank_ + kSumLanes - 1) / kSumLanes * kSumLanes;
  matrix_.assign(shaped_ * points_.size() * padded_, 0.0);
  const auto count = static_cast<Eigen::Index>(points_.size());
  Eigen::MatrixXd both(moments.projections.rows() + rest.rows(), rest.cols());
  both << moments.projections, rest;
  for (std::size_t j = 0; j < shaped_; ++j) {
    Eigen::Map<Eigen::MatrixXd> target(matrix_.data() + j * points_.size() * padded_,
                                       static_cast<Eigen::Index>(padded_), count);
    const auto own = both.middleCols(static_cast<Eigen::Index>(j) * count, count);
    target.col(0).head(both.rows()) = own.col(0);
    each_piece(pieces_, [&](Eigen::Index first, Eigen::Index size, const Eigen::MatrixXd& series) {
      target.middleCols(first, size).topRows(both.rows()).noalias() =
          own.middleCols(first, size) * series.transpose();
    });
  }
}

Eigen::MatrixXd GeneralTable::decays_of(const Probes& shapes) const {
  const auto count = static_cast<Eigen::Index>(points_.size());
  Eigen::MatrixXd values(count, static_cast<Eigen::Index>(shapes.size()));
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    decays(points_.data(), points_.size(), shapes[i][0], shapes[i][1], base::log(shapes[i][0]),
           values.col(static_cast<Eigen::Index>(i)).data());
  }
  Eigen::MatrixXd result(values.rows(), values.cols());
  result.row(0) = values.row(0);
  each_piece(pieces_, [&](Eigen::Index first, Eigen::Index size, const Eigen::MatrixXd& series) {
    result.middleRows(first, size).noalias() = series.transpose() * values.middleRows(first, size);
  });
  return result;
}

Eigen::MatrixXd GeneralTable::remainders(const Eigen::MatrixXd& products) const {
  // Pivoted Cholesky decomposition among the columns of many shapes: each step takes the shape that
  // is worst served by those taken before.
  const Eigen::MatrixXd shapes = decays_of(spread(lower_, upper_));
  const Eigen::Index moments = shapes.rows();
  const auto shaped = static_cast<Eigen::Index>(shaped_);
  std::vector<Eigen::MatrixXd> images;          // of all shapes, as a column of one term or another
  Eigen::MatrixXd left(shapes.cols(), shaped);  // what is not yet served, squared
  for (Eigen::Index j = 0; j < shaped; ++j) {
    images.push_back(base::product(products.middleCols(j * moments, moments), shapes));
    const auto own = images.back().middleRows(j * moments, moments);
    left.col(j) = own.cwiseProduct(shapes).colwise().sum().transpose();
  }
  const double scale = left.maxCoeff();
  Eigen::MatrixXd taken(shaped * moments, kMostRemainders);
  Eigen::Index rank = 0;
  while (rank < kMostRemainders) {
    Eigen::Index worst = 0;
    Eigen::Index where = 0;
    const double largest = left.maxCoeff(&worst, &where);
    if (!(largest > kNothing * scale)) break;
    const auto pivot = shapes.col(worst);
    const auto own = taken.middleRows(where * moments, moments).leftCols(rank);
    Eigen::VectorXd column = images[static_cast<std::size_t>(where)].col(worst);
    column.noalias() -= taken.leftCols(rank) * (own.transpose() * pivot);
    const double size = column.segment(where * moments, moments).dot(pivot);
    left(worst, where) = 0.0;
    if (!(size > kNothing * scale)) continue;
    auto next = taken.col(rank++);
    next = column / std::sqrt(size);
    for (Eigen::Index j = 0; j < shaped; ++j) {
      left.col(j) -= (shapes.transpose() * next.segment(j * moments, moments)).cwiseAbs2();
    }
    left(worst, where) = 0.0;
  }
  return taken.leftCols(rank).transpose();
}

void GeneralTable::combine(const double* decay, double* result) const {
  const std::size_t all = points_.size();
  std::size_t count = all;  // fast samples come last, and most decays have vanished there
  while (count > 0 && std::fabs(decay[count - 1]) < kNegligible) --count;
  for (std::size_t j = 0; j < shaped_; ++j) {
    weighted_rows(decay, count, matrix_.data() + j * all * padded_, padded_, result + j * padded_);
  }
}

void GeneralTable::values(const double* shapes, double* result) const {
  std::array<double, kMostPoints> decay;
  std::array<double, kMostRows> sums;
  decays(points_.data(), points_.size(), shapes[0], shapes[1], base::log(shapes[0]), decay.data());
  combine(decay.data(), sums.data());
  for (std::size_t j = 0; j < shaped_; ++j) {
    result = std::copy_n(sums.data() + j * padded_, rows_, result);
  }
  for (std::size_t j = 0; j < shaped_; ++j) {
    for (std::size_t i = 0; i <= j; ++i) {
      double product = 0.0;
      for (std::size_t r = rows_; r < rows_ + rank_; ++r) {
        product += sums[i * padded_ + r] * sums[j * padded_ + r];
      }
      *result++ = product;
    }
  }
}

Eigen::MatrixXd GeneralTable::combined(const double* decay) const {
  std::array<double, kMostRows> sums;
  combine(decay, sums.data());
  const Eigen::Map<const Eigen::MatrixXd> all(sums.data(), static_cast<Eigen::Index>(padded_),
                                              static_cast<Eigen::Index>(shaped_));
  return all.topRows(rows());
}

Eigen::MatrixXd GeneralTable::columns(const double* shapes) const {
  std::array<double, kMostPoints> decay;
  decays(points_.data(), points_.size(), shapes[0], shapes[1], base::log(shapes[0]), decay.data());
  return combined(decay.data());
}

Eigen::MatrixXd GeneralTable::slopes(const double* shapes, int which) const {
  std::array<double, kMostPoints> by_velocity;
  std::array<double, kMostPoints> by_exponent;
  decay_slopes(points_.data(), points_.size(), shapes[0], shapes[1], base::log(shapes[0]),
               by_velocity.data(), by_exponent.data());
  return combined(which == 0 ? by_velocity.data() : by_exponent.data());
}

}  // namespace jointid::identify
