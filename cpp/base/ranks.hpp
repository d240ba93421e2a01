#pragma once
// Order statistics of a few thousand values, without sorting them.

#include <cstddef>

namespace jointid::base {

/// A value of some rank, and that of the next rank: the same where there is none.
struct Ranked {
  double value;
  double next;
};

/// The value of rank `rank` (0: the smallest) of `count` values, which stay as they are; count >
/// rank, and none of them is NaN.
///
/// A partition in which no branch depends on a value: of values in any order std::nth_element
/// guesses every second branch wrong, which takes three times as long.
Ranked at_rank(const double* values, std::size_t count, std::size_t rank);

}  // namespace jointid::base
