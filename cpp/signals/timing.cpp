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

constexpr Eigen::Index kReach = 4;  // samples either side over which the speed is taken
constexpr auto kWide = static_cast<std::size_t>(2 * kReach);
constexpr Eigen::Index kStretch = 4096;  // samples
constexpr Eigen::Index kMost = 1 << 18;  // samples looked at
constexpr std::size_t kFewest = 40;
constexpr double kFast = 0.3;  // of the peak speed
constexpr double kSlow = 0.1;
constexpr double kNormal = 1.4826;  // standard deviation of a normal variable over its
                                    // median deviation
constexpr double kThird = 20.0;     // variance of a third difference of white noise

struct Stretch {
  Eigen::Index begin;
  Eigen::Index end;  // intervals
};

std::vector<Stretch> stretches(Eigen::Index intervals) {
  if (intervals <= kMost) return {{0, intervals}};
  constexpr Eigen::Index count = kMost / kStretch;
  std::vector<Stretch> result;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index begin = (intervals - kStretch) / (count - 1) * i;
    result.push_back({begin, begin + kStretch});
  }
  return result;
}

// Intervals looked at together, and their neighbours: those of the third differences' ends.
constexpr std::size_t kBlock = 1024;

/// Of the intervals about which an error of the time stamp shows.
struct Intervals {
  std::array<double, kBlock + 2> travelled;  ///< beside the speed times a wrong stamp
  std::array<double, kBlock + 2> speed;      ///< its size
  std::array<double, kBlock + 2> odd;        ///< 1 where the interval is no ordinary one
  std::array<double, kBlock> rough;          ///< third differences, from the second interval on
  std::array<double, kBlock> usual;          ///< the speed; NaN where one of three is odd
};

/// From `kReach` samples before the first interval on; `count` third differences.
JOINTID_CLONES void look_at(const double* time, const double* position, double period,
                            double stamped, std::size_t count, Intervals& result) {
  const double* t = time + kReach;
  const double* x = position + kReach;
  for (std::size_t i = 0; i < count + 2; ++i) {
    const double late = t[i + 1] - t[i] - period;
    const double speed = (position[i + kWide] - position[i]) / (time[i + kWide] - time[i]);
    result.travelled[i] = x[i + 1] - x[i] - stamped * speed * late;
    result.speed[i] = std::fabs(speed);
    result.odd[i] = std::fabs(late) < 2.5 * period ? 0.0 : 1.0;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double* here = result.travelled.data() + i + 1;
    result.rough[i] = std::fabs((here[1] - here[0]) - (here[0] - here[-1]));
    const double odd = result.odd[i] + result.odd[i + 1] + result.odd[i + 2];
    result.usual[i] = odd == 0.0 ? result.speed[i + 1] : std::numeric_limits<double>::quiet_NaN();
  }
}

JOINTID_CLONES void divide(const double* above, const double* below, std::size_t count,
                           double* result) {
  for (std::size_t i = 0; i < count; ++i) result[i] = above[i] / below[i];
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
  if (intervals < static_cast<Eigen::Index>(kFewest)) return {};
  const auto parts = stretches(intervals);
  double smallest = std::numeric_limits<double>::infinity();
  double peak = 0.0;
  smallest = base::least_steps(position.data(), static_cast<std::size_t>(intervals)).positive;
  for (const auto& part : parts) {
    // Third differences need one interval more on either side.
    const Eigen::Index first = part.begin + 1;
    if (part.end - first <= 2 * kReach) continue;
    peak = std::max(peak, base::largest_rate(time.data() + first, position.data() + first, kWide,
                                             static_cast<std::size_t>(part.end - first) - kWide));
  }
  Intervals seen;
  // Of these only the first `quick`, or `still`, are written: not set to zero before.
  Eigen::VectorXd fast;
  Eigen::VectorXd slow;
  Eigen::VectorXd speeds;
  std::size_t most = 0;
  for (const auto& part : parts) most += static_cast<std::size_t>(part.end - part.begin);
  const auto error_of = [&](double stamped) {
    for (auto* values : {&fast, &slow, &speeds}) values->resize(static_cast<Eigen::Index>(most));
    std::size_t quick = 0;
    std::size_t still = 0;
    for (const auto& part : parts) {
      // Third differences need one interval more on either side.
      const Eigen::Index last = part.end - kReach;
      for (Eigen::Index k = part.begin + kReach + 1; k < last;) {
        if (cancel != nullptr) cancel->check();
        const auto count = std::min(kBlock, static_cast<std::size_t>(last - k));
        look_at(time.data() + (k - 1 - kReach), position.data() + (k - 1 - kReach), period, stamped,
                count, seen);
        for (std::size_t i = 0; i < count; ++i) {  // without a branch: each is written, few kept
          const double now = seen.usual[i];
          fast.data()[quick] = seen.rough[i];
          speeds.data()[quick] = now;
          slow.data()[still] = seen.rough[i];
          quick += now > kFast * peak ? 1 : 0;
          still += now < kSlow * peak ? 1 : 0;
        }
        k += static_cast<Eigen::Index>(count);
      }
    }
    if (quick < kFewest) return 0.0;
    const std::span<const double> changes(fast.data(), quick);
    const std::span<const double> rates(speeds.data(), quick);
    Eigen::VectorXd of_time(static_cast<Eigen::Index>(quick));
    divide(changes.data(), rates.data(), quick, of_time.data());
    const double error = kNormal * median({of_time.data(), quick}) / std::sqrt(kThird);
    // Two of four medians need only be held against a limit, which counting does.
    if (!median_exceeds(rates, smallest / error)) return 0.0;
    const double floor = still > kFewest ? median({slow.data(), still}) : 0.0;
    return median_exceeds(changes, 3.0 * floor) ? error : 0.0;
  };
  const double stamped = error_of(1.0);
  return {stamped, stamped > 0.0 ? error_of(0.0) : 0.0};
}

}  // namespace jointid::signals
