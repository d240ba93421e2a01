#include "search/polish.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.hpp"

namespace jointid::search {

namespace {

constexpr double kTolerance = 1e-14;

/// Parameters that can move now: free, and not pressed against a bound by the gradient.
std::vector<Eigen::Index> movable(const Domain& domain, const Eigen::VectorXd& theta,
                                  const Eigen::VectorXd& gradient) {
  std::vector<Eigen::Index> indices;
  for (const auto i : domain.free()) {
    const bool held = (theta[i] <= domain.lower[i] && gradient[i] >= 0.0) ||
                      (theta[i] >= domain.upper[i] && gradient[i] <= 0.0);
    if (!held) indices.push_back(i);
  }
  return indices;
}

/// The damped Gauss-Newton step over some columns, each scaled to unit norm.
Eigen::VectorXd damped_step(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual,
                            const std::vector<Eigen::Index>& columns, double damping) {
  const auto p = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index rows = residual.size();
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(rows + p, p);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows + p);
  Eigen::VectorXd scale(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const auto column = jacobian.col(columns[static_cast<std::size_t>(j)]);
    const double norm = column.norm();
    scale[j] = norm > 0.0 ? 1.0 / norm : 0.0;
    system.col(j).head(rows) = column * scale[j];
    system(rows + j, j) = std::sqrt(damping);
  }
  right.head(rows) = -residual;
  const Eigen::VectorXd step = base::least_squares(system, right);
  Eigen::VectorXd full = Eigen::VectorXd::Zero(jacobian.cols());
  for (Eigen::Index j = 0; j < p; ++j)
    full[columns[static_cast<std::size_t>(j)]] = step[j] * scale[j];
  return full;
}

}  // namespace

PolishResult polish(const ResidualFunction& residuals, const Domain& domain,
                    const Eigen::VectorXd& start, base::Pool& pool, int iterations) {
  domain.validate();
  PolishResult result;
  result.best = start.cwiseMax(domain.lower).cwiseMin(domain.upper);
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  residuals(result.best, residual, &jacobian);
  result.penalty = residual.squaredNorm();
  double damping = 1e-6;
  int settled = 0;
  for (; result.iterations < iterations && settled < 2; ++result.iterations) {
    pool.poll();
    const Eigen::VectorXd gradient = jacobian.transpose() * residual;
    const auto columns = movable(domain, result.best, gradient);
    if (columns.empty()) {
      settled = 2;
      break;
    }
    const Eigen::VectorXd step = damped_step(jacobian, residual, columns, damping);
    // Projecting the step keeps the box. A parameter that hits its bound is fixed from the next
    // iteration on.
    const Eigen::VectorXd trial =
        (result.best + step).cwiseMax(domain.lower).cwiseMin(domain.upper);
    Eigen::VectorXd trial_residual;
    residuals(trial, trial_residual, nullptr);
    const double penalty = trial_residual.squaredNorm();
    if (penalty <= result.penalty) {
      const double gain = result.penalty - penalty;
      settled = gain <= kTolerance * result.penalty ? settled + 1 : 0;
      result.best = trial;
      result.penalty = penalty;
      residuals(result.best, residual, &jacobian);
      damping = std::max(damping * 0.1, 1e-15);
    } else {
      damping = damping * 10.0;
      // A step that only rounding turns uphill also ends the search.
      if (damping > 1e8) settled = 2;
      if (penalty - result.penalty <= kTolerance * result.penalty) ++settled;
    }
  }
  result.converged = settled >= 2;
  return result;
}

}  // namespace jointid::search
