#include "identify/recording/mask.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "base/input_error.hpp"
#include "base/scans.hpp"

namespace jointid::identify {

namespace {

constexpr double kSlow =
    0.003;  // of the peak speed: a slower motion that lasts long is standing still
constexpr double kShortestStanding = 0.1;  // [s]
constexpr double kStandingOfPeriod =
    0.01;  // a reversal of a slow motion is also slow, so its period counts
constexpr double kJolt =
    0.05;  // of the largest torque: such a step changes the acceleration within a sample
constexpr Eigen::Index kRarest =
    5;  // at most one interval in five is left out because of such steps
constexpr Eigen::Index kReach =
    2;  // intervals left out on either side of a place that is not smooth
constexpr double kFine =
    1e-4;  // of the peak speed: a velocity with finer steps is zero only at rest
constexpr double kStopped =
    0.5;  // of the change of speed per sample: the slowest speed of a stop between two samples
constexpr Eigen::Index kBlock = 64;  // samples that are checked together before one by one
constexpr double kResolved =
    0.005;  // of the peak speed: a motion that is slower than this per quantum seems to stick
constexpr double kHeld = 0.02;  // of the peak speed: a faster velocity is not noise at rest
constexpr double kSteps = 2.0;  // quanta of the position: a longer motion would be visible

/// Marks the samples first..last of each run in which `same(k)` holds for consecutive k, if the run
/// passes `long_enough`.
template <class Same, class LongEnough>
void mark_runs(Eigen::Index count, std::vector<std::uint8_t>& mark, Same same,
               LongEnough long_enough) {
  Eigen::Index first = 0;
  while (first < count) {
    if (!same(first)) {
      ++first;
      continue;
    }
    Eigen::Index last = first;
    while (last + 1 < count && same(last + 1)) ++last;
    if (long_enough(first, last))
      std::fill(mark.begin() + first, mark.begin() + last + 1, std::uint8_t{1});
    first = last + 1;
  }
}

double standing_time(const MotionScale& scale) {
  return std::max(kShortestStanding, kStandingOfPeriod * scale.period);
}

double sticking_time(const MotionScale& scale) {
  return scale.quantum / (kResolved * scale.peak);
}

/// Whether the joint probably stopped next to a sample for less than an interval. It slowed down
/// and sped up again evenly, and was slower there than its acceleration explains.
bool stopped_briefly(const RecordingView& r, Eigen::Index k) {
  const auto v = [&](Eigen::Index i) { return r.velocity[k + i]; };
  const double sign = v(-1) > 0.0 ? 1.0 : -1.0;
  if (!(sign * v(-2) > sign * v(-1) && sign * v(-1) > sign * v(0))) return false;
  const double before = sign * (v(-1) - v(0));
  if (sign * v(0) >= 0.0 && sign * v(1) >= sign * v(0)) {  // continues in the same direction
    const double after = sign * (v(2) - v(1));
    const bool faster = sign * v(2) > sign * v(1) && sign * v(3) > sign * v(2);
    return faster && sign * v(0) < kStopped * std::max(before, after);
  }
  if (sign * v(0) > 0.0 && sign * v(1) <= 0.0) {  // returns
    const double after = sign * (v(1) - v(2));
    const bool faster = sign * v(2) < sign * v(1) && sign * v(3) < sign * v(2);
    return faster && sign * (v(0) - v(1)) < kStopped * std::min(before, after);
  }
  return false;
}

/// Marks the slowest samples of stops of less than an interval or two, which appear in no run.
void mark_brief_stops(const RecordingView& r, const MotionScale& scale,
                      std::vector<std::uint8_t>& standing) {
  if (scale.finest >= kFine * scale.peak) return;  // the steps of an encoder look like stops
  const double slow = kResolved * scale.peak;
  for (Eigen::Index begin = 2; begin + 3 < r.samples(); begin += kBlock) {
    const Eigen::Index end = std::min(begin + kBlock, r.samples() - 3);
    const auto count = static_cast<std::size_t>(end - begin);
    if (base::least_sizes(r.velocity.data() + begin, count).any > slow) continue;
    for (Eigen::Index k = begin; k < end; ++k) {
      if (std::fabs(r.velocity[k]) > slow) continue;
      if (r.velocity[k] == 0.0 || stopped_briefly(r, k)) standing[static_cast<std::size_t>(k)] = 1;
    }
  }
}

void mark_sticking(const RecordingView& r, const MotionScale& scale,
                   const std::vector<std::uint8_t>& after_gap,
                   std::vector<std::uint8_t>& standing) {
  bool any = false;
  const auto unchanged = [&](Eigen::Index k) {  // the interval k-1 -> k, named by its end
    return k > 0 && after_gap[static_cast<std::size_t>(k)] == 0 &&
           r.position[k] == r.position[k - 1];
  };
  const auto n = static_cast<std::size_t>(r.samples());
  // In most recordings no sample repeats the previous one, and none is at rest.
  const Eigen::Index alike =
      base::least_steps(r.position.data(), n - 1).any > 0.0 ? 0 : r.samples();
  // A position that is held while the velocity continues is old: the logger is faster than the bus.
  const auto moves_on = [&](Eigen::Index first, Eigen::Index last) {
    double distance = 0.0;
    for (Eigen::Index k = first; k <= last; ++k)
      distance += 0.5 * (r.velocity[k] + r.velocity[k - 1]) * (r.time[k] - r.time[k - 1]);
    const double slow = kHeld * scale.peak * (r.time[last] - r.time[first - 1]);
    return std::fabs(distance) > std::max(kSteps * scale.quantum, slow);
  };
  mark_runs(alike, standing, unchanged, [&](Eigen::Index first, Eigen::Index last) {
    const bool stuck = last - first >= 2 &&
                       r.time[last] - r.time[first - 1] >= sticking_time(scale) &&
                       !moves_on(first, last);
    any = any || stuck;
    return stuck;
  });
  for (Eigen::Index k = r.samples() - 1; any && k > 0;
       --k) {  // a run's first sample is the start of its first interval
    if (standing[static_cast<std::size_t>(k)] != 0 && unchanged(k))
      standing[static_cast<std::size_t>(k - 1)] = 1;
  }
  if (scale.finest < kResolved * scale.peak &&
      !(base::least_sizes(r.velocity.data(), n).any > 0.0)) {
    mark_runs(
        r.samples(), standing, [&](Eigen::Index k) { return r.velocity[k] == 0.0; },
        [](Eigen::Index first, Eigen::Index last) { return last > first; });
  }
  mark_brief_stops(r, scale, standing);
}

/// Twice the duration over the number of direction changes: an estimate of the motion's
/// period.
double motion_period(const RecordingView& r, double reach) {
  const double hysteresis = 0.01 * reach;
  int changes = 0;
  int direction = 0;  // unknown before the first clear motion
  double extreme = r.position[0];
  for (Eigen::Index k = 1; k < r.samples(); ++k) {
    const double beyond = r.position[k] - extreme;
    const bool turned = direction == 0 || beyond * direction < 0.0;
    if (turned && std::fabs(beyond) <= hysteresis) continue;
    if (turned) {
      changes += direction != 0 ? 1 : 0;
      direction = beyond > 0.0 ? 1 : -1;
    }
    extreme = r.position[k];
  }
  return 2.0 * (r.time[r.samples() - 1] - r.time[0]) / std::max(1, changes);
}

/// Samples begin .. end - 1 near which the joint may have stood still.
struct Region {
  Eigen::Index begin;
  Eigen::Index end;
};

/// A stretch of `span` that stays within `reach` contains a whole block that does so (or a very
/// long one). It extends at most into the neighbours of such blocks.
std::vector<Region> quiet_regions(const RecordingView& r, double span, double reach) {
  const Eigen::Index n = r.samples();
  const double usual = (r.time[n - 1] - r.time[0]) / static_cast<double>(n - 1);
  const auto length =
      static_cast<Eigen::Index>(std::clamp(0.25 * span / usual, 4.0, static_cast<double>(n)));
  std::vector<Region> regions;
  for (Eigen::Index begin = 0; begin < n; begin += length) {
    const Eigen::Index end = std::min(n, begin + length);
    const auto [low, high] =
        base::range_of(r.position.data() + begin, static_cast<std::size_t>(end - begin));
    const double lasting =
        r.time[std::min(n - 1, end)] - r.time[std::max<Eigen::Index>(0, begin - 1)];
    if (high - low > reach && lasting < 0.5 * span) continue;
    const Region region{std::max<Eigen::Index>(0, begin - length), std::min(n, end + length)};
    if (!regions.empty() && regions.back().end >= region.begin) {
      regions.back().end = region.end;
    } else {
      regions.push_back(region);
    }
  }
  return regions;
}

void mark_standing(const RecordingView& r, const MotionScale& scale,
                   const std::vector<std::uint8_t>& after_gap,
                   std::vector<std::uint8_t>& standing) {
  const double span = standing_time(scale);
  const double reach = kSlow * scale.peak * span;
  std::deque<Eigen::Index> highest;
  std::deque<Eigen::Index> lowest;
  for (const auto& region : quiet_regions(r, span, reach)) {
    Eigen::Index first = region.begin;
    Eigen::Index marked = region.begin;  // samples before this one are decided
    highest.clear();
    lowest.clear();
    for (Eigen::Index k = region.begin; k < region.end; ++k) {
      if (after_gap[static_cast<std::size_t>(k)] != 0) {  // the motion during the gap is unknown
        first = k;
        highest.clear();
        lowest.clear();
      }
      while (!highest.empty() && r.position[highest.back()] <= r.position[k]) highest.pop_back();
      while (!lowest.empty() && r.position[lowest.back()] >= r.position[k]) lowest.pop_back();
      highest.push_back(k);
      lowest.push_back(k);
      // The longest stretch ending at k that stays within reach. The joint stood still if it lasts
      // long enough.
      while (r.position[highest.front()] - r.position[lowest.front()] > reach) {
        ++first;
        if (highest.front() < first) highest.pop_front();
        if (lowest.front() < first) lowest.pop_front();
      }
      if (r.time[k] - r.time[first] >= span) {
        // Only the part that is as slow as `span` requires: the last span, and the part joined to
        // it.
        Eigen::Index from = k;
        while (from > first && from > marked && r.time[k] - r.time[from - 1] <= span) --from;
        std::fill(standing.begin() + from, standing.begin() + k + 1, std::uint8_t{1});
        marked = k + 1;
      }
    }
  }
}

/// Intervals that begin or end below the recording's least speed.
void mark_slow(const RecordingView& r, std::vector<std::uint8_t>& usable) {
  for (Eigen::Index k = 0; k + 1 < r.samples(); ++k) {
    const double slowest = std::min(std::fabs(r.velocity[k]), std::fabs(r.velocity[k + 1]));
    if (slowest < r.min_speed) usable[static_cast<std::size_t>(k)] = 0;
  }
}

/// Reversals at which a held command jumps. The joint reverses, sticks or breaks loose at an
/// unknown time between samples. The error is friction times a sample period.
void mark_jolts(const RecordingView& r, const MotionScale& scale,
                std::vector<std::uint8_t>& usable) {
  const double least = kJolt * scale.push;
  const Eigen::Index n = r.samples();
  const auto jumps = [&](Eigen::Index k) {
    const Eigen::Index from = std::max<Eigen::Index>(0, k - kReach);
    const Eigen::Index to = std::min(n - 2, k + kReach);
    for (Eigen::Index j = from; j <= to; ++j) {
      if (std::fabs(r.torque[j + 1] - r.torque[j]) > least) return true;
    }
    return false;
  };
  std::vector<Eigen::Index> turns;
  for (Eigen::Index begin = 0; begin + 1 < n; begin += kBlock) {
    const Eigen::Index end = std::min(begin + kBlock, n - 1);
    const auto [low, high] =
        base::range_of(r.velocity.data() + begin, static_cast<std::size_t>(end - begin) + 1);
    if (low > 0.0 || high < 0.0) continue;
    for (Eigen::Index k = begin; k < end; ++k) {
      const double here = r.velocity[k];
      const double next = r.velocity[k + 1];
      const bool turning = (here > 0.0 && next <= 0.0) || (here < 0.0 && next >= 0.0) ||
                           (here == 0.0 && next != 0.0);
      if (turning && jumps(k)) turns.push_back(k);
    }
  }
  // With few samples per reversal the command jumps at every reversal: a bias is better than no
  // data.
  constexpr Eigen::Index width = 2 * kReach + 1;
  if (kRarest * width * static_cast<Eigen::Index>(turns.size()) > n) return;
  for (const auto k : turns) {
    const auto from = std::max<Eigen::Index>(0, k - kReach);
    const auto to = std::min(n - 2, k + kReach);
    std::fill(usable.begin() + from, usable.begin() + to + 1, std::uint8_t{0});
  }
}

}  // namespace

double MotionScale::memory() const {
  const double sticking = sticking_time(*this);
  return std::isfinite(sticking) ? std::max(standing_time(*this), sticking) : standing_time(*this);
}

MotionScale motion_scale(const RecordingView& r) {
  MotionScale scale;
  const auto n = static_cast<std::size_t>(r.samples());
  const auto largest = [n](const RecordingView::Signal& signal) {
    const auto [low, high] = base::range_of(signal.data(), n);
    return std::max(std::fabs(low), std::fabs(high));
  };
  const auto [low, high] = base::range_of(r.position.data(), n);
  scale.peak = largest(r.velocity);
  scale.travel = high - low;
  scale.period = motion_period(r, scale.travel);
  scale.push = largest(r.torque);
  scale.quantum = base::least_steps(r.position.data(), n - 1).positive;
  scale.finest = base::least_sizes(r.velocity.data(), n).positive;
  return scale;
}

UsableIntervals usable_intervals(const RecordingView& r, bool mask_standstill,
                                 const base::Cancel* cancel) {
  const MotionScale scale = motion_scale(r);
  if (!scale.moves()) {
    throw base::InputError("the joint never moves: there is no friction to identify");
  }
  return usable_intervals(r, scale, mask_standstill, cancel);
}

UsableIntervals usable_intervals(const RecordingView& r, const MotionScale& scale,
                                 bool mask_standstill, const base::Cancel* cancel) {
  if (cancel != nullptr) cancel->check();
  const auto n = static_cast<std::size_t>(r.samples());
  UsableIntervals result{std::vector<std::uint8_t>(n - 1, 1), 0};
  if (mask_standstill) {
    std::vector<std::uint8_t> standing(n, 0);
    std::vector<std::uint8_t> after_gap(n, 0);
    for (const auto gap : r.gap_after) after_gap[static_cast<std::size_t>(gap) + 1] = 1;
    mark_sticking(r, scale, after_gap, standing);
    if (cancel != nullptr) cancel->check();
    mark_standing(r, scale, after_gap, standing);
    if (cancel != nullptr) cancel->check();
    result.standing = std::count(standing.begin(), standing.end(), std::uint8_t{1});
    // The interval that touches a stuck sample contains a break-away or a stop. In the interval
    // next to it, a derived velocity still includes the stop, and friction changes too fast for the
    // trapezoidal rule.
    constexpr auto reach = static_cast<std::size_t>(kReach);
    for (std::size_t k = 0; result.standing > 0 && k < n; ++k) {
      if (standing[k] == 0) continue;
      const std::size_t from = k >= reach ? k - reach : 0;
      const std::size_t to = std::min(n - 1, k + reach);
      std::fill(result.usable.begin() + static_cast<std::ptrdiff_t>(from),
                result.usable.begin() + static_cast<std::ptrdiff_t>(to), std::uint8_t{0});
    }
  }
  if (mask_standstill && r.torque_hold == Hold::zero_order) mark_jolts(r, scale, result.usable);
  if (r.min_speed > 0.0) mark_slow(r, result.usable);
  for (const auto gap : r.gap_after) result.usable[static_cast<std::size_t>(gap)] = 0;
  for (const auto interval : r.doubtful) result.usable[static_cast<std::size_t>(interval)] = 0;
  return result;
}

}  // namespace jointid::identify
