#pragma once
// Four doubles side by side, for what compilers leave scalar: the smaller and the larger of two,
// lanes that live through a loop. All by reference, since vectors as arguments depend on the
// host's width.

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
struct Four {
  double lane[kFour];
  double operator[](std::size_t l) const { return lane[l]; }
  double& operator[](std::size_t l) { return lane[l]; }
  double* begin() { return lane; }
  double* end() { return lane + kFour; }
};
inline Four operator+(const Four& a, const Four& b) {
  return {{a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}};
}
inline Four operator-(const Four& a, const Four& b) {
  return {{a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}};
}
inline Four operator*(const Four& a, const Four& b) {
  return {{a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]}};
}
inline Four operator/(const Four& a, const Four& b) {
  return {{a[0] / b[0], a[1] / b[1], a[2] / b[2], a[3] / b[3]}};
}
inline Four operator*(const Four& a, double factor) {
  return {{a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor}};
}
#endif

/// All of them one value.
[[gnu::always_inline]] inline void fill(Four& four, double value) {
  for (std::size_t l = 0; l < kFour; ++l) four[l] = value;
}

[[gnu::always_inline]] inline void load(Four& four, const double* x) {
  std::memcpy(&four, x, sizeof four);
}

[[gnu::always_inline]] inline void store(double* x, const Four& four) {
  std::memcpy(x, &four, sizeof four);
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

/// sum_of each of four, side by side.
[[gnu::always_inline]] inline void sums_of(const std::array<Four, kFour>& each, Four& sums) {
#if defined(__GNUC__) && defined(__has_builtin)
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
  for (std::size_t l = 0; l < kFour; ++l) sums[l] = sum_of(each[l]);
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

/// 0 in the place of what is not above `least`: powers of what stays are no denormals, which take a
/// hundred times as long.
[[gnu::always_inline]] inline void leave_out_small(Four& four, double least) {
#if defined(__GNUC__)
  four = four > least ? four : Four{};
#else
  for (auto& value : four) value = value > least ? value : 0.0;
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
