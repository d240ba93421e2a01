#include "signals/position_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/quantile.hpp"
#include "signals/timing.hpp"

namespace jointid::signals {

namespace {

constexpr double kNormal = 1.4826;  // standard deviation of a normal variable over its median size
constexpr Eigen::Index kMost = 1 << 17;  // samples examined for white noise
constexpr Eigen::Index kPiece = 4096;
constexpr std::size_t kFewest = 40;
constexpr double kSmall = 5.5;       // steps: multiples are recognised up to here
constexpr double kNear = 0.2;        // steps from a multiple: positions may be rounded
constexpr std::int64_t kSeen = 10;   // number of small changes that make a grid
constexpr double kOnGrid = 0.95;     // of the small changes
constexpr double kRounding = 1e-6;   // of the median change: smaller changes are rounding errors
constexpr double kBeyondStep = 0.6;  // steps: the noise of the step itself is 0.29
constexpr int kLowest = 3;           // orders of the differences
constexpr int kHighest = 6;

double median(const std::vector<double>& values) {
  return base::quantile(values.size(), values.size(), 0.5, [&](std::size_t i, double& out) {
    out = values[i];
    return true;
  });
}

double step_of(const Signal& position, const std::vector<Stretch>& stretches,
               const base::Cancel* cancel) {
  std::vector<double> changes;
  changes.reserve(static_cast<std::size_t>(position.size()));
  for (const auto& stretch : stretches) {
    if (cancel != nullptr) cancel->check();
    for (Eigen::Index k = stretch.begin + 1; k < stretch.end; ++k) {
      const double change = std::fabs(position[k] - position[k - 1]);
      if (change > 0.0) changes.push_back(change);
    }
  }
  if (changes.empty()) return 0.0;
  const double least = kRounding * median(changes);
  double smallest = std::numeric_limits<double>::infinity();
  for (const double change : changes) {
    smallest = change > least && change < smallest ? change : smallest;
  }
  std::int64_t seen = 0;
  std::int64_t near = 0;
  for (const double change : changes) {
    if (change <= least || change >= kSmall * smallest) continue;
    const double steps = change / smallest;
    ++seen;
    near += std::fabs(steps - std::round(steps)) < kNear ? 1 : 0;
  }
  const bool grid =
      seen >= kSeen && static_cast<double>(near) >= kOnGrid * static_cast<double>(seen);
  return grid ? smallest : 0.0;
}

/// A difference of order m about sample k, with weights of unit norm. It removes a polynomial below
/// that order at the true time stamps.
template <int M>
double difference(const Signal& time, const Signal& position, Eigen::Index k, double period) {
  double square = 0.0;
  double sum = 0.0;
  for (Eigen::Index j = 0; j <= M; ++j) {
    double product = 1.0;
    for (Eigen::Index i = 0; i <= M; ++i) {
      if (i != j) product *= (time[k + j] - time[k + i]) / period;
    }
    const double weight = 1.0 / product;
    square += weight * weight;
    sum += weight * (position[k + j] - position[k]);
  }
  return std::fabs(sum) / std::sqrt(square);
}

double white_noise(const Signal& time, const Signal& position,
                   const std::vector<Stretch>& stretches, double period,
                   const base::Cancel* cancel) {
  std::vector<Stretch> pieces;
  for (const auto& stretch : stretches) {
    for (Eigen::Index k = stretch.begin; k + kHighest < stretch.end; k += kPiece) {
      pieces.push_back({k, std::min(stretch.end, k + kPiece + kHighest)});
    }
  }
  const auto stride = static_cast<std::size_t>(
      (static_cast<Eigen::Index>(pieces.size()) * kPiece + kMost - 1) / kMost);
  std::vector<double> speeds;
  const auto speed = [&](Eigen::Index k) {
    return std::fabs((position[k + kHighest] - position[k]) / (time[k + kHighest] - time[k]));
  };
  for (std::size_t p = 0; p < pieces.size(); p += std::max<std::size_t>(1, stride)) {
    for (auto k = pieces[p].begin; k + kHighest < pieces[p].end; ++k) speeds.push_back(speed(k));
  }
  if (speeds.size() < kFewest) return 0.0;
  const double slow = median(speeds);
  std::array<std::vector<double>, kHighest - kLowest + 1> sizes;
  for (std::size_t p = 0; p < pieces.size(); p += std::max<std::size_t>(1, stride)) {
    if (cancel != nullptr) cancel->check();
    for (auto k = pieces[p].begin; k + kHighest < pieces[p].end; ++k) {
      const double now = speed(k);
      if (now > slow || now == 0.0) continue;  // at rest there is nothing to measure
      sizes[0].push_back(difference<3>(time, position, k, period));
      sizes[1].push_back(difference<4>(time, position, k, period));
      sizes[2].push_back(difference<5>(time, position, k, period));
      sizes[3].push_back(difference<6>(time, position, k, period));
    }
  }
  if (sizes[0].size() < kFewest) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& size : sizes) least = std::min(least, kNormal * median(size));
  return least;
}

}  // namespace

std::vector<Stretch> stretches_between(Eigen::Index samples,
                                       const std::vector<std::int64_t>& gap_after) {
  std::vector<Stretch> result;
  Eigen::Index begin = 0;
  for (const auto gap : gap_after) {
    result.push_back({begin, static_cast<Eigen::Index>(gap) + 1});
    begin = static_cast<Eigen::Index>(gap) + 1;
  }
  result.push_back({begin, samples});
  return result;
}

PositionNoise position_noise(const Signal& time, const Signal& position,
                             const std::vector<Stretch>& stretches, double period,
                             const base::Cancel* cancel) {
  PositionNoise noise;
  noise.quantum = step_of(position, stretches, cancel);
  const double white = white_noise(time, position, stretches, period, cancel);
  noise.sigma = white > kBeyondStep * noise.quantum ? white : noise.quantum / std::sqrt(12.0);
  noise.timing = timing_errors(time, position, period, cancel).as_stamped;
  return noise;
}

}  // namespace jointid::signals
