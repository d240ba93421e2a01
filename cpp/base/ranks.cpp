#include "base/ranks.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace jointid::base {

namespace {

constexpr std::size_t kFew = 24;  // up to this number, values are sorted
constexpr int kMostRounds = 64;   // if an order defeats every pivot, the rest is sorted

double middle_of(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// Moves values below the pivot to the front and values above it to the end. Only equal values are
/// left between.
struct Sides {
  std::size_t below;
  std::size_t above;
};
Sides partition(const double* values, std::size_t count, double pivot, double* to) {
  std::size_t front = 0;
  std::size_t back = count - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = values[i];
    to[front] = value;  // written to both ends; the wrong copy is overwritten
    to[back] = value;
    front += value < pivot ? 1U : 0U;
    back -= value > pivot ? 1U : 0U;
  }
  return {front, count - 1 - back};
}

}  // namespace

Ranked at_rank(const double* values, std::size_t count, std::size_t rank) {
  // Not set to zero: a partition writes all values that the next one reads.
  const std::unique_ptr<double[]> scratch(count > kFew ? new double[2 * count] : nullptr);
  double* to = scratch.get();
  double* other = to == nullptr ? nullptr : to + count;
  double above = 0.0;  // the smallest value above the remaining ones
  bool is_last = true;
  const auto next_of = [&](double last) { return is_last ? last : above; };
  for (int round = 0; count > kFew && round < kMostRounds; ++round) {
    const double pivot = middle_of(values[count / 4], values[count / 2], values[count / 4 * 3]);
    const auto [low, high] = partition(values, count, pivot, to);
    const std::size_t equal_end = count - high;
    if (rank < low) {
      above = pivot;
      is_last = false;
      values = to;
      count = low;
    } else if (rank < equal_end) {
      if (rank + 1 < equal_end) return {pivot, pivot};
      if (high == 0) return {pivot, next_of(pivot)};
      return {pivot, *std::min_element(to + equal_end, to + count)};
    } else {
      values = to + equal_end;
      count = high;
      rank -= equal_end;
    }
    std::swap(to, other);
  }
  std::array<double, kFew> few{};  // gcc 14 does not see that count > rank
  double* sorted = count > kFew ? to : few.data();
  std::copy_n(values, count, sorted);
  std::sort(sorted, sorted + count);
  return {sorted[rank], rank + 1 < count ? sorted[rank + 1] : next_of(sorted[rank])};
}

}  // namespace jointid::base
