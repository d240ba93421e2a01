#include "base/normal.hpp"

#include <cmath>
#include <limits>

#include "base/elementary.hpp"

namespace jointid::base {

namespace {

constexpr double kRootOfTwoPi = 2.5066282746310002;
constexpr double kSeries = 2.0;  // below: the series about 0; beyond: Laplace's continued fraction
constexpr int kFraction = 160;   // its depth: 1e-16 at kSeries
constexpr double kShifted = 16.0;  // from here on, asymptotic series are accurate to the last bit
constexpr int kSteps = 60;
constexpr double kNear =
    1e-10;  // with a step this small, Newton's method has converged: its square is below rounding
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The probability between 0 and x, 0 <= x < kSeries: all terms are positive.
double from_centre(double x) {
  double term = x;
  double sum = x;
  for (int k = 3; term > 1e-17 * sum; k += 2) {
    term *= x * x / k;
    sum += term;
  }
  return normal_density(x) * sum;
}

}  // namespace

double log_one_plus(double x) {
  const double one = 1.0 + x;
  // Adds the rounding error of the sum back (Kahan).
  return one == 1.0 ? x : base::log(one) * (x / (one - 1.0));
}

double log_half_step(double a) {
  double shifted = 0.0;
  for (; a < kShifted; a += 1.0) shifted -= log_one_plus(0.5 / a);
  const double s = 1.0 / (a * a);
  const double series =
      -1.0 / 8.0 +
      s * (1.0 / 192.0 + s * (-1.0 / 640.0 +
                              s * (17.0 / 14336.0 + s * (-31.0 / 18432.0 + s * 691.0 / 180224.0))));
  return shifted + 0.5 * base::log(a) + series / a;
}

double stirling_rest(double a) {
  double shifted = 0.0;
  for (; a < kShifted; a += 1.0) shifted += (a + 0.5) * log_one_plus(1.0 / a) - 1.0;
  const double s = 1.0 / (a * a);
  const double series =
      1.0 / 12.0 +
      s * (-1.0 / 360.0 +
           s * (1.0 / 1260.0 + s * (-1.0 / 1680.0 + s * (1.0 / 1188.0 - s * 691.0 / 360360.0))));
  return shifted + series / a;
}

double normal_density(double x) {
  // The square in two parts: an ulp of the whole square would be 1e-13 of the density far out.
  const double head = std::floor(x * 16.0) / 16.0;
  return base::exp(-0.5 * head * head) * base::exp(-0.5 * (x - head) * (x + head)) / kRootOfTwoPi;
}

double normal_tail(double x) {
  if (!(x == x)) return kNan;
  if (x < 0.0) return 1.0 - normal_tail(-x);
  if (x < kSeries) return 0.5 - from_centre(x);
  double fraction = x;
  for (int k = kFraction; k > 0; --k) fraction = x + k / fraction;
  return normal_density(x) / fraction;
}

double normal_quantile(double tail) {
  if (!(tail >= 0.0 && tail <= 1.0)) return kNan;
  if (tail > 0.5) return -normal_quantile(1.0 - tail);
  if (tail == 0.0) return kInfinity;
  if (tail > 0.25) {  // near 0 the distance from the centre is known to the last bit
    const double centre = 0.5 - tail;
    double x = centre * kRootOfTwoPi;
    for (int step = 0; step < kSteps; ++step) {
      const double move = (centre - from_centre(x)) / normal_density(x);
      x += move;
      if (std::fabs(move) <= kNear * x) break;
    }
    return x;
  }
  const double target = base::log(tail);
  double x = std::sqrt(-2.0 * target) - 0.5;
  for (int step = 0; step < kSteps; ++step) {
    const double beyond = normal_tail(x);
    if (beyond == 0.0) return x;
    const double move = (base::log(beyond) - target) * beyond / normal_density(x);
    x += move;
    if (std::fabs(move) <= kNear * x) break;
  }
  return x;
}

double covering_half_width(double probability, double offset) {
  if (!(probability > 0.0 && probability < 1.0) || !(offset == offset)) return kNan;
  const double outside = 1.0 - probability;
  const double distance = std::fabs(offset);
  // Newton's method starts from below: the farther tail alone is at most the whole probability
  // outside, and the curve is convex.
  double width = distance + std::fmax(normal_quantile(outside), 0.0);
  for (int step = 0; step < kSteps; ++step) {
    const double beyond = normal_tail(width - distance) + normal_tail(width + distance) - outside;
    const double slope = normal_density(width - distance) + normal_density(width + distance);
    const double move = beyond / slope;
    width += move;
    if (!(std::fabs(move) > kNear * width)) break;
  }
  return width;
}

}  // namespace jointid::base
