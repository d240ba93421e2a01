#pragma once
// Counter-based random numbers: SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom
// number generators", OOPSLA 2014). Its n-th number is a function of its seed and n. A draw depends
// only on (seed, stream, generation, individual, draw number). So the same seed gives the same bits
// in any order and on any number of threads.

#include <algorithm>
#include <cstdint>

namespace jointid::base {

inline constexpr std::uint64_t kSplitMixStep = 0x9e3779b97f4a7c15ULL;

/// SplitMix64's finaliser: a bijection that removes every pattern of the counter.
inline std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

/// The middle of one of 2^53 equal cells of the unit interval. In the upper half the sum rounds to
/// even, and the last cell would give 1; it gives the number below 1 instead.
inline double unit_interval(std::uint64_t cell) {
  return std::min((static_cast<double>(static_cast<std::int64_t>(cell)) + 0.5) * 0x1p-53,
                  0x1.fffffffffffffp-1);
}

/// The draws of one individual.
class Random {
 public:
  /// A stream is a trial, an island or a noise source: anything that needs draws of its own.
  Random(std::uint64_t seed, std::uint32_t stream, std::uint32_t generation,
         std::uint32_t individual)
      : Random(key(seed, stream, generation), individual) {}

  /// The common part of a generation's draws, computed once for all its individuals.
  static std::uint64_t key(std::uint64_t seed, std::uint32_t stream, std::uint32_t generation) {
    return mixed(mixed(seed + kSplitMixStep) ^ (std::uint64_t{stream} << 32U | generation));
  }
  /// Each individual has 2^20 draws. Begins with draw number `first`.
  Random(std::uint64_t key, std::uint32_t individual, std::uint32_t first = 0)
      : state_(key + kSplitMixStep * ((std::uint64_t{individual} << 20U) + first)) {}

  /// Uniform in the open interval (0, 1), 53 bits: never 0 or 1, so logarithms and powers stay
  /// finite.
  double uniform() { return unit_interval(next() >> 11U); }

  /// Uniform integer in [0, count); count at least 1.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((next() >> 32U) * count) >> 32U);
  }

 private:
  std::uint64_t next() { return mixed(state_ += kSplitMixStep); }

  std::uint64_t state_;
};

}  // namespace jointid::base
