#pragma once
// The inner product of two series in eight sums side by side: the same bits at every vector width.

#include <array>
#include <cstddef>

namespace jointid::base {

/// For functions with JOINTID_CLONES, into whose clones it must be inlined.
[[gnu::always_inline]] inline double inner_product(const double* a, const double* b,
                                                   std::size_t count) {
  constexpr std::size_t kLanes = 8;
  std::array<double, kLanes> sum{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) sum[l] += a[i + l] * b[i + l];
  }
  for (std::size_t l = 0; i + l < count; ++l) sum[l] += a[i + l] * b[i + l];
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

}  // namespace jointid::base
