#pragma once
// Four doubles in parallel, for operations that compilers leave scalar: the smaller and the larger
// of two, and lanes that are kept through a loop. All arguments are references, because vectors by
// value depend on the host's width.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/clones.hpp"
#include "base/lanes.hpp"

namespace jointid::base {

inline constexpr std::size_t kFour = 4;

#if defined(__GNUC__) && (defined(JOINTID_CLONED) || defined(__AVX__))
#define JOINTID_WHOLE
using Four = double __attribute__((vector_size(32)));
#else
// Pairs where no function is built for wider vectors. If the host lacks a vector, gcc splits it
// into single numbers at each choice between two.
using Four = Lanes<2>;
#endif

/// Sets all four to one value.
[[gnu::always_inline]] inline void fill(Four& four, double value) {
  four = Four{value, value, value, value};
}

[[gnu::always_inline]] inline void load(Four& four, const double* x) {
#ifdef JOINTID_WHOLE
  std::memcpy(&four, x, sizeof four);
#else
  for (auto& pair : four.pair) {
    std::memcpy(&pair, x, sizeof pair);
    x += 2;
  }
#endif
}

[[gnu::always_inline]] inline void store(double* x, const Four& four) {
#ifdef JOINTID_WHOLE
  std::memcpy(x, &four, sizeof four);
#else
  for (const auto& pair : four.pair) {
    std::memcpy(x, &pair, sizeof pair);
    x += 2;
  }
#endif
}

/// result -> yes where a < b, otherwise no.
[[gnu::always_inline]] inline void choose(const Four& a, const Four& b, const Four& yes,
                                          const Four& no, Four& result) {
#ifdef JOINTID_WHOLE
  result = a < b ? yes : no;
#else
  result = select(a < b, yes, no);
#endif
}

/// Adds 1 in lanes where a is not below b. Counting in doubles is exact and keeps the lane width.
[[gnu::always_inline]] inline void count_not_below(const Four& a, const Four& b, Four& count) {
  Four one;
  choose(a, b, Four{}, Four{} + 1.0, one);
  count = count + one;
}

/// to -> to - from.
[[gnu::always_inline]] inline void subtract(Four& to, const Four& from) {
  to = to - from;
}

/// Adds to four numbers in memory.
[[gnu::always_inline]] inline void add_to(double* x, const Four& four) {
  Four sum;
  load(sum, x);
  sum = sum + four;
  store(x, sum);
}

/// ((0 + 1) + (2 + 3)).
[[gnu::always_inline]] inline double sum_of(const Four& four) {
  return (four[0] + four[1]) + (four[2] + four[3]);
}

/// sum_of of four vectors in parallel.
[[gnu::always_inline]] inline void sums_of(const std::array<Four, kFour>& each, Four& sums) {
#if defined(JOINTID_WHOLE) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
#define JOINTID_SHUFFLES
#endif
#endif
#ifdef JOINTID_SHUFFLES
  const Four one = __builtin_shufflevector(each[0], each[1], 0, 4, 2, 6) +
                   __builtin_shufflevector(each[0], each[1], 1, 5, 3, 7);
  const Four other = __builtin_shufflevector(each[2], each[3], 0, 4, 2, 6) +
                     __builtin_shufflevector(each[2], each[3], 1, 5, 3, 7);
  sums = __builtin_shufflevector(one, other, 0, 1, 4, 5) +
         __builtin_shufflevector(one, other, 2, 3, 6, 7);
#else
  sums = Four{sum_of(each[0]), sum_of(each[1]), sum_of(each[2]), sum_of(each[3])};
#endif
}

[[gnu::always_inline]] inline void take_size(Four& four) {
#ifdef JOINTID_WHOLE
  using Bits = std::int64_t __attribute__((vector_size(32)));
  four = (Four)((Bits)four & std::numeric_limits<std::int64_t>::max());
#else
  four = absolute(four);
#endif
}

/// Replaces values that are not above 0 by infinity.
[[gnu::always_inline]] inline void leave_out_zeros(Four& four) {
  choose(Four{}, four, four, Four{} + std::numeric_limits<double>::infinity(), four);
}

/// Replaces values that are not above `least` by 0. Powers of the other values are then no
/// denormals, which take a hundred times as long.
[[gnu::always_inline]] inline void leave_out_small(Four& four, double least) {
  choose(Four{} + least, four, four, Four{}, four);
}

/// least -> the smaller of the two.
[[gnu::always_inline]] inline void lower(Four& least, const Four& other) {
  choose(other, least, other, least, least);
}

/// most -> the larger of the two.
[[gnu::always_inline]] inline void raise(Four& most, const Four& other) {
  choose(most, other, other, most, most);
}

[[gnu::always_inline]] inline double least_of(const Four& four) {
  const double one = four[1] < four[0] ? four[1] : four[0];
  const double other = four[3] < four[2] ? four[3] : four[2];
  return other < one ? other : one;
}

[[gnu::always_inline]] inline double most_of(const Four& four) {
  const double one = four[1] > four[0] ? four[1] : four[0];
  const double other = four[3] > four[2] ? four[3] : four[2];
  return other > one ? other : one;
}

}  // namespace jointid::base
