#include "identify/compressed/shape_table.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kTableLanes = ShapeTable::kLanes;

// Points in parallel, in the lanes of a vector, and functions with sums that stay in registers.
constexpr std::size_t kPoints = 8;
constexpr std::size_t kFunctions = 4;

/// Values of some series at kPoints points x (also slightly outside [-1, 1]). Coefficients are
/// stored by terms and values by points, `stride` apart.
JOINTID_CLONES void series_at(const double* coefficients, std::size_t functions, std::size_t stride,
                              std::size_t terms, const double* x, double* values) {
  std::array<std::array<double, kPoints>, kFunctions> sums{};
  std::array<double, kPoints> before{};
  std::array<double, kPoints> now{};
  for (std::size_t l = 0; l < kPoints; ++l) {
    before[l] = x[l];  // T_-1 = T_1
    now[l] = 1.0;
  }
  for (std::size_t k = 0; k < terms; ++k) {
    for (std::size_t f = 0; f < kFunctions; ++f) {
      const double c = f < functions ? coefficients[k * stride + f] : 0.0;
      for (std::size_t l = 0; l < kPoints; ++l) sums[f][l] += c * now[l];
    }
    for (std::size_t l = 0; l < kPoints; ++l) {
      const double next = 2.0 * x[l] * now[l] - before[l];
      before[l] = now[l];
      now[l] = next;
    }
  }
  for (std::size_t f = 0; f < functions; ++f) {
    for (std::size_t l = 0; l < kPoints; ++l) values[l * stride + f] = sums[f][l];
  }
}

/// Values at local Chebyshev points -> coefficients of powers of the local coordinate.
///
/// In two steps through the series, so that rounding errors stay small. One matrix for both steps
/// would have entries in the thousands that cancel.
class Powers {
 public:
  explicit Powers(Eigen::Index order)
      : series_(chebyshev_coefficients(Eigen::MatrixXd::Identity(order, order))),
        powers_(Eigen::MatrixXd::Zero(order, order)) {
    powers_(0, 0) = 1.0;  // T_k, one per row
    if (order > 1) powers_(1, 1) = 1.0;
    for (Eigen::Index k = 2; k < order; ++k) {
      powers_.row(k).tail(order - 1) = 2.0 * powers_.row(k - 1).head(order - 1);
      powers_.row(k) -= powers_.row(k - 2);
    }
  }
  [[nodiscard]] Eigen::MatrixXd of(const Eigen::MatrixXd& values) const {
    const Eigen::MatrixXd series = values * series_;
    return series * powers_;
  }

 private:
  Eigen::MatrixXd series_;
  Eigen::MatrixXd powers_;
};

/// Series through values over an axis's whole range (functions x Chebyshev points), evaluated at
/// all pieces' local points: functions x points.
Eigen::MatrixXd at_pieces(const ShapeAxis& axis, Eigen::Index order,
                          const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd coefficients = chebyshev_coefficients(values);
  const Eigen::VectorXd local = chebyshev_points(order);
  const Eigen::Index points = axis.pieces() * order;
  const auto lanes = static_cast<Eigen::Index>(kPoints);
  const Eigen::Index padded = (points + lanes - 1) / lanes * lanes;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(padded);
  for (Eigen::Index i = 0; i < points; ++i) {
    x[i] = axis.position(axis.shape_in(i / order, local[i % order]));
  }
  const auto functions = static_cast<std::size_t>(values.rows());
  Eigen::MatrixXd result(values.rows(), padded);
  for (Eigen::Index i = 0; i < padded; i += lanes) {
    for (std::size_t f = 0; f < functions; f += kFunctions) {
      series_at(coefficients.data() + f, std::min(kFunctions, functions - f), functions,
                static_cast<std::size_t>(values.cols()), x.data() + i, result.col(i).data() + f);
    }
  }
  result.conservativeResize(Eigen::NoChange, points);
  return result;
}

/// Horner's rule over `order` rows of lanes that are `stride` apart.
inline void horner(const double* rows, std::size_t order, std::size_t stride, double x,
                   double* result) {
  std::array<double, kTableLanes> sum;
  const double* row = rows + (order - 1) * stride;
  for (std::size_t l = 0; l < kTableLanes; ++l) sum[l] = row[l];
  for (std::size_t k = 1; k < order; ++k) {
    row -= stride;
    for (std::size_t l = 0; l < kTableLanes; ++l) sum[l] = sum[l] * x + row[l];
  }
  for (std::size_t l = 0; l < kTableLanes; ++l) result[l] = sum[l];
}

/// The same for the derivative.
inline void horner_slope(const double* rows, std::size_t order, std::size_t stride, double x,
                         double* result) {
  std::array<double, kTableLanes> sum{};
  for (std::size_t k = order - 1; k >= 1; --k) {
    const double* row = rows + k * stride;
    for (std::size_t l = 0; l < kTableLanes; ++l)
      sum[l] = sum[l] * x + static_cast<double>(k) * row[l];
  }
  for (std::size_t l = 0; l < kTableLanes; ++l) result[l] = sum[l];
}

}  // namespace

Eigen::VectorXd chebyshev_points(Eigen::Index count) {
  Eigen::VectorXd points(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    points[k] =
        base::cos(std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
  }
  return points;
}

Eigen::MatrixXd chebyshev_coefficients(const Eigen::MatrixXd& values) {
  const Eigen::Index count = values.cols();
  // cos(pi j (k + 1/2) / count) repeats, so one table of its values suffices.
  Eigen::VectorXd cosine(4 * count);
  for (Eigen::Index i = 0; i < 4 * count; ++i) {
    cosine[i] =
        base::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(2 * count));
  }
  Eigen::MatrixXd transform(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const double scale = (j == 0 ? 1.0 : 2.0) / static_cast<double>(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      transform(k, j) = scale * cosine[(j * (2 * k + 1)) % (4 * count)];
    }
  }
  return values * transform;
}

ShapeTable::ShapeTable(const ShapeAxis& axis, const Eigen::MatrixXd& values, int degree)
    : axis_(axis),
      functions_(values.rows()),
      width_((static_cast<std::size_t>(functions_) + kTableLanes - 1) / kTableLanes * kTableLanes),
      order_(static_cast<std::size_t>(degree) + 1) {
  const auto order = static_cast<Eigen::Index>(order_);
  const auto pieces = static_cast<Eigen::Index>(axis_.pieces());
  const Eigen::MatrixXd points = at_pieces(axis_, order, values);
  // All pieces at once, one row per function of each piece: (piece, function) x local point.
  Eigen::MatrixXd local(pieces * functions_, order);
  for (Eigen::Index piece = 0; piece < pieces; ++piece) {
    local.middleRows(piece * functions_, functions_) = points.middleCols(piece * order, order);
  }
  const Eigen::MatrixXd powers = Powers(order).of(local);
  rows_.assign(static_cast<std::size_t>(pieces) * order_ * width_, 0.0);
  for (Eigen::Index piece = 0; piece < pieces; ++piece) {
    Eigen::Map<Eigen::MatrixXd> target(
        rows_.data() + static_cast<std::size_t>(piece) * order_ * width_,
        static_cast<Eigen::Index>(width_), order);
    target.topRows(functions_) = powers.middleRows(piece * functions_, functions_);
  }
}

void ShapeTable::values(double shape, double* result) const {
  const auto place = axis_.place(shape);
  const double* rows = row(place.piece);
  for (std::size_t f = 0; f < width_; f += kTableLanes) {
    horner(rows + f, order_, width_, place.local, result + f);
  }
}

void ShapeTable::slopes(double shape, double* result) const {
  const auto place = axis_.place(shape);
  const double* rows = row(place.piece);
  for (std::size_t f = 0; f < width_; f += kTableLanes) {
    horner_slope(rows + f, order_, width_, place.local, result + f);
  }
  const double slope = axis_.slope(place.piece);
  for (std::size_t f = 0; f < width_; ++f) result[f] *= slope;
}

}  // namespace jointid::identify
