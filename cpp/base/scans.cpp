#include "base/scans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/clones.hpp"
#include "base/four.hpp"

namespace jointid::base {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Sizes of samples, or of the steps to the samples `ahead`.
[[gnu::always_inline]] inline Least least(const double* x, std::size_t count, std::size_t ahead) {
  Four any;
  Four positive;
  fill(any, kNone);
  fill(positive, kNone);
  std::size_t i = 0;
  for (; i + kFour <= count; i += kFour) {
    Four size;
    load(size, x + i + ahead);
    if (ahead > 0) {
      Four before;
      load(before, x + i);
      subtract(size, before);
    }
    take_size(size);
    lower(any, size);
    leave_out_zeros(size);
    lower(positive, size);
  }
  Least found{least_of(any), least_of(positive)};
  for (; i < count; ++i) {
    const double size = std::fabs(ahead > 0 ? x[i + ahead] - x[i] : x[i]);
    found.any = std::min(found.any, size);
    if (size > 0.0) found.positive = std::min(found.positive, size);
  }
  return found;
}

}  // namespace

JOINTID_CLONES Range range_of(const double* x, std::size_t count) {
  Four low;
  Four high;
  fill(low, x[0]);
  fill(high, x[0]);
  std::size_t i = 0;
  for (; i + kFour <= count; i += kFour) {
    Four here;
    load(here, x + i);
    lower(low, here);
    raise(high, here);
  }
  Range found{least_of(low), most_of(high)};
  for (; i < count; ++i) {
    found.low = x[i] < found.low ? x[i] : found.low;
    found.high = x[i] > found.high ? x[i] : found.high;
  }
  return found;
}

JOINTID_CLONES Least least_sizes(const double* x, std::size_t count) {
  return least(x, count, 0);
}

JOINTID_CLONES Least least_steps(const double* x, std::size_t steps) {
  return least(x, steps, 1);
}

JOINTID_CLONES Survey survey(const double* x, std::size_t steps) {
  Four low;
  Four high;
  Four positive;
  fill(low, x[steps]);
  fill(high, x[steps]);
  fill(positive, kNone);
  Four same{};
  std::size_t i = 0;
  for (; i + kFour <= steps; i += kFour) {
    Four here;
    Four size;
    load(here, x + i);
    load(size, x + i + 1);
    lower(low, here);
    raise(high, here);
    subtract(size, here);
    take_size(size);
    count_not_below(Four{}, size, same);
    leave_out_zeros(size);
    lower(positive, size);
  }
  Survey found{{least_of(low), most_of(high)}, least_of(positive), 0};
  auto changes = static_cast<std::int64_t>(i) - static_cast<std::int64_t>(sum_of(same));
  for (; i < steps; ++i) {
    found.range.low = std::min(found.range.low, x[i]);
    found.range.high = std::max(found.range.high, x[i]);
    const double size = std::fabs(x[i + 1] - x[i]);
    if (!(size > 0.0)) continue;
    found.smallest = std::min(found.smallest, size);
    ++changes;
  }
  found.changes = changes;
  return found;
}

JOINTID_CLONES double largest_rate(const double* time, const double* x, std::size_t width,
                                   std::size_t count) {
  Four high;
  fill(high, 0.0);
  std::size_t k = 0;
  for (; k + kFour <= count; k += kFour) {
    Four travel;
    Four before;
    load(travel, x + k + width);
    load(before, x + k);
    subtract(travel, before);
    Four taken;
    load(taken, time + k + width);
    load(before, time + k);
    subtract(taken, before);
    Four rate = travel / taken;
    take_size(rate);
    raise(high, rate);
  }
  double found = most_of(high);
  for (; k < count; ++k) {
    found = std::max(found, std::fabs((x[k + width] - x[k]) / (time[k + width] - time[k])));
  }
  return found;
}

JOINTID_CLONES double largest_height(const double* x, std::size_t width, std::size_t places) {
  Four high;
  Four deep;  // separate, so that neither waits for the other
  fill(high, 0.0);
  fill(deep, 0.0);
  std::size_t i = 0;
  for (; i + kFour <= places; i += kFour) {
    Four middle;
    Four there;
    Four back;
    load(middle, x + i + width);
    load(there, x + i);
    load(back, x + i + 2 * width);
    Four low = there;  // for a sample below both, the distance from the lower one
    lower(low, back);
    subtract(low, middle);
    raise(deep, low);
    raise(there, back);
    subtract(middle, there);
    raise(high, middle);
  }
  raise(high, deep);
  double found = most_of(high);
  for (; i < places; ++i) {
    const double middle = x[i + width];
    found = std::max({found, std::min(x[i], x[i + 2 * width]) - middle,
                      middle - std::max(x[i], x[i + 2 * width])});
  }
  return found;
}

JOINTID_CLONES std::size_t one_sided(const double* x, std::size_t count) {
  const double side = x[0] > 0.0 ? 1.0 : -1.0;
  std::size_t i = 0;
  constexpr std::size_t kTogether = 4 * kFour;
  for (; i + kTogether <= count; i += kTogether) {
    Four low;
    fill(low, kNone);
    for (std::size_t k = 0; k < kTogether; k += kFour) {
      Four here;
      load(here, x + i + k);
      here = here * side;
      lower(low, here);
    }
    if (!(least_of(low) > 0.0)) break;
  }
  while (i < count && side * x[i] > 0.0) ++i;
  return i;
}

JOINTID_CLONES bool all_finite(const double* x, std::size_t count) {
  std::array<double, 8> sum{};
  std::size_t i = 0;
  for (; i + sum.size() <= count; i += sum.size()) {
    for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += 0.0 * x[i + l];
  }
  for (; i < count; ++i) sum[0] += 0.0 * x[i];
  return std::all_of(sum.begin(), sum.end(), [](double value) { return value == 0.0; });
}

JOINTID_CLONES bool increases(const double* x, std::size_t steps) {
  Four least;
  fill(least, kNone);
  std::size_t i = 0;
  for (; i + kFour <= steps; i += kFour) {
    Four step;
    Four before;
    load(step, x + i + 1);
    load(before, x + i);
    subtract(step, before);
    lower(least, step);
  }
  bool found = least_of(least) > 0.0;
  for (; i < steps; ++i) found = found && x[i + 1] > x[i];
  return found;
}

}  // namespace jointid::base
