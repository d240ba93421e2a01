#include "identify/separable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "search/least_squares.hpp"

namespace jointid::identify {

namespace {

constexpr int kScan = 64;  // points over the shape's domain
constexpr double kGolden = 0.6180339887498949;

/// Coefficients split into fixed (moved to the target) and free.
struct Reduced {
  Eigen::MatrixXd columns;
  Eigen::VectorXd target;
  std::vector<Eigen::Index>
      free;  ///< coefficients, without the gain when that is eliminated with the rest
};

Reduced reduce(const Penalty& penalty, const Eigen::MatrixXd& columns, const search::Domain& domain,
               bool keep_gain) {
  Reduced result;
  result.target = penalty.target();
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    if (!keep_gain && j == penalty.gain_index()) continue;
    if (domain.lower[j] == domain.upper[j]) {
      result.target.noalias() -= domain.lower[j] * columns.col(j);
    } else {
      result.free.push_back(j);
    }
  }
  result.columns.resize(columns.rows(), static_cast<Eigen::Index>(result.free.size()));
  for (std::size_t i = 0; i < result.free.size(); ++i) {
    result.columns.col(static_cast<Eigen::Index>(i)) = columns.col(result.free[i]);
  }
  return result;
}

Eigen::VectorXd solve_box(const Reduced& r, const search::Domain& domain,
                          Eigen::VectorXd coefficients) {
  const auto n = static_cast<Eigen::Index>(r.free.size());
  if (n == 0) return coefficients;
  Eigen::MatrixXd g(2 * n, n);
  g << Eigen::MatrixXd::Identity(n, n), -Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd h(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    h[i] = domain.lower[r.free[static_cast<std::size_t>(i)]];
    h[n + i] = -domain.upper[r.free[static_cast<std::size_t>(i)]];
  }
  const auto solution = search::constrained_least_squares(r.columns, r.target, g, h);
  for (Eigen::Index i = 0; i < n; ++i)
    coefficients[r.free[static_cast<std::size_t>(i)]] = solution.x[i];
  return coefficients;
}

/// Free gain, residual in the sensor's terms: min |target u - columns g - sensor|, u = 1/gain, g =
/// c u.
Eigen::VectorXd solve_ratio(const Penalty& penalty, const Reduced& r, const Eigen::VectorXd& sensor,
                            const search::Domain& domain, Eigen::VectorXd coefficients) {
  const Eigen::Index gain = penalty.gain_index();
  const auto n = static_cast<Eigen::Index>(r.free.size());
  const double low = domain.lower[gain];
  const double high = domain.upper[gain];
  if (low <= 0.0 && high >= 0.0) {
    throw std::invalid_argument(
        "sensor_gain: its bounds must not contain 0 with residual 'sensor', got " +
        std::to_string(low) + " to " + std::to_string(high));
  }
  const double sign = low > 0.0 ? 1.0 : -1.0;
  Eigen::MatrixXd a(r.target.size(), n + 1);
  a.leftCols(n) = -r.columns;
  a.col(n) = r.target;
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(2 * n + 2, n + 1);
  Eigen::VectorXd h = Eigen::VectorXd::Zero(2 * n + 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto c = r.free[static_cast<std::size_t>(i)];
    g(i, i) = sign;
    g(i, n) = -sign * domain.lower[c];
    g(n + i, i) = -sign;
    g(n + i, n) = sign * domain.upper[c];
  }
  g(2 * n, n) = 1.0;  // 1/high <= u <= 1/low, also for negative gains
  h[2 * n] = 1.0 / high;
  g(2 * n + 1, n) = -1.0;
  h[2 * n + 1] = -1.0 / low;
  const auto solution = search::constrained_least_squares(a, sensor, g, h);
  const double u = solution.x[n];
  coefficients[gain] = 1.0 / u;
  for (Eigen::Index i = 0; i < n; ++i)
    coefficients[r.free[static_cast<std::size_t>(i)]] = solution.x[i] / u;
  return coefficients;
}

}  // namespace

Eigen::VectorXd best_coefficients(const Penalty& penalty, const Eigen::VectorXd& shapes,
                                  const search::Domain& domain, const base::Cancel* cancel) {
  Eigen::MatrixXd columns;
  penalty.columns(shapes, columns, cancel);
  const Eigen::Index p = penalty.coefficients();
  const Eigen::Index gain = penalty.gain_index();
  Eigen::VectorXd start = domain.lower.head(p);
  const bool ratio =
      penalty.residual() == Residual::sensor && domain.lower[gain] < domain.upper[gain];
  Eigen::VectorXd best;
  if (ratio) {
    best = solve_ratio(penalty, reduce(penalty, columns, domain, false), columns.col(gain), domain,
                       start);
  } else {
    best = solve_box(reduce(penalty, columns, domain, true), domain, start);
  }
  // Rounding may leave a bound by an ulp.
  return best.cwiseMax(domain.lower.head(p)).cwiseMin(domain.upper.head(p));
}

SeparableResult minimise_separable(const Penalty& penalty, const search::Domain& domain,
                                   base::Pool& pool) {
  domain.validate();
  if (domain.size() != penalty.parameters()) {
    throw std::invalid_argument("domain must have " + std::to_string(penalty.parameters()) +
                                " parameters, got " + std::to_string(domain.size()));
  }
  const Eigen::Index p = penalty.coefficients();
  const Eigen::Index shape_count = penalty.parameters() - p;
  std::vector<Eigen::Index> free_shapes;
  for (Eigen::Index i = 0; i < shape_count; ++i) {
    if (domain.lower[p + i] < domain.upper[p + i]) free_shapes.push_back(i);
  }
  if (free_shapes.size() > 1)
    throw std::invalid_argument("the separable search takes one free shape parameter");

  SeparableResult result;
  const auto full = [&](double shape) {
    Eigen::VectorXd theta(penalty.parameters());
    theta.tail(shape_count) = domain.lower.tail(shape_count);
    if (!free_shapes.empty()) theta[p + free_shapes[0]] = shape;
    theta.head(p) = best_coefficients(penalty, theta.tail(shape_count), domain, &pool.cancel());
    return theta;
  };
  if (free_shapes.empty()) {
    result.best = full(0.0);
    result.penalty = penalty(result.best);
    result.evaluations = 1;
    return result;
  }

  // A square-root scale: the decay is felt through s v^2, so equal steps in 1/v_s at small s matter
  // most.
  const double low = std::sqrt(std::max(0.0, domain.lower[p + free_shapes[0]]));
  const double high = std::sqrt(std::max(0.0, domain.upper[p + free_shapes[0]]));
  const auto at = [&](double root) {
    return std::clamp(root * root, domain.lower[p + free_shapes[0]],
                      domain.upper[p + free_shapes[0]]);
  };
  std::vector<double> values(kScan + 1);
  pool.for_each(values.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::VectorXd theta = full(at(low + (high - low) * static_cast<double>(i) / kScan));
      values[i] = penalty(theta, &pool.cancel());
    }
  });
  result.evaluations = kScan + 1;
  const auto best =
      static_cast<double>(std::min_element(values.begin(), values.end()) - values.begin());
  double left = low + (high - low) * std::max(0.0, best - 1.0) / kScan;
  double right = low + (high - low) * std::min<double>(kScan, best + 1.0) / kScan;
  const auto value = [&](double root) {
    pool.poll();
    ++result.evaluations;
    return penalty(full(at(root)));
  };
  double a = right - kGolden * (right - left);
  double b = left + kGolden * (right - left);
  double at_a = value(a);
  double at_b = value(b);
  while (right - left > 1e-9 * (high - low)) {
    if (at_a <= at_b) {
      right = b;
      b = a;
      at_b = at_a;
      a = right - kGolden * (right - left);
      at_a = value(a);
    } else {
      left = a;
      a = b;
      at_a = at_b;
      b = left + kGolden * (right - left);
      at_b = value(b);
    }
  }
  result.best = full(at(at_a <= at_b ? a : b));
  result.penalty = penalty(result.best);
  // Golden sections never touch an end of the domain, and a root squared may miss it by an ulp.
  const double lowest = domain.lower[p + free_shapes[0]];
  const double highest = domain.upper[p + free_shapes[0]];
  for (const double edge : {std::clamp(0.0, lowest, highest), highest}) {
    const Eigen::VectorXd theta = full(edge);
    const double p_edge = penalty(theta);
    if (p_edge <= result.penalty) {
      result.best = theta;
      result.penalty = p_edge;
    }
  }
  return result;
}

}  // namespace jointid::identify
