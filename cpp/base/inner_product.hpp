#pragma once
// The inner product of two series in eight parallel sums: the same bits at every vector width.

#include <array>
#include <cstddef>

#include "base/four.hpp"

namespace jointid::base {

/// For functions with JOINTID_CLONES: it must be inlined into their clones.
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

/// The inner products of a series with four others, which are `stride` apart. Each has the same
/// bits as a single product, but the series is read once.
[[gnu::always_inline]] inline void four_products(const double* a, const double* others,
                                                 std::size_t stride, std::size_t count,
                                                 double* products) {
  std::array<std::array<Four, 2>, 4> sum;
  for (auto& each : sum) {
    fill(each[0], 0.0);
    fill(each[1], 0.0);
  }
  std::size_t i = 0;
  for (; i + 2 * kFour <= count; i += 2 * kFour) {
    Four one;
    Four two;
    load(one, a + i);
    load(two, a + i + kFour);
    for (std::size_t j = 0; j < 4; ++j) {
      Four first;
      Four second;
      load(first, others + j * stride + i);
      load(second, others + j * stride + i + kFour);
      sum[j][0] = sum[j][0] + one * first;
      sum[j][1] = sum[j][1] + two * second;
    }
  }
  for (std::size_t j = 0; j < 4; ++j) {
    std::array<double, 2 * kFour> lane;
    store(lane.data(), sum[j][0]);
    store(lane.data() + kFour, sum[j][1]);
    const double* b = others + j * stride;
    for (std::size_t l = 0; i + l < count; ++l) lane[l] += a[i + l] * b[i + l];
    products[j] =
        ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
  }
}

/// The inner products of a series with `columns` others.
[[gnu::always_inline]] inline void inner_products(const double* a, const double* others,
                                                  std::size_t stride, std::size_t columns,
                                                  std::size_t count, double* products) {
  std::size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    four_products(a, others + j * stride, stride, count, products + j);
  }
  for (; j < columns; ++j) products[j] = inner_product(a, others + j * stride, count);
}

}  // namespace jointid::base
