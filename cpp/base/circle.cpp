#include "base/circle.hpp"

#include <cmath>

#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::base {

namespace {

constexpr double kReduced = 1.6e6;  // [rad]: up to here the reduction is exact enough

JOINTID_CLONES double largest(const double* angle, std::size_t count) {
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double size = std::fabs(angle[i]);
    most = size < most ? most : size;
  }
  return most;
}

JOINTID_CLONES void near_circle(const double* angle, std::size_t count, double* cosine,
                                double* sine) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto [r, tail, quadrant] = detail::reduce(angle[i]);
    const double s = detail::sin_series(r, tail);
    const double c = detail::cos_series(r, tail);
    const bool odd = (quadrant & 1U) != 0;
    sine[i] = detail::flip(odd ? c : s, (quadrant >> 1U) & 1U);
    cosine[i] = detail::flip(odd ? s : c, ((quadrant + 1U) >> 1U) & 1U);
  }
}

}  // namespace

void circle(const double* angle, std::size_t count, double* cosine, double* sine) {
  if (largest(angle, count) < kReduced) {
    near_circle(angle, count, cosine, sine);
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    cosine[i] = cos(angle[i]);
    sine[i] = sin(angle[i]);
  }
}

}  // namespace jointid::base
