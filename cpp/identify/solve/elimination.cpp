#include "identify/solve/elimination.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "search/least_squares.hpp"

namespace jointid::identify {

namespace {

constexpr int kPasses =
    2;  // iterations for a balance that is not linear, each about the previous result

/// Coefficients split into fixed ones (moved to the target) and free ones.
struct Reduced {
  Eigen::MatrixXd columns;
  Eigen::VectorXd target;
  std::vector<Eigen::Index>
      free;  ///< coefficients, without the gain if that is eliminated with the others
};

Reduced reduce(const Balance& balance, const search::Domain& domain, bool keep_gain) {
  const Eigen::MatrixXd& columns = balance.columns;
  Reduced result;
  result.target = balance.target;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    if (!keep_gain && j == balance.gain) continue;
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

/// Free gain, residual in the units of the sensor: min |target u - columns g - sensor|, u = 1/gain,
/// g = c u.
Eigen::VectorXd solve_ratio(const Balance& balance, const Reduced& r, const search::Domain& domain,
                            Eigen::VectorXd coefficients) {
  const Eigen::Index gain = balance.gain;
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
  const auto solution = search::constrained_least_squares(a, balance.columns.col(gain), g, h);
  const double u = solution.x[n];
  coefficients[gain] = 1.0 / u;
  for (Eigen::Index i = 0; i < n; ++i)
    coefficients[r.free[static_cast<std::size_t>(i)]] = solution.x[i] / u;
  return coefficients;
}

}  // namespace

Eigen::VectorXd best_coefficients(const Balance& balance, const search::Domain& domain) {
  const Eigen::Index p = balance.columns.cols();
  const Eigen::VectorXd start = domain.lower.head(p);
  const Eigen::Index gain = balance.gain;
  const bool ratio =
      balance.residual == Residual::sensor && domain.lower[gain] < domain.upper[gain];
  const Eigen::VectorXd best =
      ratio ? solve_ratio(balance, reduce(balance, domain, false), domain, start)
            : solve_box(reduce(balance, domain, true), domain, start);
  // Rounding may exceed a bound by an ulp.
  return best.cwiseMax(domain.lower.head(p)).cwiseMin(domain.upper.head(p));
}

Eigen::VectorXd best_coefficients(const PenaltyFunction& penalty, const Eigen::VectorXd& shapes,
                                  const search::Domain& domain, const base::Cancel* cancel) {
  Eigen::MatrixXd columns;
  penalty.columns(shapes, columns, cancel);
  const Balance balance{columns, penalty.target(), penalty.residual(), penalty.gain_index()};
  Eigen::VectorXd best = best_coefficients(balance, domain);
  for (int pass = 0; pass < kPasses && !penalty.is_linear(); ++pass) {
    penalty.linear_columns(shapes, best, columns, cancel);
    best = best_coefficients(balance, domain);
  }
  return best;
}

}  // namespace jointid::identify
