#pragma once
// Order statistics of a few thousand values, without sorting them.

#include <cstddef>

namespace jointid::base {

/// The value of some rank, and the value of the next rank (the same value if there is none).
struct Ranked {
  double value;
  double next;
};

/// The value of rank `rank` (0: the smallest) of `count` values, which are not changed. count >
/// rank, and no value is NaN.
///
/// No branch of the partition depends on a value. With values in random order, std::nth_element
/// mispredicts every second branch, which takes three times as long.
Ranked at_rank(const double* values, std::size_t count, std::size_t rank);

}  // namespace jointid::base
