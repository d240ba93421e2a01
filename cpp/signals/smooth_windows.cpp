#include "signals/smooth_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/four.hpp"

namespace jointid::signals {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::array<std::int64_t, 8> kHalfLengths{6, 8, 11, 15, 20, 28, 40, 56};  // samples
constexpr double kNoiseShare =
    1e-4;  // largest variance of the acceleration's noise over its own variance
constexpr double kOfMedianSize =
    1.4826;                       // standard deviations of normal noise in a median of sizes
constexpr double kFinest = 1e-3;  // of the largest step: a smaller step is rounding, not a counter

/// Raised cosine: zero at both ends.
VectorXd raised_cosine(std::int64_t half) {
  VectorXd weight(2 * half - 1);
  for (std::int64_t k = 1 - half; k < half; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(half);
    weight[k + half - 1] = 1.0 + base::cos(std::numbers::pi * part);
  }
  return weight;
}

VectorXd slope_weight(std::int64_t half, double period) {
  VectorXd weight(2 * half - 1);
  double moment = 0.0;
  for (std::int64_t k = 1 - half; k < half; ++k) {
    const auto place = static_cast<double>(k);
    const double own = base::sin(std::numbers::pi * place / static_cast<double>(half));
    weight[k + half - 1] = own;
    moment += own * place;
  }
  return weight / (moment * period);
}

/// Whether all steps certainly stay on one side of rest.
JOINTID_CLONES bool all_positive(const double* v, std::size_t steps) {
  base::Four least;
  base::fill(least, 1.0);
  std::size_t i = 0;
  for (; i + base::kFour <= steps; i += base::kFour) {
    base::Four before;
    base::Four here;
    base::load(before, v + i);
    base::load(here, v + i + 1);
    base::lower(least, before * here);
  }
  bool positive = base::least_of(least) > 0.0;
  for (; i < steps; ++i) positive &= v[i] * v[i + 1] > 0.0;
  return positive;
}

/// The first sample from `from` on with another direction of motion than the sample before; the
/// number of samples if there is none. Rest counts as a direction of its own.
Index next_turn(const Signal& velocity, Index from) {
  constexpr Index kBlock = 64;
  const double* v = velocity.data();
  while (from < velocity.size()) {
    const Index end = std::min(from + kBlock, velocity.size());
    if (!all_positive(v + from - 1, static_cast<std::size_t>(end - from))) {
      for (Index i = from; i < end; ++i) {
        if ((v[i] > 0.0) != (v[i - 1] > 0.0) || (v[i] < 0.0) != (v[i - 1] < 0.0)) return i;
      }
    }
    from = end;
  }
  return velocity.size();
}

/// The first unusable sample from `from` on; `count` if there is none.
Index next_unusable(const EvenStretch& stretch, Index from) {
  static_assert(sizeof(bool) == 1);
  const Index count = stretch.time.size();
  if (from >= count) return count;
  const void* found = std::memchr(stretch.usable + from, 0, static_cast<std::size_t>(count - from));
  return found == nullptr ? count : static_cast<const bool*>(found) - stretch.usable;
}

/// Sizes of every third of a signal's third differences; few of them are large.
VectorXd third_differences(const Signal& signal) {
  VectorXd sizes((signal.size() - 1) / 3);
  for (Index i = 0; i < sizes.size(); ++i) {
    const double* x = signal.data() + 3 * i;
    const double change = x[2] - x[1];
    sizes[i] = std::fabs(((x[3] - x[2]) - change) - (change - (x[1] - x[0])));
  }
  return sizes;
}

/// Whether more than half of the sizes are at most this limit. Then their median is, too.
JOINTID_CLONES bool mostly_below(const double* sizes, std::size_t count, double limit) {
  double below = 0.0;
  std::array<double, 8> some{};
  std::size_t i = 0;
  for (; i + some.size() <= count; i += some.size()) {
    for (std::size_t l = 0; l < some.size(); ++l) some[l] += sizes[i + l] <= limit ? 1.0 : 0.0;
  }
  for (; i < count; ++i) below += sizes[i] <= limit ? 1.0 : 0.0;
  for (const double each : some) below += each;
  return 2.0 * below > static_cast<double>(count);
}

/// The smallest step of a signal that has steps, such as a counter; 0 for other signals.
double counted_step(const Signal& signal) {
  double largest = 0.0;
  double smallest = std::numeric_limits<double>::infinity();
  for (Index i = 1; i < signal.size(); ++i) {
    const double step = std::fabs(signal[i] - signal[i - 1]);
    largest = std::max(largest, step);
    smallest = step > 0.0 ? std::min(smallest, step) : smallest;
  }
  return kFinest * largest < smallest && std::isfinite(smallest) ? smallest : 0.0;
}

JOINTID_CLONES double make_even(const double* time, std::size_t count, double step, double* grid) {
  base::Four most{};
  const base::Four places{0.0, 1.0, 2.0, 3.0};
  std::size_t i = 0;
  for (; i + base::kFour <= count; i += base::kFour) {
    base::Four place;
    base::Four start;
    base::Four own;
    base::fill(place, static_cast<double>(i));
    base::fill(start, time[0]);
    base::load(own, time + i);
    const base::Four even = (place + places) * step + start;
    base::store(grid + i, even);
    base::Four apart = even - own;
    base::take_size(apart);
    base::raise(most, apart);
  }
  double result = base::most_of(most);
  for (; i < count; ++i) {
    grid[i] = static_cast<double>(i) * step + time[0];
    result = std::max(result, std::fabs(grid[i] - time[i]));
  }
  return result;
}

double variance(const VectorXd& values) {
  return (values.array() - values.mean()).square().mean();
}

}  // namespace

EvenGrid even_grid(const Signal& time) {
  EvenGrid result{VectorXd(time.size()), 0.0};
  const Index last = time.size() - 1;
  const double step = (time[last] - time[0]) / static_cast<double>(last);
  result.apart =
      make_even(time.data(), static_cast<std::size_t>(time.size()), step, result.time.data());
  result.time[last] = time[last];
  return result;
}

SmoothWindows smooth_windows(const EvenStretch& stretch, const WindowRules& rules) {
  const Index count = stretch.time.size();
  const Index reach = rules.half + rules.margin + 2;
  if (rules.half < 1 || rules.half > kLongestHalf || rules.margin < kLeastMargin ||
      rules.clear > reach || count < 2) {
    throw std::invalid_argument("a window could reach beyond its stretch");
  }
  SmoothWindows result;
  result.weight = raised_cosine(rules.half);
  result.weight /= result.weight.sum();
  result.slope = slope_weight(rules.half, stretch.period());
  const Index windows = count > 2 * reach ? (count - 2 * reach - 1) / rules.half + 1 : 0;
  result.used.reserve(static_cast<std::size_t>(windows));
  Index unusable = 0;
  Index turn = 0;
  for (Index i = 0; i < windows; ++i) {
    const Index middle = reach + i * rules.half;
    if (rules.usable_only) {
      const Index from = middle - rules.half;
      if (unusable < from || i == 0) unusable = next_unusable(stretch, from);
      if (unusable < middle + rules.half) continue;
    }
    if (rules.clear > 0) {
      const Index from = middle - rules.clear + 1;
      if (turn < from) turn = next_turn(stretch.velocity, from);
      if (turn <= middle + rules.clear) continue;
    }
    result.used.push_back(middle);
  }
  const auto used = static_cast<Index>(result.used.size());
  result.between = VectorXd::Zero(used);
  const double factor = 1.0 / (2.0 * static_cast<double>(rules.half) * stretch.period());
  for (Index i = 1; i + 1 < used; ++i) {
    const std::int64_t* middle = result.used.data() + i;
    if (middle[1] - middle[-1] == 2 * rules.half) result.between[i] = factor;
  }
  return result;
}

VectorXd curvature_weight(std::int64_t half, double period) {
  const VectorXd weight = raised_cosine(half);
  VectorXd wide = VectorXd::Zero(weight.size() + 4);
  wide.segment(2, weight.size()) = weight;
  const Index inner = wide.size() - 2;
  return (wide.tail(inner) - 2.0 * wide.segment(1, inner) + wide.head(inner)) /
         (weight.sum() * period * period);
}

std::int64_t half_length(const Signal& signal, double period, bool position) {
  const VectorXd sizes = third_differences(signal);
  const double rounded = position ? counted_step(signal) / std::sqrt(12.0) : 0.0;
  for (const auto half : kHalfLengths) {
    const VectorXd weight = position ? curvature_weight(half, period) : slope_weight(half, period);
    if (4 * weight.size() > signal.size()) return half;
    const Index beside = weight.size() / 2;
    Middles middles;
    for (Index at = beside; at < signal.size() - beside; at += half) middles.push_back(at);
    VectorXd rough(static_cast<Index>(middles.size()));
    window_means(signal, weight, middles, rough.data());
    const double limit = std::sqrt(kNoiseShare * variance(rough) / weight.squaredNorm());
    const bool calm = mostly_below(sizes.data(), static_cast<std::size_t>(sizes.size()),
                                   limit * std::sqrt(20.0) / kOfMedianSize);
    if (calm && rounded <= limit) return half;
  }
  return kHalfLengths.back();
}

}  // namespace jointid::signals
