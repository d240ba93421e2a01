#include "identify/solve/projected_search.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/decompositions.hpp"
#include "identify/balance/terms.hpp"
#include "identify/solve/projection.hpp"
#include "identify/solve/scale.hpp"

namespace jointid::identify {

namespace {

constexpr Eigen::Index kFewWindows = 96;  // windows of the scan, or more if it needs them
constexpr Eigen::Index kAParameter = 8;   // windows of the scan for each parameter
constexpr Eigen::Index kMostColumns =
    32;  // with more columns, their basis costs more than compression
constexpr Eigen::Index kMostShapes = 2;  // with more shapes, the scan costs more
constexpr int kLine = 32;                // intervals over the range of a single shape
constexpr int kSpeeds = 12;              // over the range of a speed, of two shapes
constexpr int kExponents = 6;            // over the range of an exponent
constexpr std::size_t kValleys = 3;
constexpr double kTold = 50.0;  // variances that separate one point of the scan from another
constexpr double kSettled =
    1e-13;  // of the penalty: the largest reduction that the last step but one may promise
constexpr double kRough = 1e-4;  // the same over some windows, which only give a start
constexpr int kSteps = 60;
constexpr int kRoughSteps = 8;
constexpr const char* kAtEnd = "the optimum lies near the end of a shape's range";
constexpr std::size_t kLarge = 1U << 17U;  // nodes: a longer evaluation must be interruptible

using Shapes = Eigen::VectorXd;

/// Runs an evaluation so that Ctrl-C ends it. A long one runs on a worker while this thread polls.
template <class Work>
void run(const Projection& projection, base::Pool& pool, const Work& work) {
  if (projection.nodes() < kLarge) {
    pool.poll();
    work();
    return;
  }
  pool.for_each(1, [&](std::size_t, std::size_t) { work(); });
}

struct Found {
  Eigen::VectorXd shares;
  ProjectedPoint point;
  bool settled = false;
};

class ProjectedSearch {
 public:
  ProjectedSearch(const Penalty& penalty, const search::Domain& domain, base::Pool& pool)
      : penalty_(penalty), pool_(pool) {
    for (Eigen::Index i = penalty.coefficients(); i < penalty.parameters(); ++i) {
      if (domain.lower[i] == domain.upper[i]) continue;
      const auto& shape = find_shape(penalty.names()[static_cast<std::size_t>(i)]);
      scales_.emplace_back(domain.lower[i], domain.upper[i], shape.speed_power == -2.0);
      steps_.push_back(shape.speed_power != 0.0 ? kSpeeds : kExponents);
    }
    if (scales_.size() == 1) steps_[0] = kLine;
  }

  /// Starts of the valleys, as shares of the ranges. Returns a reason if the windows cannot
  /// separate them.
  std::string find_valleys(const Projection& few, std::vector<Eigen::VectorXd>& result) {
    const auto values = scan(few);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (!is_told(few, *most, *least)) return "the penalty hardly depends on the shapes";
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool close = !is_told(few, values[i], *least);
      if (values[i] == *least || (close && is_valley(values, i))) found.push_back(i);
    }
    if (found.size() > kValleys) return "the penalty has many valleys";
    for (const auto i : found) {
      const auto at = place(i);
      for (std::size_t s = 0; s < scales_.size(); ++s) {
        const bool lowest = at[s] == 0;
        const bool end = lowest || at[s] == steps_[s];
        // In the root of a shape the penalty is flat at 0, so a step gives no information.
        if (end && (scales_.size() == 1 || (lowest && scales_[s].is_root()))) return kAtEnd;
      }
      result.push_back(scales_.size() == 1 ? lowest_of_parabola(values, i) : shares(at));
    }
    return {};
  }

  /// Whether two values differ by more than chance over these windows.
  [[nodiscard]] bool is_told(const Projection& few, double value, double least) const {
    const auto spare = static_cast<double>(few.windows() - penalty_.parameters());
    return (value / least - 1.0) * spare > kTold;
  }

  /// Whether some windows contradict the result of all windows.
  bool contradict(const Projection& few, const Found& rough, const Found& found) {
    return is_told(few, evaluate(few, found.shares).value, rough.point.value);
  }

  /// Gauss-Newton steps within the ranges, damped where a step does not reduce the penalty.
  Found descend(const Projection& projection, const Eigen::VectorXd& start, int most,
                double settled) {
    Found best{start, evaluate(projection, start), false};
    double damping = 0.0;
    Eigen::MatrixXd secant;  // for a single shape: the slope of the gradient
    const auto damp = [&] {
      if (damping > 1e6) return false;
      damping = std::max(1e-2, 10.0 * damping);
      secant.resize(0, 0);
      return true;
    };
    for (int step = 0; step < most; ++step) {
      const Eigen::VectorXd move = bounded_step(best, secant, damping);
      const double promised =
          -best.point.gradient.dot(move) -
          0.5 * move.dot((secant.size() > 0 ? secant : best.point.curvature) * move);
      if (promised < -settled * best.point.value) {  // the end of a range cut the step
        if (!damp()) break;
        continue;
      }
      const bool last = !(promised > settled * best.point.value);
      best.settled = last;
      if (last && promised <= 0.0) break;
      Found next{best.shares + move, {}, best.settled};
      next.point = evaluate(projection, next.shares);
      if (last) {  // rounding decides which value is lower, but the gradient gives the place
        if (next.point.value <= best.point.value * (1.0 + settled)) best = std::move(next);
        break;
      }
      if (next.point.value > best.point.value) {
        best.settled = next.point.value - best.point.value <= settled * best.point.value;
        if (best.settled || !damp()) break;
        continue;
      }
      damping = damping > 1e-3 ? 0.1 * damping : 0.0;
      secant = between(best, next);
      best = std::move(next);
    }
    return best;
  }

  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  [[nodiscard]] Shapes at(const Eigen::VectorXd& shares) const {
    Shapes result(shares.size());
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      result[i] = scales_[static_cast<std::size_t>(i)].at(shares[i]);
    }
    return result;
  }

  /// The point's derivatives are by the shares.
  ProjectedPoint evaluate(const Projection& projection, const Eigen::VectorXd& shares) {
    ProjectedPoint result;
    run(projection, pool_, [&] { result = projection.at(at(shares)); });
    ++evaluations_;
    Eigen::VectorXd slope(shares.size());
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      slope[i] = scales_[static_cast<std::size_t>(i)].slope(shares[i]);
    }
    result.gradient = result.gradient.cwiseProduct(slope).eval();
    result.curvature = (slope.asDiagonal() * result.curvature * slope.asDiagonal()).eval();
    return result;
  }

  [[nodiscard]] std::vector<int> place(std::size_t point) const {
    std::vector<int> result;
    for (const int steps : steps_) {
      const auto side = static_cast<std::size_t>(steps) + 1;
      result.push_back(static_cast<int>(point % side));
      point /= side;
    }
    return result;
  }

  [[nodiscard]] Eigen::VectorXd shares(const std::vector<int>& place) const {
    Eigen::VectorXd result(static_cast<Eigen::Index>(place.size()));
    for (std::size_t s = 0; s < place.size(); ++s) {
      const double part = static_cast<double>(place[s]) / steps_[s];
      // Slow friction lies at the low end of a speed's range, which may cover two decades.
      const bool finer = scales_.size() > 1 && steps_[s] == kSpeeds && !scales_[s].is_root();
      result[static_cast<Eigen::Index>(s)] = finer ? part * part : part;
    }
    return result;
  }

  std::vector<double> scan(const Projection& projection) {
    std::size_t points = 1;
    for (const int steps : steps_) points *= static_cast<std::size_t>(steps) + 1;
    std::vector<double> values(points);
    for (std::size_t i = 0; i < points; ++i) {
      run(projection, pool_, [&] { values[i] = projection.value(at(shares(place(i)))); });
    }
    evaluations_ += static_cast<int>(points);
    return values;
  }

  /// Whether no neighbour, along the edges or across, is lower. Of equal ones, the first counts.
  [[nodiscard]] bool is_valley(const std::vector<double>& values, std::size_t point) const {
    const auto at = place(point);
    const int second = scales_.size() > 1 ? 1 : 0;
    for (int b = -second; b <= second; ++b) {
      for (int a = -1; a <= 1; ++a) {
        if (a == 0 && b == 0) continue;
        const int first = at[0] + a;
        const int other = second > 0 ? at[1] + b : 0;
        if (first < 0 || first > steps_[0]) continue;
        if (other < 0 || (second > 0 && other > steps_[1])) continue;
        const auto next = static_cast<std::size_t>(other * (steps_[0] + 1) + first);
        if (values[next] < values[point]) return false;
        if (values[next] == values[point] && next < point) return false;
      }
    }
    return true;
  }

  [[nodiscard]] Eigen::VectorXd lowest_of_parabola(const std::vector<double>& values,
                                                   std::size_t point) const {
    const double left = values[point - 1] - values[point];
    const double right = values[point + 1] - values[point];
    const double shift = left + right > 0.0 ? 0.5 * (left - right) / (left + right) : 0.0;
    Eigen::VectorXd result(1);
    result[0] = (static_cast<double>(point) + shift) / steps_[0];
    return result;
  }

  static Eigen::MatrixXd between(const Found& from, const Found& to) {
    Eigen::MatrixXd result;
    if (from.shares.size() != 1) return result;
    const double move = to.shares[0] - from.shares[0];
    const double slope = (to.point.gradient[0] - from.point.gradient[0]) / move;
    const double expected = to.point.curvature(0, 0);
    if (slope > 0.25 * expected && slope < 4.0 * expected) {
      result.resize(1, 1);
      result(0, 0) = slope;
    }
    return result;
  }

  static Eigen::VectorXd bounded_step(const Found& from, const Eigen::MatrixXd& secant,
                                      double damping) {
    const auto& gradient = from.point.gradient;
    const Eigen::Index count = gradient.size();
    Eigen::MatrixXd curvature = secant.size() > 0 ? secant : from.point.curvature;
    curvature.diagonal() *= 1.0 + damping;
    Eigen::VectorXd right = -gradient;
    for (Eigen::Index i = 0; i < count; ++i) {  // fixed at an end
      const bool low = from.shares[i] <= 0.0 && gradient[i] >= 0.0;
      const bool high = from.shares[i] >= 1.0 && gradient[i] <= 0.0;
      if (!low && !high && curvature(i, i) > 0.0) continue;
      curvature.row(i).setZero();
      curvature.col(i).setZero();
      curvature(i, i) = 1.0;
      right[i] = 0.0;
    }
    const Eigen::VectorXd step = base::solve_semidefinite(curvature, right);
    return (from.shares + step).cwiseMax(0.0).cwiseMin(1.0) - from.shares;
  }

  const Penalty& penalty_;
  base::Pool& pool_;
  std::vector<Scale> scales_;
  std::vector<int> steps_;  ///< intervals of the scan
  int evaluations_ = 0;
};

/// Evenly spread windows that are out of step with any period of the motion; none if there are too
/// few.
std::vector<Eigen::Index> some_windows(const Penalty& penalty) {
  const Eigen::Index wanted = std::max(kFewWindows, kAParameter * penalty.parameters());
  const Eigen::Index stride = penalty.window_count() / wanted;
  std::vector<Eigen::Index> result;
  if (stride < 2) return result;
  constexpr double kGolden = 0.6180339887498949;
  for (Eigen::Index i = 0; i < wanted; ++i) {
    const double turn = kGolden * static_cast<double>(i);
    const double part = turn - std::floor(turn);
    result.push_back(stride * i + static_cast<Eigen::Index>(part * static_cast<double>(stride)));
  }
  return result;
}

/// Reason why this search does not suit a penalty; empty if it does.
std::string refusal(const Penalty& penalty, const search::Domain& domain) {
  Eigen::Index shapes = 0;
  for (Eigen::Index i = penalty.coefficients(); i < penalty.parameters(); ++i) {
    if (domain.lower[i] < domain.upper[i]) ++shapes;
  }
  if (shapes == 0) return "no shape is searched";
  if (shapes > kMostShapes) return "more than two shapes are searched";
  if (penalty.cumulative()) return "windows are running sums";
  if (!penalty.is_linear()) return "the balance is not linear";
  if (penalty.coefficients() > kMostColumns) return "the model has many coefficients";
  return {};
}

}  // namespace

Projected minimise_projected(const Penalty& penalty, const search::Domain& domain,
                             base::Pool& pool) {
  require_domain(penalty, domain);
  if (auto reason = refusal(penalty, domain); !reason.empty()) return {{}, std::move(reason)};
  const auto windows = some_windows(penalty);
  if (windows.empty()) return {{}, "there are few windows"};
  ProjectedSearch search(penalty, domain, pool);
  const Projection few(penalty, domain, windows, pool.cancel());
  std::vector<Eigen::VectorXd> valleys;
  if (auto reason = search.find_valleys(few, valleys); !reason.empty()) {
    return {{}, std::move(reason)};
  }
  std::optional<Projection> all;
  const auto make = [&] {
    all.emplace(penalty, domain, std::vector<Eigen::Index>{}, pool.cancel());
  };
  if (penalty.window_count() < static_cast<Eigen::Index>(kLarge / 8)) {
    make();
  } else {
    pool.for_each(1, [&](std::size_t, std::size_t) { make(); });
  }
  std::optional<ProjectedPoint> best;
  for (const auto& start : valleys) {
    const Found rough = search.descend(few, start, kRoughSteps, kRough);
    const Found found = search.descend(*all, rough.shares, kSteps, kSettled);
    if (!found.settled) return {{}, "the steps did not settle"};
    const bool inside = found.shares.minCoeff() > 0.0 && found.shares.maxCoeff() < 1.0;
    if (!inside) return {{}, kAtEnd};
    if (search.contradict(few, rough, found)) {
      return {{}, "some of the windows and all of them differ"};
    }
    if (!best || found.point.value < best->value) best = found.point;
  }
  SeparableResult result;
  result.best = best->theta;
  run(*all, pool, [&] { result.penalty = penalty(result.best, &pool.cancel()); });
  result.evaluations = search.evaluations() + 1;
  return {std::move(result), {}};
}

}  // namespace jointid::identify
