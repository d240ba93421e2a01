#pragma once
// exp, log, sin and cos in plain arithmetic, each within 2 ulp. Results have the same bits on any
// host: libm picks variants by CPU, and no two libms agree in the last bit. Branch-free where a
// loop must vectorise. Written for double; needs -ffp-contract=off. The series are Taylor's (and
// atanh's), cut below 1e-17 on the reduced range.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace jointid::base {

namespace detail {

// Adding 1.5 * 2^52 rounds to the nearest integer and leaves that integer in the low bits.
inline constexpr double kRound = 6755399441055744.0;
inline constexpr double kLog2High = 0x1.62e42feep-1;  // 33 bits: k * high is exact for |k| < 2^20
inline constexpr double kLog2Low = 0x1.a39ef35793c76p-33;  // ln 2 - high

/// Operations that the templates below need in addition to arithmetic: the bits of a value as
/// integers, and a choice between two values by a mask. For pairs see lanes.hpp.
template <class Value>
struct Form;
template <>
struct Form<double> {
  using Bits = std::uint64_t;
  static Bits bits(double x) { return std::bit_cast<Bits>(x); }
  static double value(Bits bits) { return std::bit_cast<double>(bits); }
  static double choose(bool mask, double yes, double no) { return mask ? yes : no; }
};

template <class Value>
inline Value filled(double x) {
  return Value{} + x;
}

template <class Value>
[[gnu::always_inline]] inline Value exp(Value x) {
  using F = Form<Value>;
  const Value low = filled<Value>(-708.0);
  const Value high = filled<Value>(709.78);
  const Value clamped = F::choose(x < low, low, F::choose(x > high, high, x));
  const Value shifted = clamped * 0x1.71547652b82fep+0 + kRound;
  const Value k = shifted - kRound;
  const Value r = (clamped - k * kLog2High) - k * kLog2Low;  // |r| <= ln2 / 2
  Value p = filled<Value>(1.0 / 6227020800.0);
  p = p * r + 1.0 / 479001600.0;
  p = p * r + 1.0 / 39916800.0;
  p = p * r + 1.0 / 3628800.0;
  p = p * r + 1.0 / 362880.0;
  p = p * r + 1.0 / 40320.0;
  p = p * r + 1.0 / 5040.0;
  p = p * r + 1.0 / 720.0;
  p = p * r + 1.0 / 120.0;
  p = p * r + 1.0 / 24.0;
  p = p * r + 1.0 / 6.0;
  p = p * r + 0.5;
  const Value series = 1.0 + (r + r * r * p);
  // 2^k in two factors, because a single factor overflows at k = 1024.
  const Value scale = F::value((F::bits(shifted) + 1022U) << 52U);
  const Value result = series * scale * 2.0;
  const Value infinite = filled<Value>(std::numeric_limits<double>::infinity());
  const Value kept = F::choose(x > high, infinite, F::choose(x < low, Value{}, result));
  return F::choose(x == x, kept, x);
}

}  // namespace detail

/// e^x; 0 below -708 (no denormals), infinity above 709.78, NaN stays NaN.
inline double exp(double x) {
  return detail::exp(x);
}

/// e^x for -600 <= x <= 600, within 4 ulp. For sums over many samples, in which exp's last bit does
/// not matter. Ten terms, economised from the Chebyshev series over the reduced range, without
/// special cases.
inline double exp_short(double x) {
  const double shifted = x * 0x1.71547652b82fep+0 + detail::kRound;
  const double k = shifted - detail::kRound;
  const double r = (x - k * detail::kLog2High) - k * detail::kLog2Low;
  double p = 0x1.28b410d73d492p-22;
  p = p * r + 0x1.72fb000495e46p-19;
  p = p * r + 0x1.a01991a02d38fp-16;
  p = p * r + 0x1.a01978b7525dep-13;
  p = p * r + 0x1.6c16c18800884p-10;
  p = p * r + 0x1.1111112ddb681p-7;
  p = p * r + 0x1.555555554f0b8p-5;
  p = p * r + 0x1.555555554b732p-3;
  p = p * r + 0x1.0000000000011p-1;
  p = p * r + 0x1.000000000001ep+0;
  p = p * r + 1.0;
  const auto bits = std::bit_cast<std::uint64_t>(shifted);
  return p * std::bit_cast<double>((bits + 1023U) << 52U);
}

/// e^-y for y >= 0, by exp_short.
inline double exp_decay(double y) {
  return exp_short(y < 600.0 ? -y : -600.0);
}

/// Natural logarithm of a positive, finite, normal number: branch-free, for loops.
inline double log_normal(double x) {
  // Split so that the mantissa lies in [sqrt(1/2), sqrt(2)). The logarithm is then never a
  // difference of nearly equal numbers.
  const std::uint64_t offset = std::bit_cast<std::uint64_t>(x) - 0x3fe6a09e667f3bcdULL;
  // The exponent, by a sum that rounds to it, because packed 64-bit conversions are rare.
  const std::uint64_t biased = ((offset >> 52U) + 2048U) & 4095U;
  const double k = std::bit_cast<double>(biased | 0x4330000000000000ULL) - (0x1p52 + 2048.0);
  const double m = std::bit_cast<double>((offset & 0x000fffffffffffffULL) + 0x3fe6a09e667f3bcdULL);
  const double s = (m - 1.0) / (m + 1.0);
  const double z = s * s;
  double p = 1.0 / 23.0;
  p = p * z + 1.0 / 21.0;
  p = p * z + 1.0 / 19.0;
  p = p * z + 1.0 / 17.0;
  p = p * z + 1.0 / 15.0;
  p = p * z + 1.0 / 13.0;
  p = p * z + 1.0 / 11.0;
  p = p * z + 1.0 / 9.0;
  p = p * z + 1.0 / 7.0;
  p = p * z + 1.0 / 5.0;
  p = p * z + 1.0 / 3.0;
  // log m = 2 s + 2 s z p; with f = m - 1 exact, 2 s = f - s f.
  const double f = m - 1.0;
  return k * detail::kLog2High + (f - (s * (f - 2.0 * z * p) - k * detail::kLog2Low));
}

/// Natural logarithm; -infinity at 0, NaN below.
inline double log(double x) {
  if (!(x > 0.0)) {
    return x == 0.0 ? -std::numeric_limits<double>::infinity()
                    : std::numeric_limits<double>::quiet_NaN();
  }
  if (x == std::numeric_limits<double>::infinity()) return x;
  if (x >= std::numeric_limits<double>::min()) return log_normal(x);
  return log_normal(x * 0x1p54) - 54.0 * (detail::kLog2High + detail::kLog2Low);
}

namespace detail {

template <class Value>
struct Reduced {
  Value r;     // |r| <= pi / 4
  Value tail;  // rounding error of r
  typename Form<Value>::Bits quadrant;
};

/// x - k pi/2 for |x| < 2^20 pi/2 (three-part pi/2; 33 bits each, so that k * part is exact).
template <class Value>
inline Reduced<Value> reduce(Value x) {
  const Value shifted = x * 0x1.45f306dc9c883p-1 + kRound;
  const Value k = shifted - kRound;
  const Value a = x - k * 0x1.921fb544p+0;
  const Value b = k * 0x1.0b4611a6p-34;
  const Value r = a - b;
  const Value tail = ((a - r) - b) - k * 0x1.3198a2e037073p-69;
  return {r + tail, (r - (r + tail)) + tail, Form<Value>::bits(shifted)};
}

template <class Value>
inline Value sin_series(Value r, Value tail) {
  const Value z = r * r;
  Value p = filled<Value>(-1.0 / 121645100408832000.0);
  p = p * z + 1.0 / 355687428096000.0;
  p = p * z - 1.0 / 1307674368000.0;
  p = p * z + 1.0 / 6227020800.0;
  p = p * z - 1.0 / 39916800.0;
  p = p * z + 1.0 / 362880.0;
  p = p * z - 1.0 / 5040.0;
  p = p * z + 1.0 / 120.0;
  p = p * z - 1.0 / 6.0;
  return r + (r * z * p + tail * (1.0 - 0.5 * z));
}

template <class Value>
inline Value cos_series(Value r, Value tail) {
  const Value z = r * r;
  Value p = filled<Value>(1.0 / 2432902008176640000.0);
  p = p * z - 1.0 / 6402373705728000.0;
  p = p * z + 1.0 / 20922789888000.0;
  p = p * z - 1.0 / 87178291200.0;
  p = p * z + 1.0 / 479001600.0;
  p = p * z - 1.0 / 3628800.0;
  p = p * z + 1.0 / 40320.0;
  p = p * z - 1.0 / 720.0;
  p = p * z + 1.0 / 24.0;
  const Value half = 0.5 * z;
  const Value lead = 1.0 - half;
  return lead + (((1.0 - lead) - half) + (z * z * p - r * tail));
}

inline double flip(double value, std::uint64_t negative) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(value) ^ (negative << 63U));
}

}  // namespace detail

/// sin x for |x| < 1.6e6 rad (a motor angle stays far below). Larger x are first reduced by the
/// remainder.
inline double sin(double x) {
  if (!(std::fabs(x) < 1.6e6)) x = std::remainder(x, 0x1.921fb54442d18p+2);
  const auto [r, tail, quadrant] = detail::reduce(x);
  const double value =
      (quadrant & 1U) != 0 ? detail::cos_series(r, tail) : detail::sin_series(r, tail);
  return detail::flip(value, (quadrant >> 1U) & 1U);
}

/// cos x, range as for sin.
inline double cos(double x) {
  if (!(std::fabs(x) < 1.6e6)) x = std::remainder(x, 0x1.921fb54442d18p+2);
  const auto [r, tail, quadrant] = detail::reduce(x);
  const double value =
      (quadrant & 1U) != 0 ? detail::sin_series(r, tail) : detail::cos_series(r, tail);
  return detail::flip(value, ((quadrant + 1U) >> 1U) & 1U);
}

/// x^y for x > 0: exp(y log x). The error grows with |y log x|, which is accurate enough for the
/// genetic operators.
inline double pow(double x, double y) {
  return x > 0.0 ? exp(y * log(x)) : 0.0;
}

}  // namespace jointid::base
