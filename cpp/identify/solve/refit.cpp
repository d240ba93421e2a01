#include "identify/solve/refit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "base/decompositions.hpp"
#include "base/gram.hpp"

namespace jointid::identify {

namespace {

constexpr int kMostSteps = 60;
constexpr double kNear = 2e-5;    // remaining distance in standard errors
constexpr double kEnough = 1e-4;  // of an expected error; then the last step need not be checked
constexpr double kFloor = 1e-13;  // damping that never disturbs, and keeps the equations solvable
constexpr std::int64_t kKept =
    1 << 20;  // largest number of samples at which the parts are kept between steps

class Windows {
 public:
  Windows(const PenaltyParts& parts, const search::Domain& domain, base::Pool* pool)
      : parts_(parts), pool_(pool) {
    if (parts.samples() <= kKept) {
      kept_.resize(parts.count());
      for_each(parts.count(), pool,
               [&](std::size_t i) { kept_[i] = std::make_unique<Penalty>(parts.part(i)); });
    }
    stage_ = parts.first_stage(domain.free(), kept_, pool);
    if (!stage_) return;
    for (auto& part : kept_) part->project_reading(*stage_);
  }

  [[nodiscard]] Balanced at(const Eigen::VectorXd& theta) {
    std::vector<Balanced> each(parts_.count());
    for_each(parts_.count(), pool_, [&](std::size_t i) {
      Eigen::VectorXd residual;
      Eigen::MatrixXd jacobian;
      if (kept_.empty()) {
        Penalty part = parts_.part(i);
        if (stage_) part.project_reading(*stage_);
        part.residuals(theta, residual, &jacobian);
      } else {
        kept_[i]->residuals(theta, residual, &jacobian);
      }
      each[i].square = base::symmetric_products(jacobian, jacobian);
      each[i].gradient = jacobian.transpose() * residual;
      each[i].penalty = residual.squaredNorm();
    });
    Balanced all = each[0];
    for (std::size_t i = 1; i < each.size();
         ++i) {  // always in this order, so always the same bits
      all.square += each[i].square;
      all.gradient += each[i].gradient;
      all.penalty += each[i].penalty;
    }
    return all;
  }

 private:
  const PenaltyParts& parts_;
  base::Pool* pool_;
  std::optional<FirstStage> stage_;
  std::vector<std::unique_ptr<Penalty>> kept_;
};

/// The damped step over the movable parameters: free, and not pressed against a bound.
Eigen::VectorXd step_from(const Balanced& sums, const search::Domain& domain,
                          const Eigen::VectorXd& theta, double damping) {
  std::vector<Eigen::Index> moving;
  for (const auto i : domain.free()) {
    const bool held = (theta[i] <= domain.lower[i] && sums.gradient[i] >= 0.0) ||
                      (theta[i] >= domain.upper[i] && sums.gradient[i] <= 0.0);
    if (!held && sums.square(i, i) > 0.0) moving.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(moving.size());
  Eigen::MatrixXd system(count, count);
  Eigen::VectorXd right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto a = moving[static_cast<std::size_t>(i)];
    const double size = std::sqrt(sums.square(a, a));
    right[i] = -sums.gradient[a] / size;
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto b = moving[static_cast<std::size_t>(j)];
      system(i, j) = sums.square(a, b) / (size * std::sqrt(sums.square(b, b)));
    }
    system(i, i) = 1.0 + damping;
  }
  Eigen::VectorXd step = Eigen::VectorXd::Zero(theta.size());
  if (count == 0) return step;
  const Eigen::VectorXd scaled = base::solve_semidefinite(system, right);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto a = moving[static_cast<std::size_t>(i)];
    step[a] = scaled[i] / std::sqrt(sums.square(a, a));
  }
  return step;
}

/// The largest relative change of a parameter in which the residuals are not linear.
double nonlinearity(const PenaltyParts& parts, const Eigen::VectorXd& at,
                    const Eigen::VectorXd& moved) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    if (!parts.is_nonlinear(i) || moved[i] == 0.0) continue;
    largest = std::max(largest, std::fabs(moved[i]) /
                                    std::max(std::fabs(at[i]), std::numeric_limits<double>::min()));
  }
  return largest;
}

}  // namespace

Eigen::VectorXd descend(const std::function<Balanced(const Eigen::VectorXd&)>& at,
                        const PenaltyParts& alike, Eigen::Index windows,
                        const search::Domain& domain, const Eigen::VectorXd& start,
                        const Balanced& first, double share) {
  const double freedom = static_cast<double>(
      std::max<Eigen::Index>(1, windows - static_cast<Eigen::Index>(domain.size())));
  Eigen::VectorXd best = start;
  Balanced sums = first;
  double damping = kFloor;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::VectorXd step = step_from(sums, domain, best, damping);
    const Eigen::VectorXd trial = (best + step).cwiseMax(domain.lower).cwiseMin(domain.upper);
    const Eigen::VectorXd moved = trial - best;
    const bool cut =
        trial != best + step;  // by a bound: the remaining parameters will move differently
    // In standard errors: the length in the metric of the penalty.
    const double way = std::sqrt(std::max(0.0, moved.dot(sums.square * moved)) * freedom /
                                 std::max(sums.penalty, std::numeric_limits<double>::min()));
    // Each step is shorter by about the same factor as the one before. The error of the first one
    // is the nonlinearity of the residuals over it.
    const double shrunk = std::isfinite(before) ? way / before : nonlinearity(alike, best, moved);
    const double left = way * std::min(1.0, shrunk);
    if (way < kNear || (damping == kFloor && !cut && (left < kEnough || shrunk < share)))
      return trial;
    const Balanced there = at(trial);
    if (there.penalty <= sums.penalty * (1.0 + 1e-12)) {
      best = trial;
      sums = there;
      before = way;
      damping = std::max(kFloor, 0.1 * damping);
    } else {
      damping = std::max(1e-4, 10.0 * damping);
      if (damping > 1e8) break;
    }
  }
  return best;
}

Eigen::VectorXd refit(const PenaltyParts& parts, const search::Domain& domain,
                      const Eigen::VectorXd& start, base::Pool* pool) {
  domain.validate();
  Windows windows(parts, domain, pool);
  const auto at = [&](const Eigen::VectorXd& theta) { return windows.at(theta); };
  const Eigen::VectorXd inside = start.cwiseMax(domain.lower).cwiseMin(domain.upper);
  return descend(at, parts, parts.window_count(), domain, inside, at(inside), 0.0);
}

}  // namespace jointid::identify
