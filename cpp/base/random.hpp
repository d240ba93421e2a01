#pragma once
// Counter-based random numbers: Philox-4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel random
// numbers: as easy as 1, 2, 3", SC 2011). A draw is a function of (seed, stream, generation,
// individual, draw number) and of nothing else, so the same seed gives the same bits in whatever
// order, on however many threads, individuals are made.

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/elementary.hpp"

namespace jointid::base {

/// One block of Philox-4x32 with ten rounds.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t second = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {static_cast<std::uint32_t>(second >> 32U) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(second),
               static_cast<std::uint32_t>(first >> 32U) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(first)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return counter;
}

/// The middle of one of 2^53 equal cells of the unit interval. In the upper half the sum rounds to
/// even, so the last cell would give 1: it gives the number below.
inline double unit_interval(std::uint64_t cell) {
  return std::min((static_cast<double>(cell) + 0.5) * 0x1p-53, 0x1.fffffffffffffp-1);
}

/// The draws of one individual in one generation of one stream (a trial or an island).
class Random {
 public:
  Random(std::uint64_t seed, std::uint32_t stream, std::uint32_t generation,
         std::uint32_t individual)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)},
        counter_{0, individual, generation, stream} {}

  /// Uniform in the open interval (0, 1), 53 bits: never 0 or 1, so logarithms and powers stay
  /// finite.
  double uniform() {
    const std::uint64_t high = next();
    const std::uint64_t low = next();
    return unit_interval((high << 21U) ^ (low >> 11U));
  }

  /// Uniform integer in [0, count); count at least 1.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((std::uint64_t{next()} * count) >> 32U);
  }

 private:
  std::uint32_t next() {
    if (used_ == 4) {
      block_ = philox(counter_, key_);
      ++counter_[0];
      used_ = 0;
    }
    return block_[used_++];
  }

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  unsigned used_ = 4;
};

}  // namespace jointid::base
