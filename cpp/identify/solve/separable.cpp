#include "identify/solve/separable.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include "identify/balance/terms.hpp"
#include "identify/solve/scale.hpp"
#include "search/brent.hpp"
#include "search/polish.hpp"

namespace jointid::identify {

namespace {

constexpr int kScan = 64;  // intervals over the domain of a single free shape
constexpr int kGrid = 16;  // intervals over the domain of each of several
constexpr int kFew = 4;
constexpr std::size_t kPolished = 3;  // best points of the grid that are polished
constexpr double kNarrow = 1e-9;      // of a scale's range: tolerance of the lowest point
constexpr double kBeside = 1e-5;      // the same, if the slope refines it from there on
constexpr double kLevel = 1e-14;      // size of the last step along the slope
constexpr int kSlopes = 40;
constexpr double kRounding = 1e-12;  // of a penalty: smaller differences of values are rounding

/// The penalty as a function of only the free shapes.
class Eliminated {
 public:
  Eliminated(const PenaltyFunction& penalty, const search::Domain& domain, base::Pool& pool)
      : penalty_(penalty), domain_(domain), pool_(pool) {
    for (Eigen::Index i = penalty.coefficients(); i < penalty.parameters(); ++i) {
      if (domain.lower[i] < domain.upper[i]) free_.push_back(i);
    }
  }

  [[nodiscard]] const std::vector<Eigen::Index>& free() const { return free_; }

  /// All parameters for these values of the free shapes.
  [[nodiscard]] Eigen::VectorXd full(const std::vector<double>& shapes) const {
    Eigen::VectorXd theta = domain_.lower;
    for (std::size_t i = 0; i < free_.size(); ++i) theta[free_[i]] = shapes[i];
    const Eigen::Index p = penalty_.coefficients();
    theta.head(p) =
        best_coefficients(penalty_, theta.tail(theta.size() - p), domain_, &pool_.cancel());
    return theta;
  }

  /// Takes the point if its penalty is not higher.
  void offer(const Eigen::VectorXd& theta, SeparableResult& result) const {
    const double value = penalty_(theta, &pool_.cancel());
    ++result.evaluations;
    if (result.best.size() > 0 && value > result.penalty) return;
    result.best = theta;
    result.penalty = value;
  }

  /// Takes a point where the penalty is flat: rounding decides which value is lower.
  void settle(const Eigen::VectorXd& theta, SeparableResult& result) const {
    const double value = penalty_(theta, &pool_.cancel());
    ++result.evaluations;
    // NaN is not lower, either.
    if (result.best.size() > 0 && !(value <= result.penalty * (1.0 + kRounding))) return;
    result.best = theta;
    result.penalty = value;
  }

  [[nodiscard]] bool is_linear() const { return penalty_.is_linear(); }

  /// The penalty's derivative by the only free shape, at the best coefficients. They change with
  /// it, but to first order the penalty does not change with them.
  [[nodiscard]] double slope(double shape) const {
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    penalty_.residuals(full({shape}), residual, &jacobian, &pool_.cancel());
    return 2.0 * jacobian.col(free_[0]).dot(residual);
  }

  /// Penalties at many points, on the threads.
  [[nodiscard]] std::vector<double> values(const std::vector<std::vector<double>>& points) const {
    std::vector<double> result(points.size());
    if (penalty_.is_cheap()) {
      for (std::size_t i = 0; i < points.size(); ++i) result[i] = penalty_(full(points[i]));
      return result;
    }
    pool_.for_each(points.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        result[i] = penalty_(full(points[i]), &pool_.cancel());
      }
    });
    return result;
  }

 private:
  const PenaltyFunction& penalty_;
  const search::Domain& domain_;
  base::Pool& pool_;
  std::vector<Eigen::Index> free_;
};

/// Penalties at even steps over a scale.
std::vector<double> scan(const Eliminated& reduced, const Scale& scale, SeparableResult& result) {
  std::vector<std::vector<double>> points;
  for (int i = 0; i <= kScan; ++i) points.push_back({scale.at(static_cast<double>(i) / kScan)});
  result.evaluations += kScan + 1;
  return reduced.values(points);
}

/// The interval between the neighbours of the scan's best point, as shares of the range.
search::Interval lowest(const std::vector<double>& scanned) {
  const auto best =
      static_cast<double>(std::min_element(scanned.begin(), scanned.end()) - scanned.begin());
  return {std::max(0.0, best - 1.0) / kScan, std::min<double>(kScan, best + 1.0) / kScan};
}

/// Whether the scan falls all the way from a place to its best point. Then both are in one valley.
bool falls_from(const std::vector<double>& scanned, double from) {
  const double share = std::clamp(from, 0.0, 1.0);
  const auto best = std::min_element(scanned.begin(), scanned.end());
  const auto first = scanned.begin() + static_cast<std::ptrdiff_t>(std::floor(share * kScan));
  const auto last = scanned.begin() + static_cast<std::ptrdiff_t>(std::ceil(share * kScan));
  if (last <= best) return std::is_sorted(first, best + 1, std::greater<>());
  if (first >= best) return std::is_sorted(best, last + 1);
  return true;
}

/// The point between two others where the penalty is flat, if its slopes bracket one; by false
/// position (Illinois). Values give the lowest point only to the root of their rounding, slopes to
/// their rounding itself.
std::optional<double> level_between(const Eliminated& reduced, const Scale& scale,
                                    search::Interval interval, base::Pool& pool,
                                    SeparableResult& result) {
  const auto slope = [&](double share) {
    pool.poll();
    ++result.evaluations;
    return reduced.slope(scale.at(share));
  };
  auto [left, right] = interval;
  double falls = slope(left);
  double rises = slope(right);
  if (!(falls < 0.0 && rises > 0.0)) return std::nullopt;
  double found = left;
  int side = 0;  // the end that the last point replaced
  for (int i = 0; i < kSlopes; ++i) {
    const double next = (left * rises - right * falls) / (rises - falls);
    const double here = slope(next);
    const bool settled = std::fabs(next - found) <= kLevel || here == 0.0;
    found = next;
    if (settled) break;
    if (here < 0.0) {
      left = next;
      falls = here;
      if (side < 0) rises *= 0.5;  // the other end must also move
      side = -1;
    } else {
      right = next;
      rises = here;
      if (side > 0) falls *= 0.5;
      side = 1;
    }
  }
  return found;
}

/// The lowest point of an interval.
void narrow(const Eliminated& reduced, const Scale& scale, search::Interval interval,
            base::Pool& pool, SeparableResult& result) {
  const auto value = [&](double share) {
    pool.poll();
    ++result.evaluations;
    return reduced.values({{scale.at(share)}})[0];
  };
  if (reduced.is_linear()) {
    const double near = search::minimise_brent(value, interval, kBeside);
    const search::Interval beside{std::max(interval.left, near - 10.0 * kBeside),
                                  std::min(interval.right, near + 10.0 * kBeside)};
    if (const auto level = level_between(reduced, scale, beside, pool, result)) {
      reduced.settle(reduced.full({scale.at(*level)}), result);
      return;
    }
  }
  const double best = search::minimise_brent(value, interval, kNarrow);
  reduced.offer(reduced.full({scale.at(best)}), result);
}

/// The ends, which the narrowing never evaluates.
void offer_ends(const Eliminated& reduced, const Scale& scale, SeparableResult& result) {
  for (const double share : {0.0, 1.0}) reduced.offer(reduced.full({scale.at(share)}), result);
}

/// A scan, then narrowing about its best point.
void search_line(const Eliminated& reduced, const Scale& scale, base::Pool& pool,
                 SeparableResult& result) {
  narrow(reduced, scale, lowest(scan(reduced, scale, result)), pool, result);
  offer_ends(reduced, scale, result);
}

/// The valley about the best point so far. Widens until its minimum is inside, or at the domain's
/// end, because the start may lie on a slope.
void search_near(const Eliminated& reduced, const Scale& scale, base::Pool& pool,
                 SeparableResult& result) {
  for (double reach = 1.0 / kScan;; reach *= 4.0) {
    const double share = scale.share(result.best[reduced.free()[0]]);
    const search::Interval near{std::max(0.0, share - reach), std::min(1.0, share + reach)};
    narrow(reduced, scale, near, pool, result);
    const double found = scale.share(result.best[reduced.free()[0]]);
    const double margin = 0.01 * reach;
    if ((near.left <= 0.0 || found > near.left + margin) &&
        (near.right >= 1.0 || found < near.right - margin)) {
      return;
    }
  }
}

/// Refines a result that elimination only approximates.
void polish_best(const PenaltyFunction& penalty, const search::Domain& domain, base::Pool& pool,
                 const Eliminated& reduced, SeparableResult& result) {
  const auto residuals = [&](const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                             Eigen::MatrixXd* jacobian) {
    penalty.residuals(theta, residual, jacobian, &pool.cancel());
  };
  reduced.offer(search::polish(residuals, domain, result.best, pool).best, result);
}

void search_grid(const Eliminated& reduced, const std::vector<Scale>& scales,
                 const PenaltyFunction& penalty, const search::Domain& domain, base::Pool& pool,
                 SeparableResult& result) {
  std::vector<std::vector<double>> points{{}};
  for (std::size_t s = 0; s < scales.size(); ++s) {
    const auto& scale = scales[s];
    // If the balance is not linear, the polish improves more than a step between points.
    const auto& shape = find_shape(penalty.names()[static_cast<std::size_t>(reduced.free()[s])]);
    const int steps = penalty.is_linear() || shape.speed_power != 0.0 ? kGrid : kFew;
    std::vector<std::vector<double>> wider;
    for (const auto& point : points) {
      for (int i = 0; i <= steps; ++i) {
        wider.push_back(point);
        wider.back().push_back(scale.at(static_cast<double>(i) / steps));
      }
    }
    points = std::move(wider);
  }
  const auto values = reduced.values(points);
  result.evaluations += static_cast<int>(points.size());
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  const auto residuals = [&](const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                             Eigen::MatrixXd* jacobian) {
    penalty.residuals(theta, residual, jacobian, &pool.cancel());
  };
  for (std::size_t i = 0; i < std::min(kPolished, order.size()); ++i) {
    const Eigen::VectorXd start = reduced.full(points[order[i]]);
    reduced.offer(start, result);
    reduced.offer(search::polish(residuals, domain, start, pool).best, result);
  }
}

}  // namespace

void require_domain(const PenaltyFunction& penalty, const search::Domain& domain) {
  domain.validate();
  if (domain.size() == penalty.parameters()) return;
  throw std::invalid_argument("domain must have " + std::to_string(penalty.parameters()) +
                              " parameters, got " + std::to_string(domain.size()));
}

namespace {

std::vector<Scale> scales_of(const PenaltyFunction& penalty, const search::Domain& domain,
                             const Eliminated& reduced) {
  std::vector<Scale> scales;
  for (const auto i : reduced.free()) {
    // A shape like speed^-2 is searched in its square root, which behaves like a speed.
    const auto& shape = find_shape(penalty.names()[static_cast<std::size_t>(i)]);
    const bool root = shape.speed_power == -2.0;
    scales.emplace_back(domain.lower[i], domain.upper[i], root);
  }
  return scales;
}

}  // namespace

SeparableResult minimise_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                   base::Pool& pool) {
  require_domain(penalty, domain);
  const Eliminated reduced(penalty, domain, pool);
  const auto scales = scales_of(penalty, domain, reduced);
  SeparableResult result;
  if (scales.empty()) {
    reduced.offer(reduced.full({}), result);
  } else if (scales.size() == 1) {
    search_line(reduced, scales[0], pool, result);
  } else {
    search_grid(reduced, scales, penalty, domain, pool, result);
  }
  if (!penalty.is_linear() && scales.size() < 2)
    polish_best(penalty, domain, pool, reduced, result);
  return result;
}

SeparableResult refine_separable(const PenaltyFunction& penalty, const search::Domain& domain,
                                 const Eigen::VectorXd& start, base::Pool& pool, bool everywhere) {
  require_domain(penalty, domain);
  const Eliminated reduced(penalty, domain, pool);
  const auto scales = scales_of(penalty, domain, reduced);
  SeparableResult result;
  reduced.offer(start.cwiseMax(domain.lower).cwiseMin(domain.upper), result);
  if (scales.empty()) {
    reduced.offer(reduced.full({}), result);
    return result;
  }
  if (scales.size() > 1) {
    const auto residuals = [&](const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                               Eigen::MatrixXd* jacobian) {
      penalty.residuals(theta, residual, jacobian, &pool.cancel());
    };
    reduced.offer(search::polish(residuals, domain, result.best, pool).best, result);
    if (everywhere) search_grid(reduced, scales, penalty, domain, pool, result);
    return result;
  }
  if (!everywhere) {
    search_near(reduced, scales[0], pool, result);
    return result;
  }
  const double share = scales[0].share(result.best[reduced.free()[0]]);
  const auto scanned = scan(reduced, scales[0], result);
  if (!falls_from(scanned, share)) search_near(reduced, scales[0], pool, result);
  narrow(reduced, scales[0], lowest(scanned), pool, result);
  offer_ends(reduced, scales[0], result);
  return result;
}

}  // namespace jointid::identify
