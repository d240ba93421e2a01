#include "diagnose/signal_facts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/quantile.hpp"

namespace jointid::diagnose {

namespace {

constexpr double kFine = 30.0;    // a usual step in smallest steps
constexpr double kMoving = 0.1;   // of the peak speed
constexpr double kStill = 0.005;  // of the peak speed
constexpr double kNear = 0.01;    // of the range
constexpr double kFrozen = 0.1;   // [s]
constexpr Eigen::Index kBlock = 65536;

void look(const base::Cancel* cancel) {
  if (cancel != nullptr) cancel->check();
}

/// Whether the median of the positive steps is at least `kFine` times the smallest: counting tells,
/// unless the two middle ones lie on either side.
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

}  // namespace

Extremes extremes(const Signal& signal) {
  std::array<double, 4> low;
  std::array<double, 4> high;
  low.fill(signal[0]);
  high.fill(signal[0]);
  Eigen::Index k = 0;
  for (; k + 4 <= signal.size(); k += 4) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double value = signal[k + static_cast<Eigen::Index>(j)];
      low[j] = value < low[j] ? value : low[j];
      high[j] = value > high[j] ? value : high[j];
    }
  }
  for (; k < signal.size(); ++k) {
    low[0] = std::min(low[0], signal[k]);
    high[0] = std::max(high[0], signal[k]);
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

SignalFacts inspect_signal(const Signal& signal, const Signal& velocity, double peak_speed,
                           double period, const base::Cancel* cancel) {
  SignalFacts facts;
  facts.range = extremes(signal);
  look(cancel);
  const Eigen::Index n = signal.size();
  double smallest = std::numeric_limits<double>::infinity();
  for (Eigen::Index k = 1; k < n; ++k) {
    const double step = std::fabs(signal[k] - signal[k - 1]);
    facts.changes += step > 0.0 ? 1 : 0;
    smallest = step > 0.0 && step < smallest ? step : smallest;
  }
  facts.smallest = smallest;
  const auto [lowest, highest] = facts.range;
  const double close = kNear * (highest - lowest);
  const double fair = kMoving * peak_speed;
  const double slow = kStill * peak_speed;
  std::int64_t large = 0;
  std::int64_t run = 0;
  const auto finish_run = [&] {
    if (static_cast<double>(run) * period > kFrozen && run > 10) facts.frozen += run;
    run = 0;
  };
  // Few samples are near a limit or repeat the one before: what concerns those is asked of them.
  for (Eigen::Index begin = 0; begin < n; begin += kBlock) {
    look(cancel);
    const Eigen::Index end = std::min(n, begin + kBlock);
    for (Eigen::Index k = begin; k < end; ++k) {
      const double value = signal[k];
      if (value - lowest <= close) {
        ++facts.lower.near;
        facts.lower.there += value == lowest ? 1 : 0;
        facts.lower.moving += value == lowest && std::fabs(velocity[k]) > slow ? 1 : 0;
      }
      if (highest - value <= close) {
        ++facts.upper.near;
        facts.upper.there += value == highest ? 1 : 0;
        facts.upper.moving += value == highest && std::fabs(velocity[k]) > slow ? 1 : 0;
      }
      if (k + 1 == n) break;
      const double step = std::fabs(signal[k + 1] - value);
      large += step > 0.0 && step / smallest >= kFine ? 1 : 0;
      const bool moving = std::min(std::fabs(velocity[k]), std::fabs(velocity[k + 1])) > fair;
      facts.moving += moving ? 1 : 0;
      if (step == 0.0 && moving && value > lowest && value < highest) {
        ++facts.stale;
        ++run;
      } else if (run > 0) {
        finish_run();
      }
    }
  }
  finish_run();
  facts.fine = is_fine(signal, smallest, facts.changes, large, cancel);
  return facts;
}

}  // namespace jointid::diagnose
