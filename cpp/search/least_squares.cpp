#include "search/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/decompositions.hpp"

namespace jointid::search {

namespace {

constexpr double kRidge =
    1e-9;  // on unit columns: changes a well-posed solution by 1e-18 relative to its conditioning
constexpr double kLacking =
    1e-12;                       // of a scaled direction: the normal equations may lack a direction
constexpr double kSlack = 1e-9;  // of scaled values and gradients, which are about 1
constexpr int kTogether = 12;    // exchanges between fixed and free parameters
constexpr double kViolation =
    1e-7;  // of the distance moved: beyond it, no x satisfies all constraints

Eigen::VectorXd solve_columns(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                              const std::vector<Eigen::Index>& set) {
  Eigen::MatrixXd part(a.rows(), static_cast<Eigen::Index>(set.size()));
  for (std::size_t j = 0; j < set.size(); ++j)
    part.col(static_cast<Eigen::Index>(j)) = a.col(set[j]);
  return base::least_squares(part, b);
}

/// A quadratic function in a box, and the state of the search for its minimum.
struct Box {
  const Eigen::MatrixXd& square;
  const Eigen::VectorXd& slope;
  Eigen::VectorXd low;
  Eigen::VectorXd high;
  Eigen::VectorXi side;  ///< -1, 1: fixed at the lower, upper bound
  Eigen::VectorXd x;
};

std::vector<Eigen::Index> free_of(const Box& box) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < box.side.size(); ++i) {
    if (box.side[i] == 0) free.push_back(i);
  }
  return free;
}

/// The minimum over the free parameters, with the others at their bounds.
Eigen::VectorXd minimum_of(const Box& box, const std::vector<Eigen::Index>& free) {
  Eigen::VectorXd held = box.x;
  for (const Eigen::Index i : free) held[i] = 0.0;
  const Eigen::VectorXd right = -(box.slope + box.square * held)(free);
  const Eigen::MatrixXd own = box.square(free, free);
  Eigen::MatrixXd damped = own;
  damped.diagonal().array() += kLacking;
  const Eigen::VectorXd part = base::solve_semidefinite(damped, right);
  // A second pass for the remainder. The damping then acts only in directions that are lacking.
  return part + base::solve_semidefinite(damped, right - own * part);
}

/// Fixes all parameters outside the box and frees all that the gradient pulls inside, together.
/// Returns whether this ends.
bool exchanged(Box& box) {
  for (int step = 0; step < kTogether; ++step) {
    for (Eigen::Index i = 0; i < box.side.size(); ++i) {
      if (box.side[i] != 0) box.x[i] = box.side[i] < 0 ? box.low[i] : box.high[i];
    }
    const auto free = free_of(box);
    box.x(free) = minimum_of(box, free);
    const Eigen::VectorXd pull = box.slope + box.square * box.x;
    bool changed = false;
    for (Eigen::Index i = 0; i < box.side.size(); ++i) {
      const double slack = kSlack * (1.0 + std::fabs(box.x[i]));
      int wanted = box.side[i];
      if (box.side[i] == 0) {
        wanted = box.x[i] < box.low[i] - slack ? -1 : box.x[i] > box.high[i] + slack ? 1 : 0;
      } else if (box.side[i] * pull[i] > kSlack) {
        wanted = 0;
      }
      changed = changed || wanted != box.side[i];
      box.side[i] = wanted;
    }
    if (!changed) return true;
  }
  return false;
}

/// From a point inside, changes one bound at a time. The function never rises, so this ends.
void one_by_one(Box& box) {
  const Eigen::Index n = box.side.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    box.x[i] = std::clamp(0.0, box.low[i], box.high[i]);
    box.side[i] = box.x[i] == box.low[i] ? -1 : box.x[i] == box.high[i] ? 1 : 0;
  }
  for (Eigen::Index step = 0; step < 100 + 30 * n; ++step) {
    const auto free = free_of(box);
    const Eigen::VectorXd part = minimum_of(box, free);
    double reach = 1.0;
    Eigen::Index stopped = -1;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::Index i = free[k];
      const double to = part[static_cast<Eigen::Index>(k)];
      const double bound = to < box.low[i] ? box.low[i] : to > box.high[i] ? box.high[i] : to;
      if (bound == to) continue;
      const double own = (bound - box.x[i]) / (to - box.x[i]);
      if (own < reach || stopped < 0) {
        reach = std::min(own, reach);
        stopped = i;
      }
    }
    for (std::size_t k = 0; k < free.size(); ++k) {
      box.x[free[k]] += reach * (part[static_cast<Eigen::Index>(k)] - box.x[free[k]]);
    }
    if (stopped >= 0) {
      box.side[stopped] =
          box.x[stopped] - box.low[stopped] < box.high[stopped] - box.x[stopped] ? -1 : 1;
      box.x[stopped] = box.side[stopped] < 0 ? box.low[stopped] : box.high[stopped];
      continue;
    }
    const Eigen::VectorXd pull = box.slope + box.square * box.x;
    Eigen::Index enter = -1;
    double steepest = kSlack;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (box.side[i] * pull[i] > steepest) {
        steepest = box.side[i] * pull[i];
        enter = i;
      }
    }
    if (enter < 0) return;
    box.side[enter] = 0;
  }
}

}  // namespace

Eigen::VectorXd non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index n = a.cols();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  if (a.size() == 0) return x;
  std::vector<char> passive(static_cast<std::size_t>(n), 0);
  const double tolerance =
      1e-14 * a.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff() * static_cast<double>(a.rows());
  for (Eigen::Index outer = 0; outer < 30 * n + 30; ++outer) {
    const Eigen::VectorXd gradient = a.transpose() * (b - a * x);
    Eigen::Index enter = -1;
    double steepest = tolerance;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (passive[static_cast<std::size_t>(j)] == 0 && gradient[j] > steepest) {
        steepest = gradient[j];
        enter = j;
      }
    }
    if (enter < 0) break;
    passive[static_cast<std::size_t>(enter)] = 1;
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      std::vector<Eigen::Index> set;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (passive[static_cast<std::size_t>(j)] != 0) set.push_back(j);
      }
      if (set.empty()) break;
      const Eigen::VectorXd part = solve_columns(a, b, set);
      if (part.minCoeff() > 0.0) {
        x.setZero();
        for (std::size_t j = 0; j < set.size(); ++j) x[set[j]] = part[static_cast<Eigen::Index>(j)];
        break;
      }
      // Moves towards the unconstrained solution as far as all values stay non-negative. A value
      // that reaches zero leaves the set.
      double reach = 1.0;
      for (std::size_t j = 0; j < set.size(); ++j) {
        const double target = part[static_cast<Eigen::Index>(j)];
        if (target <= 0.0) reach = std::min(reach, x[set[j]] / (x[set[j]] - target));
      }
      for (std::size_t j = 0; j < set.size(); ++j) {
        double& value = x[set[j]];
        value += reach * (part[static_cast<Eigen::Index>(j)] - value);
        if (part[static_cast<Eigen::Index>(j)] <= 0.0 &&
            value <= 1e-15 * (1.0 + std::fabs(part[static_cast<Eigen::Index>(j)]))) {
          value = 0.0;
          passive[static_cast<std::size_t>(set[j])] = 0;
        }
      }
    }
  }
  return x;
}

Eigen::VectorXd box_minimum(const Eigen::MatrixXd& square, const Eigen::VectorXd& gradient,
                            const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  const Eigen::Index n = gradient.size();
  Eigen::VectorXd size = square.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(size[i] > 0.0)) size[i] = 1.0;
  }
  const Eigen::VectorXd inverse = size.cwiseInverse();
  const Eigen::MatrixXd scaled = inverse.asDiagonal() * square * inverse.asDiagonal();
  // Scales values to about 1 by a power of two, without rounding.
  Eigen::VectorXd slope = gradient.cwiseProduct(inverse);
  const double largest = n > 0 ? slope.cwiseAbs().maxCoeff() : 0.0;
  const double unit = largest > 0.0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  slope *= unit;
  size *= unit;
  Box box{scaled,
          slope,
          lower.cwiseProduct(size),
          upper.cwiseProduct(size),
          Eigen::VectorXi::Zero(n),
          Eigen::VectorXd::Zero(n)};
  if (!exchanged(box)) one_by_one(box);
  Eigen::VectorXd x = box.x;
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = box.side[i] < 0   ? lower[i]
           : box.side[i] > 0 ? upper[i]
                             : std::clamp(x[i] / size[i], lower[i], upper[i]) + 0.0;  // no -0
  }
  return x;
}

LeastSquaresResult constrained_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                             const Eigen::MatrixXd& g, const Eigen::VectorXd& h) {
  const Eigen::Index n = a.cols();
  Eigen::VectorXd scale(n);
  Eigen::MatrixXd damped(a.rows() + n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(a.rows() + n);
  right.head(a.rows()) = b;
  damped.setZero();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double norm = a.col(j).norm();
    scale[j] = norm > 0.0 ? 1.0 / norm : 1.0;
    damped.col(j).head(a.rows()) = a.col(j) * scale[j];
    damped(a.rows() + j, j) = kRidge;
  }
  const auto [upper, f] = base::reduced(damped, right);

  LeastSquaresResult result;
  result.x = base::solve_upper(upper, f).cwiseProduct(scale);
  result.feasible = true;
  if (g.rows() == 0) return result;
  const Eigen::ArrayXd size = (g.cwiseAbs() * result.x.cwiseAbs() + h.cwiseAbs()).array();
  if (((g * result.x - h).array() >= -1e-12 * size).all()) return result;

  // z = R x' - f with x = scale x':  min |z| subject to (G scale R^-1) z >= h - G scale R^-1 f.
  const Eigen::MatrixXd scaled = g * scale.asDiagonal();
  const Eigen::MatrixXd distance =
      base::solve_lower(upper.transpose(), scaled.transpose()).transpose();
  Eigen::VectorXd offset = h - distance * f;
  // In units of the farthest single constraint, so that |z| is near 1 for any units of the data.
  // The method finds |z|^2 only to the rounding of 1.
  double reach = 0.0;
  for (Eigen::Index i = 0; i < g.rows(); ++i) {
    const double norm = distance.row(i).norm();
    if (norm > 0.0) reach = std::max(reach, offset[i] / norm);
  }
  if (reach > 0.0) offset /= reach;
  // Rows of unit norm, so that bounds of large and small parameters have the same weight.
  Eigen::MatrixXd dual(n + 1, g.rows());
  for (Eigen::Index i = 0; i < g.rows(); ++i) {
    const double norm = std::hypot(distance.row(i).norm(), offset[i]);
    const double unit = norm > 0.0 ? 1.0 / norm : 1.0;
    dual.col(i).head(n) = distance.row(i).transpose() * unit;
    dual(n, i) = offset[i] * unit;
  }
  Eigen::VectorXd target = Eigen::VectorXd::Zero(n + 1);
  target[n] = 1.0;
  const Eigen::VectorXd u = non_negative_least_squares(dual, target);
  const Eigen::VectorXd gap = dual * u - target;
  if (std::fabs(gap[n]) < 1e-13) {
    result.feasible = false;
    return result;
  }
  const Eigen::VectorXd z = -gap.head(n) / gap[n];
  const Eigen::ArrayXd margin = (distance * z - offset).array();
  result.feasible = (margin >= -kViolation * z.norm() * distance.rowwise().norm().array()).all();
  if (!result.feasible) return result;
  result.x = base::solve_upper(upper, (reach > 0.0 ? reach : 1.0) * z + f).cwiseProduct(scale);
  return result;
}

}  // namespace jointid::search
