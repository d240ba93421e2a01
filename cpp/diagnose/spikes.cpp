#include "diagnose/spikes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/quantile.hpp"
#include "base/scans.hpp"

namespace jointid::diagnose {

namespace {

constexpr double kSpike = 25.0;         // usual changes over the spike's width
constexpr double kPositionSpike = 8.0;  // usual changes
constexpr double kOfRange = 0.1;        // of the range that holds 95 % of the samples
constexpr double kOfCommand = 0.6;
constexpr double kAtTurn = 1.2;     // of the range, where the joint reverses or sticks
constexpr double kSlow = 0.05;      // of the peak speed: friction falls, and may drop abruptly
constexpr Eigen::Index kReach = 6;  // samples: time resolution of a reversal in a derived velocity
constexpr double kJump = 4.0;       // times the rate that 1 % of the intervals exceed
constexpr double kClearly = 1e-12;  // margin, so that rounding never decides

/// Counts changes over `width` samples that are not zero, and changes of at least `enough`.
JOINTID_CLONES void count_changes(const double* x, std::size_t width, std::size_t changes,
                                  double enough, std::int64_t* positive, std::int64_t* beyond) {
  using base::Four;
  Four none{};
  Four large{};
  Four limit;
  base::fill(limit, enough);
  std::size_t k = 0;
  for (; k + base::kFour <= changes; k += base::kFour) {
    Four size;
    Four before;
    base::load(size, x + k + width);
    base::load(before, x + k);
    base::subtract(size, before);
    base::take_size(size);
    base::count_not_below(Four{}, size, none);
    base::count_not_below(size, limit, large);
  }
  auto some = static_cast<std::int64_t>(k) - static_cast<std::int64_t>(base::sum_of(none));
  auto many = static_cast<std::int64_t>(base::sum_of(large));
  for (; k < changes; ++k) {
    const double size = std::fabs(x[k + width] - x[k]);
    some += size > 0.0 ? 1 : 0;
    many += size >= enough ? 1 : 0;
  }
  *positive = some;
  *beyond = many;
}

/// Number of intervals with a rate below `enough`.
JOINTID_CLONES std::int64_t count_slower(const double* time, const double* x, std::size_t intervals,
                                         double enough) {
  std::int64_t below = 0;
  for (std::size_t k = 0; k < intervals; ++k) {
    below += std::fabs((x[k + 1] - x[k]) / (time[k + 1] - time[k])) < enough ? 1 : 0;
  }
  return below;
}

template <class Value>
std::int64_t first_at(Eigen::Index count, double wanted, Value value) {
  for (Eigen::Index k = 0; k < count; ++k) {
    if (value(k) == wanted) return k;
  }
  return 0;
}

double spread(const Signal& signal, const base::Cancel* cancel) {
  const auto count = static_cast<std::size_t>(signal.size());
  const auto value = [&](std::size_t k, double& out) {
    out = signal[static_cast<Eigen::Index>(k)];
    return true;
  };
  return base::quantile(count, count, 0.975, value, cancel) -
         base::quantile(count, count, 0.025, value, cancel);
}

/// Whether the joint reverses, sticks or moves slowly within a few samples of begin .. end. The
/// samples between are ignored, because the velocity itself may have the spike.
bool turns(const Signal& velocity, double peak_speed, Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index from = std::max<Eigen::Index>(0, begin - kReach);
  const Eigen::Index to = std::min(velocity.size() - 1, end + kReach);
  const double slow = kSlow * peak_speed;
  const bool forward = velocity[from] > 0.0;
  for (Eigen::Index k = from; k <= to; ++k) {
    if (k > begin && k < end) continue;
    if (std::fabs(velocity[k]) <= slow || (velocity[k] > 0.0) != forward) return true;
  }
  return false;
}

}  // namespace

Spike largest_spike(const Signal& signal, SpikeRule rule, const Signal& velocity, double peak_speed,
                    const base::Cancel* cancel) {
  const double share = rule == SpikeRule::command ? kOfCommand : kOfRange;
  const double times = rule == SpikeRule::position ? kPositionSpike : kSpike;
  double range = -1.0;  // not known yet
  for (const Eigen::Index width : {1, 3}) {
    if (width > 1 && rule == SpikeRule::command) break;
    const Eigen::Index changes = signal.size() - width;
    const Eigen::Index places = changes - width;
    if (places <= 0) break;
    const auto size = [&](Eigen::Index k) { return std::fabs(signal[k + width] - signal[k]); };
    const auto height = [&](Eigen::Index k) {
      const double there = signal[k + width] - signal[k];
      const double back = signal[k + width] - signal[k + 2 * width];
      const double low = std::min(std::fabs(there), std::fabs(back));
      return there * back > 0.0 ? low : 0.0;
    };
    if (cancel != nullptr) cancel->check();
    const double highest = base::largest_height(signal.data(), static_cast<std::size_t>(width),
                                                static_cast<std::size_t>(places));
    if (highest == 0.0) continue;
    // If more than half of the changes are beyond this, so is the median, and the limit is above
    // `highest`.
    const double enough = highest / times * (1.0 + kClearly);
    std::int64_t positive = 0;
    std::int64_t beyond = 0;
    count_changes(signal.data(), static_cast<std::size_t>(width), static_cast<std::size_t>(changes),
                  enough, &positive, &beyond);
    if (2 * beyond > positive + 1) continue;
    if (rule != SpikeRule::position) {
      if (range < 0.0) range = spread(signal, cancel);
      if (highest <= share * std::sqrt(static_cast<double>(width)) * range) continue;
    }
    const double usual = base::quantile(
        static_cast<std::size_t>(changes), static_cast<std::size_t>(positive), 0.5,
        [&](std::size_t k, double& out) {
          out = size(static_cast<Eigen::Index>(k));
          return out > 0.0;
        },
        cancel);
    const double limit =
        rule == SpikeRule::position
            ? times * usual
            : std::max(times * usual, share * std::sqrt(static_cast<double>(width)) * range);
    const double at_turn = kAtTurn * range;
    // Friction steps at a reversal, and torque and sensor step with it. A velocity has no reason to
    // step.
    const bool may_step = rule != SpikeRule::position && signal.data() != velocity.data();
    Spike found;
    for (Eigen::Index k = 0; k < places; ++k) {
      const double here = height(k);
      if (!(here > limit)) continue;
      if (may_step && here <= at_turn && turns(velocity, peak_speed, k, k + 2 * width)) {
        continue;
      }
      ++found.count;
      if (here > found.height) {
        found.height = here;
        found.index = k + width;
      }
    }
    if (found.count == 0) continue;
    found.count = (found.count + width - 1) / width;
    return found;
  }
  return {};
}

std::int64_t largest_jump(const Signal& time, const Signal& position, const base::Cancel* cancel) {
  const Eigen::Index count = position.size() - 1;
  const auto rate = [&](Eigen::Index k) {
    return std::fabs((position[k + 1] - position[k]) / (time[k + 1] - time[k]));
  };
  const auto intervals = static_cast<std::size_t>(std::max<Eigen::Index>(0, count));
  const double highest = base::largest_rate(time.data(), position.data(), 1, intervals);
  if (cancel != nullptr) cancel->check();
  const double enough = highest / kJump * (1.0 + kClearly);
  const std::int64_t below = count_slower(time.data(), position.data(), intervals, enough);
  constexpr double kMost = 0.99;
  if (static_cast<double>(below) <= std::floor(kMost * static_cast<double>(count - 1))) return -1;
  const double usual = base::quantile(
      static_cast<std::size_t>(count), static_cast<std::size_t>(count), kMost,
      [&](std::size_t k, double& out) {
        out = rate(static_cast<Eigen::Index>(k));
        return true;
      },
      cancel);
  const std::int64_t index = first_at(count, highest, rate);
  if (highest < kJump * usual || index == 0 || index >= count - 1) return -1;
  // A spike returns; a jump stays.
  const auto step = [&](Eigen::Index k) { return std::fabs(position[k + 1] - position[k]); };
  const double beside = std::max(step(index - 1), step(index + 1));
  double finest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 0; k < count; ++k) {
    if (step(k) > 0.0) finest = std::min(finest, step(k));
  }
  const double half = 0.5 * step(index);
  return beside < half && half > 4.0 * finest ? index : -1;
}

}  // namespace jointid::diagnose
