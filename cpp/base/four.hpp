#pragma once
// Four doubles side by side, for extremes: compilers vectorise sums in lanes, but not the smaller
// and the larger of two. All by reference, since vectors as arguments depend on the host's width.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace jointid::base {

inline constexpr std::size_t kFour = 4;

#if defined(__GNUC__)
using Four = double __attribute__((vector_size(32)));
#else
using Four = std::array<double, kFour>;
#endif

/// All of them one value.
[[gnu::always_inline]] inline void fill(Four& four, double value) {
  for (std::size_t l = 0; l < kFour; ++l) four[l] = value;
}

[[gnu::always_inline]] inline void load(Four& four, const double* x) {
  std::memcpy(&four, x, sizeof four);
}

/// to -> to - from.
[[gnu::always_inline]] inline void subtract(Four& to, const Four& from) {
#if defined(__GNUC__)
  to = to - from;
#else
  for (std::size_t l = 0; l < kFour; ++l) to[l] = to[l] - from[l];
#endif
}

[[gnu::always_inline]] inline void take_size(Four& four) {
#if defined(__GNUC__)
  using Bits = std::int64_t __attribute__((vector_size(32)));
  four = (Four)((Bits)four & std::numeric_limits<std::int64_t>::max());
#else
  for (std::size_t l = 0; l < kFour; ++l) four[l] = std::fabs(four[l]);
#endif
}

/// Infinity in the place of what is not above 0.
[[gnu::always_inline]] inline void leave_out_zeros(Four& four) {
#if defined(__GNUC__)
  const Four none = Four{} + std::numeric_limits<double>::infinity();
  four = four > 0.0 ? four : none;
#else
  for (auto& value : four) value = value > 0.0 ? value : std::numeric_limits<double>::infinity();
#endif
}

/// least -> the smaller of both.
[[gnu::always_inline]] inline void lower(Four& least, const Four& other) {
#if defined(__GNUC__)
  least = other < least ? other : least;
#else
  for (std::size_t l = 0; l < kFour; ++l) least[l] = other[l] < least[l] ? other[l] : least[l];
#endif
}

/// most -> the larger of both.
[[gnu::always_inline]] inline void raise(Four& most, const Four& other) {
#if defined(__GNUC__)
  most = other > most ? other : most;
#else
  for (std::size_t l = 0; l < kFour; ++l) most[l] = other[l] > most[l] ? other[l] : most[l];
#endif
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
