#include "base/circle.hpp"

#include <cmath>

#include "base/clones.hpp"
#include "base/elementary.hpp"
#include "base/lanes.hpp"

namespace jointid::base {

namespace {

constexpr double kReduced = 1.6e6;  // [rad]: up to this size the reduction is exact enough

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
  std::size_t i = 0;
#if defined(JOINTID_PAIRS) && !defined(JOINTID_CLONED)
  // Without the clones for wider vectors, gcc leaves the loop below scalar.
  for (; i + 2 <= count; i += 2) {
    const auto [r, tail, quadrant] = detail::reduce(detail::Pair{angle[i], angle[i + 1]});
    const detail::Pair s = detail::sin_series(r, tail);
    const detail::Pair c = detail::cos_series(r, tail);
    const detail::PairMask odd = (quadrant & 1ULL) != 0ULL;
    const auto put = [&](double* to, detail::Pair value, detail::Bits turned) {
      value = (detail::Pair)((detail::Bits)value ^ (((turned >> 1ULL) & 1ULL) << 63ULL));
      to[i] = value[0];
      to[i + 1] = value[1];
    };
    put(sine, detail::pick(odd, c, s), quadrant);
    put(cosine, detail::pick(odd, s, c), quadrant + 1ULL);
  }
#endif
  for (; i < count; ++i) {
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
