#include "diagnose/signal_facts.hpp"

#include <algorithm>
#include <cmath>

#include "base/clones.hpp"
#include "base/four.hpp"
#include "base/quantile.hpp"
#include "base/scans.hpp"

namespace jointid::diagnose {

namespace {

constexpr double kFine = 30.0;    // usual step over the smallest step
constexpr double kMoving = 0.1;   // of the peak speed
constexpr double kStill = 0.005;  // of the peak speed
constexpr double kNear = 0.01;    // of the range
constexpr double kFrozen = 0.1;   // [s]
constexpr std::size_t kBlock = 65536;
constexpr std::size_t kFew = 32;  // samples per block

void look(const base::Cancel* cancel) {
  if (cancel != nullptr) cancel->check();
}

/// Whether the median of the positive steps is at least `kFine` times the smallest. Counting
/// decides, unless the two middle steps lie on either side.
bool is_fine(const Signal& signal, double smallest, std::int64_t changes, std::int64_t large,
             const base::Cancel* cancel) {
  if (changes == 0) return false;
  const std::int64_t small = changes - large;
  if (small <= (changes - 1) / 2) return true;
  if (small > changes / 2) return false;
  const double median = base::quantile(
      static_cast<std::size_t>(signal.size() - 1), static_cast<std::size_t>(changes), 0.5,
      [&](std::size_t k, double& step) {
        const auto i = static_cast<Eigen::Index>(k);
        step = std::fabs(signal[i + 1] - signal[i]);
        return step > 0.0;
      },
      cancel);
  return median / smallest >= kFine;
}

struct Rules {
  double lowest;
  double highest;
  double close;
  double smallest;
  double fair;  ///< speed
};

using base::Four;
using base::kFour;

struct Seen {
  std::int64_t large;   ///< steps
  std::int64_t moving;  ///< intervals
  std::int64_t odd;     ///< samples near a limit, or equal to the next one
};

/// Counts over `count` samples; the sample after them is part of the steps.
JOINTID_CLONES Seen look_at(const double* x, const double* v, std::size_t count,
                            const Rules& rules) {
  Four fine;
  Four fair;
  Four close;
  Four lowest;
  Four highest;
  Four smallest;
  Four nowhere;
  base::fill(fine, std::nextafter(kFine, 0.0));
  base::fill(fair, rules.fair);
  base::fill(close, rules.close);
  base::fill(lowest, rules.lowest);
  base::fill(highest, rules.highest);
  base::fill(smallest, rules.smallest);
  base::fill(nowhere, -1.0);  // 1 where the next sample is the same
  Four small{};
  Four slow{};
  Four strange{};
  std::size_t i = 0;
  for (; i + kFour <= count; i += kFour) {
    Four here;
    Four step;
    base::load(here, x + i);
    base::load(step, x + i + 1);
    base::subtract(step, here);
    base::take_size(step);
    base::count_not_below(fine, step / smallest, small);
    Four speed;
    Four next;
    base::load(speed, v + i);
    base::load(next, v + i + 1);
    base::take_size(speed);
    base::take_size(next);
    base::lower(speed, next);
    base::count_not_below(fair, speed, slow);
    Four near = here - lowest;
    base::lower(near, highest - here);
    base::choose(Four{}, step, near, nowhere, near);
    base::count_not_below(close, near, strange);
  }
  const auto number = [](const Four& four) {
    return static_cast<std::int64_t>(base::sum_of(four));
  };
  const auto looked_at = static_cast<std::int64_t>(i);
  std::int64_t large = looked_at - number(small);
  std::int64_t moving = looked_at - number(slow);
  std::int64_t odd = number(strange);
  for (; i < count; ++i) {
    const double step = std::fabs(x[i + 1] - x[i]);
    const double near = std::min(x[i] - rules.lowest, rules.highest - x[i]);
    large += step / rules.smallest >= kFine ? 1 : 0;
    moving += std::min(std::fabs(v[i]), std::fabs(v[i + 1])) > rules.fair ? 1 : 0;
    odd += step == 0.0 || near <= rules.close ? 1 : 0;
  }
  return {large, moving, odd};
}

}  // namespace

Extremes extremes(const Signal& signal) {
  const auto [low, high] = base::range_of(signal.data(), static_cast<std::size_t>(signal.size()));
  return {low, high};
}

SignalFacts inspect_signal(const Signal& signal, const Signal& velocity, double peak_speed,
                           double period, const base::Cancel* cancel) {
  SignalFacts facts;
  const Eigen::Index n = signal.size();
  const double* x = signal.data();
  const double* v = velocity.data();
  const auto steps = static_cast<std::size_t>(n - 1);
  const auto survey = base::survey(x, steps);
  look(cancel);
  facts.range = {survey.range.low, survey.range.high};
  facts.smallest = survey.smallest;
  facts.changes = survey.changes;
  const double lowest = facts.range.lowest;  // clang 14 captures no structured bindings
  const double highest = facts.range.highest;
  const Rules rules{lowest, highest, kNear * (highest - lowest), facts.smallest,
                    kMoving * peak_speed};
  const double slow = kStill * peak_speed;
  std::int64_t large = 0;
  std::int64_t run = 0;
  const auto finish_run = [&] {
    if (static_cast<double>(run) * period > kFrozen && run > 10) facts.frozen += run;
    run = 0;
  };
  // Few samples are near a limit or repeat the previous one. Only blocks with such samples are
  // examined sample by sample.
  const auto limits = [&](Eigen::Index k) {
    const double value = x[k];
    if (value - lowest <= rules.close) {
      ++facts.lower.near;
      facts.lower.there += value == lowest ? 1 : 0;
      facts.lower.moving += value == lowest && std::fabs(v[k]) > slow ? 1 : 0;
    }
    if (highest - value <= rules.close) {
      ++facts.upper.near;
      facts.upper.there += value == highest ? 1 : 0;
      facts.upper.moving += value == highest && std::fabs(v[k]) > slow ? 1 : 0;
    }
  };
  const auto repeats = [&](Eigen::Index k) {
    const bool moving = std::min(std::fabs(v[k]), std::fabs(v[k + 1])) > rules.fair;
    if (x[k + 1] == x[k] && moving && x[k] > lowest && x[k] < highest) {
      ++facts.stale;
      ++run;
    } else if (run > 0) {
      finish_run();
    }
  };
  for (std::size_t begin = 0; begin < steps; begin += kFew) {
    if (begin % kBlock == 0) look(cancel);
    const std::size_t count = std::min(kFew, steps - begin);
    const Seen seen = look_at(x + begin, v + begin, count, rules);
    large += seen.large;
    facts.moving += seen.moving;
    if (seen.odd == 0) {
      if (run > 0) finish_run();
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto k = static_cast<Eigen::Index>(begin + i);
      limits(k);
      repeats(k);
    }
  }
  limits(n - 1);
  finish_run();
  facts.fine = is_fine(signal, facts.smallest, facts.changes, large, cancel);
  return facts;
}

}  // namespace jointid::diagnose
