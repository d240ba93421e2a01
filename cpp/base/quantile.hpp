#pragma once
// Exact quantiles without sorting or copying all values. A sample gives a range around the wanted
// rank. One pass counts the values below the range and keeps the few inside it.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/cancel.hpp"
#include "base/ranks.hpp"

namespace jointid::base {

namespace quantile_detail {

constexpr std::size_t kSample = 1024;
constexpr std::size_t kCopied = 4096;  // up to this number, all are copied and partitioned
constexpr double kMargin = 0.06;       // share of the sample on either side of the wanted rank
constexpr std::size_t kFew = 256;      // values per inner loop
constexpr std::size_t kBlock = 65536;  // values between two checks of the cancel flag

inline double between(double first, double second, double share) {
  return share == 0.0 ? first : first + share * (second - first);
}

}  // namespace quantile_detail

/// The quantile `q` (0 to 1, linear between neighbours; 0.5 is the median) of values without NaN.
/// `value(i, out)` writes value i < count and returns whether it counts; `kept` is the number of
/// those that count. 0 if there is none.
template <class Value>
double quantile(std::size_t count, std::size_t kept, double q, Value value,
                const Cancel* cancel = nullptr) {
  using namespace quantile_detail;
  if (kept == 0) return 0.0;
  const double position = q * static_cast<double>(kept - 1);
  const auto rank = static_cast<std::size_t>(position);
  const double share = position - static_cast<double>(rank);
  double one = 0.0;
  std::vector<double> near;
  if (kept > kCopied) {
    // Strides of changing length, so that a repeated motion does not show the same phase each time.
    const std::size_t stride = std::max<std::size_t>(1, count / (kSample * 2));
    std::uint64_t state = 88172645463325252ULL;
    for (std::size_t begin = 0; begin + stride <= count; begin += stride) {
      state ^= state << 13U;
      state ^= state >> 7U;
      state ^= state << 17U;
      if (value(begin + state % stride, one)) near.push_back(one);
    }
    if (near.size() >= kSample / 4) {
      const auto last = static_cast<double>(near.size() - 1);
      const auto at_share = [&](double place) {
        return at_rank(near.data(), near.size(), static_cast<std::size_t>(place * last)).value;
      };
      const double low = at_share(std::max(0.0, q - kMargin));
      const double high = at_share(std::min(1.0, q + kMargin));
      std::size_t below = 0;
      std::size_t at_low = 0;
      std::size_t at_high = 0;
      near.clear();
      std::array<double, kFew>
          between_both;  // without a branch: each value is written, few are kept
      for (std::size_t begin = 0; begin < count;) {
        if (cancel != nullptr && begin % kBlock == 0) cancel->check();
        const std::size_t end = std::min(count, begin + kFew);
        std::size_t found = 0;
        for (; begin < end; ++begin) {
          if (!value(begin, one)) continue;
          between_both[found] = one;
          found += ((one > low) & (one < high)) ? 1U : 0U;
          below += one < low ? 1U : 0U;
          at_low += one == low ? 1U : 0U;
          at_high += one == high ? 1U : 0U;
        }
        near.insert(near.end(), between_both.data(), between_both.data() + found);
      }
      if (low == high) at_high = 0;  // they are already counted
      const std::size_t reached = below + at_low + near.size() + at_high;
      if (rank >= below && rank + 1 < reached) {
        const std::size_t ends = below + at_low;  // number of values up to `low`
        const std::size_t inner = near.size();
        if (rank >= ends && rank < ends + inner) {
          const Ranked found = at_rank(near.data(), inner, rank - ends);
          return between(found.value, rank + 1 < ends + inner ? found.next : high, share);
        }
        if (rank >= ends) return high;
        if (share == 0.0 || rank + 1 < ends) return low;
        return between(low, inner > 0 ? at_rank(near.data(), inner, 0).value : high, share);
      }
    }
    near.clear();
  }
  near.reserve(kept);
  for (std::size_t i = 0; i < count; ++i) {
    if (value(i, one)) near.push_back(one);
  }
  const Ranked found = at_rank(near.data(), near.size(), rank);
  return between(found.value, found.next, share);
}

}  // namespace jointid::base
