#pragma once
// Gaussian noise as a function of (seed, source, sample, draw): the same on any thread and in any
// lane.

#include <cmath>
#include <cstdint>

#include "base/elementary.hpp"
#include "base/random.hpp"

namespace jointid::simulate {

/// Box and Muller: a standard normal number.
inline double gaussian(std::uint64_t seed, std::uint32_t source, std::uint32_t sample,
                       std::uint32_t draw) {
  base::Random random(seed, source, sample, draw);
  const double radius = std::sqrt(-2.0 * base::log(random.uniform()));
  return radius * base::cos(0x1.921fb54442d18p+2 * random.uniform());
}

}  // namespace jointid::simulate
