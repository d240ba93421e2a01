#include "signals/timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/clones.hpp"
#include "base/quantile.hpp"
#include "base/scans.hpp"

namespace jointid::signals {

namespace {

constexpr Eigen::Index kSpeedReach = 4;  // samples on either side for the speed
constexpr auto kWide = static_cast<std::size_t>(2 * kSpeedReach);
constexpr Eigen::Index kStretch = 4096;           // samples
constexpr Eigen::Index kMostIntervals = 1 << 18;  // samples examined
constexpr std::size_t kFewestIntervals = 40;
constexpr double kFast = 0.3;  // of the peak speed
constexpr double kSlow = 0.1;
constexpr double kNormalError = 1.4826;  // standard deviation of a normal variable over its
                                         // median deviation
constexpr double kThird = 20.0;          // variance of a third difference of white noise

struct Stretch {
  Eigen::Index begin;
  Eigen::Index end;  // intervals
};

std::vector<Stretch> stretches(Eigen::Index intervals) {
  if (intervals <= kMostIntervals) return {{0, intervals}};
  constexpr Eigen::Index count = kMostIntervals / kStretch;
  std::vector<Stretch> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index begin = (intervals - kStretch) / (count - 1) * i;
    result.push_back({begin, begin + kStretch});
  }
  return result;
}

// Intervals per block, and their neighbours, which the ends of third differences need.
constexpr std::size_t kBlock = 1024;

/// Intervals in which an error of the time stamp shows, and their neighbours.
struct Intervals {
  std::array<double, kBlock + 2> travelled;  ///< in addition to the speed times a wrong time stamp
  std::array<double, kBlock + 2> speed;      ///< size of the third difference
  std::array<double, kBlock + 2> odd;        ///< 1 where the interval is irregular
};

/// Fills `count` third differences, from the second interval on, and the speeds there; NaN where
/// one of three intervals is irregular. Positions begin `kSpeedReach` samples before the first
/// interval.
JOINTID_CLONES void look_at(const double* time, const double* position, double period,
                            double stamped, std::size_t count, Intervals& result, double* rough,
                            double* usual) {
  const double* t = time + kSpeedReach;
  const double* x = position + kSpeedReach;
  for (std::size_t i = 0; i < count + 2; ++i) {
    const double late = t[i + 1] - t[i] - period;
    const double speed = (position[i + kWide] - position[i]) / (time[i + kWide] - time[i]);
    result.travelled[i] = x[i + 1] - x[i] - stamped * speed * late;
    result.speed[i] = std::fabs(speed);
    result.odd[i] = std::fabs(late) < 2.5 * period ? 0.0 : 1.0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double* here = result.travelled.data() + i + 1;
    rough[i] = std::fabs((here[1] - here[0]) - (here[0] - here[-1]));
    const double odd = result.odd[i] + result.odd[i + 1] + result.odd[i + 2];
    usual[i] = odd == 0.0 ? result.speed[i + 1] : std::numeric_limits<double>::quiet_NaN();
  }
}

/// Values of the intervals at a high speed.
struct Fast {
  std::int64_t count;
  std::int64_t rough;  ///< number with a third difference beyond a limit
};

JOINTID_CLONES Fast count_fast(const double* rough, const double* usual, std::size_t count,
                               double fast, double limit) {
  std::int64_t all = 0;
  std::int64_t beyond = 0;
  for (std::size_t i = 0; i < count; ++i) {
    all += usual[i] > fast ? 1 : 0;
    beyond += ((usual[i] > fast) & (rough[i] > limit)) ? 1 : 0;
  }
  return {all, beyond};
}

double median(std::span<const double> values) {
  return base::quantile(values.size(), values.size(), 0.5, [&](std::size_t i, double& out) {
    out = values[i];
    return true;
  });
}

bool median_exceeds(std::span<const double> values, double limit) {
  const auto above = static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [limit](double value) { return value > limit; }));
  const std::size_t below = values.size() - above;
  if (below <= (values.size() - 1) / 2) return true;
  return below <= values.size() / 2 && median(values) > limit;
}

}  // namespace

TimingErrors timing_errors(const Signal& time, const Signal& position, double period,
                           const base::Cancel* cancel) {
  const Eigen::Index intervals = time.size() - 1;
  if (intervals < static_cast<Eigen::Index>(kFewestIntervals)) return {};
  const auto parts = stretches(intervals);
  double smallest = std::numeric_limits<double>::infinity();
  double peak = 0.0;
  smallest = base::least_steps(position.data(), static_cast<std::size_t>(intervals)).positive;
  for (const auto& part : parts) {
    // Third differences need one more interval on either side.
    const Eigen::Index first = part.begin + 1;
    if (part.end - first <= 2 * kSpeedReach) continue;
    peak = std::max(peak, base::largest_rate(time.data() + first, position.data() + first, kWide,
                                             static_cast<std::size_t>(part.end - first) - kWide));
  }
  Intervals seen;
  // Only as many values are written as there are, so the array is not set to zero.
  Eigen::VectorXd rough;
  Eigen::VectorXd usual;
  Eigen::VectorXd chosen;
  std::size_t most = 0;
  for (const auto& part : parts) most += static_cast<std::size_t>(part.end - part.begin);
  /// Values of the chosen intervals, without a branch: each is written, few are kept.
  const auto choose = [&](std::size_t count, auto wanted, auto value) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i) {
      chosen.data()[found] = value(i);
      found += wanted(i) ? 1 : 0;
    }
    return std::span<const double>(chosen.data(), found);
  };
  const auto error_of = [&](double stamped) {
    for (auto* values : {&rough, &usual, &chosen}) values->resize(static_cast<Eigen::Index>(most));
    std::size_t count = 0;
    for (const auto& part : parts) {
      // Third differences need one more interval on either side.
      const Eigen::Index last = part.end - kSpeedReach;
      for (Eigen::Index k = part.begin + kSpeedReach + 1; k < last;) {
        if (cancel != nullptr) cancel->check();
        const auto now = std::min(kBlock, static_cast<std::size_t>(last - k));
        look_at(time.data() + (k - 1 - kSpeedReach), position.data() + (k - 1 - kSpeedReach),
                period, stamped, now, seen, rough.data() + count, usual.data() + count);
        count += now;
        k += static_cast<Eigen::Index>(now);
      }
    }
    const auto change = [&](std::size_t i) { return rough.data()[i]; };
    const auto rate = [&](std::size_t i) { return usual.data()[i]; };
    const auto is_slow = [&](std::size_t i) { return rate(i) < kSlow * peak; };
    const auto is_fast = [&](std::size_t i) { return rate(i) > kFast * peak; };
    const auto still = choose(count, is_slow, change);
    const double limit = 3.0 * (still.size() > kFewestIntervals ? median(still) : 0.0);
    // If the changes are similar, the result does not depend on the speed. Usually counting shows
    // it.
    const auto fast = count_fast(rough.data(), usual.data(), count, kFast * peak, limit);
    if (fast.count < static_cast<std::int64_t>(kFewestIntervals)) return 0.0;
    if (fast.count - fast.rough > fast.count / 2) return 0.0;
    if (!median_exceeds(choose(count, is_fast, change), limit)) return 0.0;
    const auto late = [&](std::size_t i) { return change(i) / rate(i); };
    const double error = kNormalError * median(choose(count, is_fast, late)) / std::sqrt(kThird);
    return median_exceeds(choose(count, is_fast, rate), smallest / error) ? error : 0.0;
  };
  const double stamped = error_of(1.0);
  return {stamped, stamped > 0.0 ? error_of(0.0) : 0.0};
}

}  // namespace jointid::signals
