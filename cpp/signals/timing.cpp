#include "signals/timing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/clones.hpp"
#include "base/quantile.hpp"
#include "base/scans.hpp"

namespace jointid::signals {

namespace {

constexpr Eigen::Index kReach = 4;       // samples either side over which the speed is taken
constexpr Eigen::Index kStretch = 4096;  // samples
constexpr Eigen::Index kMost = 1 << 18;  // samples looked at
constexpr std::size_t kFewest = 40;
constexpr std::size_t kLanes = 8;  // samples side by side
constexpr double kFast = 0.3;      // of the peak speed
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

/// Of the speeds over 2 kReach intervals.
JOINTID_CLONES double largest_speed(const double* time, const double* position, std::size_t count) {
  constexpr auto kWide = static_cast<std::size_t>(2 * kReach);
  std::array<double, kLanes> most{};
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const double travel = position[k + l + kWide] - position[k + l];
      const double speed = std::fabs(travel / (time[k + l + kWide] - time[k + l]));
      most[l] = speed > most[l] ? speed : most[l];
    }
  }
  for (; k < count; ++k) {
    const double travel = position[k + kWide] - position[k];
    most[0] = std::max(most[0], std::fabs(travel / (time[k + kWide] - time[k])));
  }
  return *std::max_element(most.begin(), most.end());
}

double median(const std::vector<double>& values) {
  return base::quantile(values.size(), values.size(), 0.5, [&](std::size_t i, double& out) {
    out = values[i];
    return true;
  });
}

bool median_exceeds(const std::vector<double>& values, double limit) {
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
  const auto speed = [&](Eigen::Index k) {  // about interval k
    return (position[k + kReach] - position[k - kReach]) / (time[k + kReach] - time[k - kReach]);
  };
  const auto whole = [&](Eigen::Index k) {
    return std::fabs(time[k + 1] - time[k] - period) < 2.5 * period;
  };
  const auto parts = stretches(intervals);
  double smallest = std::numeric_limits<double>::infinity();
  double peak = 0.0;
  smallest = base::least_steps(position.data(), static_cast<std::size_t>(intervals)).positive;
  for (const auto& part : parts) {
    // Third differences need one interval more on either side.
    const Eigen::Index first = part.begin + 1;
    if (part.end - first <= 2 * kReach) continue;
    peak = std::max(peak, largest_speed(time.data() + first, position.data() + first,
                                        static_cast<std::size_t>(part.end - first - 2 * kReach)));
  }
  std::vector<double> of_time;
  std::vector<double> fast;
  std::vector<double> slow;
  std::vector<double> speeds;
  const auto error_of = [&](double stamped) {
    of_time.clear();
    fast.clear();
    slow.clear();
    speeds.clear();
    for (const auto& part : parts) {
      if (cancel != nullptr) cancel->check();
      const auto travelled = [&](Eigen::Index k) {
        return position[k + 1] - position[k] -
               stamped * speed(k) * (time[k + 1] - time[k] - period);
      };
      const Eigen::Index first = part.begin + kReach;
      if (part.end - first <= kReach) continue;
      double before = travelled(first);
      double here = travelled(first + 1);
      for (Eigen::Index k = first + 1; k + kReach < part.end; ++k) {
        const double after = travelled(k + 1);
        const double rough = std::fabs((after - here) - (here - before));
        before = here;
        here = after;
        if (!(whole(k - 1) && whole(k) && whole(k + 1))) continue;
        const double now = std::fabs(speed(k));
        if (now > kFast * peak) {
          of_time.push_back(rough / now);
          fast.push_back(rough);
          speeds.push_back(now);
        } else if (now < kSlow * peak) {
          slow.push_back(rough);
        }
      }
    }
    if (fast.size() < kFewest) return 0.0;
    const double error = kNormal * median(of_time) / std::sqrt(kThird);
    // Two of four medians need only be held against a limit, which counting does.
    if (!median_exceeds(speeds, smallest / error)) return 0.0;
    const double floor = slow.size() > kFewest ? median(slow) : 0.0;
    return median_exceeds(fast, 3.0 * floor) ? error : 0.0;
  };
  const double stamped = error_of(1.0);
  return {stamped, stamped > 0.0 ? error_of(0.0) : 0.0};
}

}  // namespace jointid::signals
