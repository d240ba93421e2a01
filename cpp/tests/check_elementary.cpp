// exp, log, sin and cos compared with the long double libm, in units in the last place.

#include <bit>
#include <cfloat>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/elementary.hpp"
#include "base/lanes.hpp"
#include "base/random.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kUlps = 2.0;

double ulps(double value, long double exact) {
  const int exponent = exact == 0.0L ? -1074 : std::ilogb(exact) - 52;
  const long double unit = std::ldexp(1.0L, exponent < -1074 ? -1074 : exponent);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - exact) / unit);
}

/// The largest error, and its place.
class Worst {
 public:
  void see(double x, double value, long double exact) {
    const double error = ulps(value, exact);
    if (error <= error_) return;  // false for NaN, which is the worst error
    error_ = error;
    at_ = x;
  }
  [[nodiscard]] bool within(double limit) const { return error_ <= limit; }
  [[nodiscard]] std::string text() const {
    std::ostringstream out;
    out.precision(17);
    out << error_ << " ulp at " << at_;
    return out.str();
  }

 private:
  double error_ = 0.0;
  double at_ = 0.0;
};

using RealFunction = double (*)(double);
using Exact = long double (*)(long double);

void compare(RealFunction function, Exact exact, double low, double high, int dense, int random,
             double limit = kUlps) {
  Worst worst;
  for (int i = 0; i <= dense; ++i) {
    const double x = low + (high - low) * i / dense;
    worst.see(x, function(x), exact(x));
  }
  base::Random draw(7, 0, 0, 0);
  for (int i = 0; i < random; ++i) {
    const double x = low + (high - low) * draw.uniform();
    worst.see(x, function(x), exact(x));
  }
  CHECK_WITH(worst.within(limit), worst.text());
}

long double exp_exact(long double x) {
  return std::exp(x);
}
long double log_exact(long double x) {
  return std::log(x);
}
long double sin_exact(long double x) {
  return std::sin(x);
}
long double cos_exact(long double x) {
  return std::cos(x);
}

CHECK_CASE("elementary: exp within 2 ulp") {
  compare(base::exp, exp_exact, -708.0, 709.78, 200'000, 200'000);
  compare(base::exp, exp_exact, -1.0, 1.0, 200'000, 200'000);
  compare(base::exp, exp_exact, -708.0, -707.0, 50'000, 50'000);  // the smallest normal results
  compare(base::exp, exp_exact, -1e-8, 1e-8, 10'000, 10'000);
}

CHECK_CASE("elementary: exp at its edges") {
  CHECK(base::exp(0.0) == 1.0);
  CHECK(base::exp(-0.0) == 1.0);
  CHECK(base::exp(DBL_MIN) == 1.0);
  CHECK(base::exp(-708.0) > 0.0);
  CHECK(base::exp(std::nextafter(-708.0, -kInfinity)) == 0.0);
  CHECK(base::exp(-1e300) == 0.0);
  CHECK(base::exp(-kInfinity) == 0.0);
  CHECK(std::isfinite(base::exp(709.78)));
  CHECK(base::exp(std::nextafter(709.78, kInfinity)) == kInfinity);
  CHECK(base::exp(kInfinity) == kInfinity);
  CHECK(std::isnan(base::exp(kNan)));
}

CHECK_CASE("elementary: exp_decay within 4 ulp up to 600, and never denormal") {
  const auto exact = [](long double y) { return std::exp(-y); };
  compare(base::exp_decay, exact, 0.0, 1.0, 100'000, 100'000, 4.0);
  compare(base::exp_decay, exact, 0.0, 599.0, 100'000, 100'000, 4.0);
  CHECK(base::exp_decay(0.0) == 1.0);
  for (const double y : {600.0, 1e300, kInfinity}) {
    CHECK(base::exp_decay(y) < 1e-260 && base::exp_decay(y) > 1e-261);
  }
}

CHECK_CASE("elementary: log within 2 ulp") {
  compare(base::log, log_exact, 0.5, 2.0, 200'000, 200'000);
  compare(base::log, log_exact, 1.0 - 1e-6, 1.0 + 1e-6, 50'000, 50'000);
  Worst worst;
  base::Random draw(8, 0, 0, 0);
  for (int i = 0; i < 300'000; ++i) {  // every exponent, denormal ones too
    const double x =
        std::ldexp(0.5 + 0.5 * draw.uniform(), static_cast<int>(draw.below(2097)) - 1072);
    if (x > 0.0 && std::isfinite(x)) worst.see(x, base::log(x), log_exact(x));
  }
  CHECK_WITH(worst.within(kUlps), worst.text());
}

CHECK_CASE("elementary: log at its edges") {
  CHECK(base::log(1.0) == 0.0);
  CHECK(base::log(0.0) == -kInfinity);
  CHECK(base::log(-0.0) == -kInfinity);
  CHECK(std::isnan(base::log(-1.0)));
  CHECK(std::isnan(base::log(-kInfinity)));
  CHECK(base::log(kInfinity) == kInfinity);
  CHECK(std::isnan(base::log(kNan)));
  for (const double x : {DBL_TRUE_MIN, 3.0 * DBL_TRUE_MIN, std::nextafter(DBL_MIN, 0.0), DBL_MIN,
                         DBL_MAX, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0),
                         std::numbers::sqrt2, 0.5 * std::numbers::sqrt2}) {
    CHECK_CLOSE(ulps(base::log(x), log_exact(x)), 0.0, kUlps);
  }
}

CHECK_CASE("elementary: sin and cos within 2 ulp up to 1.6e6 rad") {
  compare(base::sin, sin_exact, -10.0, 10.0, 200'000, 200'000);
  compare(base::cos, cos_exact, -10.0, 10.0, 200'000, 200'000);
  compare(base::sin, sin_exact, -1.5999999e6, 1.5999999e6, 200'000, 200'000);
  compare(base::cos, cos_exact, -1.5999999e6, 1.5999999e6, 200'000, 200'000);
  compare(base::sin, sin_exact, -1e-8, 1e-8, 10'000, 10'000);
  compare(base::cos, cos_exact, -1e-8, 1e-8, 10'000, 10'000);
}

CHECK_CASE("elementary: sin and cos near the multiples of pi/2") {
  Worst sine;
  Worst cosine;
  base::Random draw(9, 0, 0, 0);
  for (int i = 0; i < 200'000; ++i) {
    const int k = i < 2000 ? i - 1000 : static_cast<int>(draw.below(2'000'000)) - 1'000'000;
    double x = static_cast<double>(k * (std::numbers::pi_v<long double> / 2.0L));
    if (i % 4 == 1) x = std::nextafter(x, kInfinity);
    if (i % 4 == 2) x = std::nextafter(x, -kInfinity);
    if (i % 4 == 3) x += std::ldexp(x, -static_cast<int>(draw.below(52)));  // some distance away
    if (std::fabs(x) > 1.6e6) continue;
    sine.see(x, base::sin(x), sin_exact(x));
    cosine.see(x, base::cos(x), cos_exact(x));
  }
  CHECK_WITH(sine.within(kUlps), "sin " + sine.text());
  CHECK_WITH(cosine.within(kUlps), "cos " + cosine.text());
}

CHECK_CASE("elementary: sin and cos at their edges and beyond 1.6e6 rad") {
  CHECK(base::sin(0.0) == 0.0);
  CHECK(base::cos(0.0) == 1.0);
  CHECK(base::sin(DBL_TRUE_MIN) == DBL_TRUE_MIN);
  for (const double x : {kInfinity, -kInfinity, kNan}) {
    CHECK(std::isnan(base::sin(x)));
    CHECK(std::isnan(base::cos(x)));
  }
  base::Random draw(10, 0, 0, 0);
  for (int i = 0; i < 50'000; ++i) {
    // The remainder is by 2 pi as a double: an error of 4e-17 times the argument.
    const double x = std::exp(std::log(1.6e6) + draw.uniform() * std::log(1e6));
    CHECK_CLOSE(base::sin(x), std::sin(x), 5e-17 * x + 1e-15);
    CHECK_CLOSE(base::cos(x), std::cos(x), 5e-17 * x + 1e-15);
  }
  for (const double x : {1e18, 1e100, 1e300, DBL_MAX, -DBL_MAX}) {
    CHECK(std::fabs(base::sin(x)) <= 1.0);
    CHECK_CLOSE(std::hypot(base::sin(x), base::cos(x)), 1.0, 1e-15);
  }
}

CHECK_CASE("elementary: pow is accurate to its exponent") {
  base::Random draw(11, 0, 0, 0);
  for (int i = 0; i < 50'000; ++i) {
    const double x = draw.uniform() * 3.0;
    const double y = 8.0 * draw.uniform() - 4.0;
    const double exact = std::pow(x, y);
    const double growth = 2.0 + std::fabs(y * std::log(x));
    CHECK_CLOSE(base::pow(x, y), exact, 4.0 * growth * DBL_EPSILON * exact);
  }
  CHECK(base::pow(0.0, 0.5) == 0.0);
  CHECK(base::pow(1.0, 1e300) == 1.0);
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

CHECK_CASE("elementary: lanes have the bits of single numbers") {
  base::Random draw(12, 0, 0, 0);
  std::vector<double> special{0.0,    -0.0,   kNan,  kInfinity, -kInfinity, 709.78, 709.79,
                              -708.0, -708.1, 1.6e6, -1.6e6,    1e300,      1.0,    DBL_MIN};
  int different = 0;
  for (int i = 0; i < 100'000; ++i) {
    base::Lanes<2> x;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const double size = std::exp(18.0 * draw.uniform() - 4.0);
      const bool odd = i < 2'000 && draw.uniform() < 0.3;
      const auto which = static_cast<std::size_t>(draw.uniform() * 14.0);
      x.set(lane, odd ? special[which] : (draw.uniform() < 0.5 ? -size : size));
    }
    const auto exps = base::exp(x);
    const auto sines = base::sin(x);
    const auto cosines = base::cos(x);
    const auto sizes = base::absolute(x);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      different += same_bits(exps[lane], base::exp(x[lane])) ? 0 : 1;
      different += same_bits(sines[lane], base::sin(x[lane])) ? 0 : 1;
      different += same_bits(cosines[lane], base::cos(x[lane])) ? 0 : 1;
      different += same_bits(sizes[lane], std::fabs(x[lane])) ? 0 : 1;
    }
  }
  CHECK(different == 0);
}

}  // namespace
}  // namespace jointid::tests
