#include "base/student.hpp"

#include <cmath>
#include <limits>

#include "base/elementary.hpp"
#include "base/normal.hpp"

namespace jointid::base {

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormal =
    1e20;  // degrees of freedom: from here on, no bit of the quantile changes
constexpr double kCentral = 3.0;  // t^2: below, the series about 0
constexpr int kTerms = 20000;
constexpr int kSteps = 100;
constexpr double kSettled = 4e-16;

/// Student's t with these degrees of freedom, right of 0.
class Student {
 public:
  explicit Student(double freedom)
      : freedom_(freedom),
        half_(0.5 * freedom),
        step_(log_half_step(half_)),
        density_(base::exp(step_ - 0.5 * base::log(freedom * kPi))) {}

  [[nodiscard]] double density_at_zero() const { return density_; }

  [[nodiscard]] double density(double t) const {
    return density_ * base::exp(-(half_ + 0.5) * log_one_plus(t * t / freedom_));
  }

  /// The slope of -ln tail over ln t.
  [[nodiscard]] double hazard(double log_of_t, double log_of_tail) const {
    const double log_of_q = base::log(freedom_) - 2.0 * log_of_t;
    // ln(1 + t^2 / freedom)
    const double grown = log_of_q < 0.0 ? log_one_plus(base::exp(log_of_q)) - log_of_q
                                        : log_one_plus(base::exp(-log_of_q));
    return density_ * base::exp(log_of_t - (half_ + 0.5) * grown - log_of_tail);
  }

  /// The probability between 0 and t.
  [[nodiscard]] double from_centre(double t) const {
    if (t * t >= border()) return 0.5 - base::exp(log_tail(base::log(t)));
    // The incomplete beta function as a series of positive terms.
    const double y = t * t / (freedom_ + t * t);
    double term = 1.0;
    double sum = 1.0;
    for (int n = 0; n < kTerms && term > 1e-17 * sum; ++n) {
      term *= (half_ + 0.5 + n) / (1.5 + n) * y;
      sum += term;
    }
    return t * density(t) * sum;
  }

  /// ln of the probability beyond t, by ln t, which has no overflow.
  [[nodiscard]] double log_tail(double log_of_t) const {
    const double t = base::exp(log_of_t);
    if (t * t < border()) return base::log(0.5 - from_centre(t));
    // q = freedom / t^2; the continued fraction of 2F1(1, 1/2; freedom/2 + 1; -q) has positive
    // terms only, and becomes Laplace's of the normal tail.
    const double log_of_q = base::log(freedom_) - 2.0 * log_of_t;
    const double q = log_of_q < -700.0 ? 0.0 : base::exp(log_of_q);
    const double c = half_ + 1.0;
    double fraction = 1.0;
    for (int n = depth(t); n > 0; --n) {
      const double twice = c + 2.0 * n;
      fraction = 1.0 + (0.5 + n) * (c + n - 1.0) / ((twice - 1.0) * twice) * q / fraction;
      fraction = 1.0 + n * (c - 1.5 + n) / ((twice - 2.0) * (twice - 1.0)) * q / fraction;
    }
    fraction = 1.0 + 0.5 / c * q / fraction;
    const double log_of_share =  // ln(freedom / (freedom + t^2))
        q < 1.0 ? log_of_q - log_one_plus(q) : -log_one_plus(1.0 / q);
    return half_ * log_of_share + 0.5 * log_one_plus(q) + step_ -
           base::log(2.0 * half_ * std::sqrt(kPi)) - base::log(fraction);
  }

 private:
  [[nodiscard]] double border() const { return std::fmin(kCentral, freedom_); }

  /// Depth of the continued fraction: as for Laplace's.
  [[nodiscard]] static int depth(double t) {
    return 20 + static_cast<int>(400.0 / std::fmax(1.0, std::fmin(t * t, 100.0)));
  }

  double freedom_;
  double half_;
  double step_;
  double density_;
};

/// The value beyond which `tail` <= 1/2 lies. Both curves are concave, so Newton's method converges
/// from one side.
double right_of_zero(const Student& student, double tail) {
  if (tail == 0.0) return kInfinity;
  if (tail > 0.25) {  // here the distance from the centre is known to the last bit
    const double centre = 0.5 - tail;
    double t = centre / student.density_at_zero();
    for (int step = 0; step < kSteps && t > 0.0; ++step) {
      const double move = (centre - student.from_centre(t)) / student.density(t);
      t += move;
      if (!(std::fabs(move) > kSettled * t)) break;
    }
    return t;
  }
  const double target = base::log(tail);
  double logarithm = base::log(normal_quantile(tail));
  for (int step = 0; step < kSteps; ++step) {
    const double found = student.log_tail(logarithm);
    const double move = (found - target) / student.hazard(logarithm, found);
    logarithm += move;
    if (!(std::fabs(move) > kSettled)) break;
  }
  return base::exp(logarithm);
}

/// ln of x^a e^-x / Gamma(a), without the cancellation of large terms. `log_of_x` is also valid
/// where x underflows to 0.
double log_gamma_density(double a, double x, double log_of_x) {
  const double mean = (x - a) / a;
  const double logarithm = mean < -0.5 ? log_of_x - base::log(a) : log_one_plus(mean);
  return -a * (mean - logarithm) + 0.5 * base::log(a / (2.0 * kPi)) - stirling_rest(a);
}

/// ln of chi-square's tail on one side: the lower one or the upper one.
double log_gamma_tail(double a, double x, double logarithm, bool upper) {
  const bool series = x < a + 1.0;
  double inner = 1.0;
  if (series) {
    double term = 1.0;
    for (int n = 1; n < kTerms && term > 1e-17 * inner; ++n) {
      term *= x / (a + n);
      inner += term;
    }
    inner /= a;
  } else {  // Legendre's continued fraction, by Lentz
    double b = x + 1.0 - a;
    double c = 1e300;
    double d = 1.0 / b;
    inner = d;
    for (int n = 1; n < kTerms; ++n) {
      const double numerator = -n * (n - a);
      b += 2.0;
      d = 1.0 / (numerator * d + b);
      c = b + numerator / c;
      inner *= d * c;
      if (std::fabs(d * c - 1.0) < 1e-16) break;
    }
  }
  const double found = logarithm + base::log(inner);
  return series == upper ? log_one_plus(-base::exp(found)) : found;
}

}  // namespace

double student_quantile(double probability, double freedom) {
  if (!(probability >= 0.0 && probability <= 1.0) || !(freedom > 0.0)) return kNan;
  const bool left = probability < 0.5;
  const double tail = left ? probability : 1.0 - probability;
  if (freedom > kNormal) return left ? -normal_quantile(tail) : normal_quantile(tail);
  const double found = right_of_zero(Student(freedom), tail);
  return left ? -found : found;
}

double chi_square_quantile(double tail, double freedom) {
  if (!(tail >= 0.0 && tail <= 1.0) || !(freedom > 0.0 && freedom < kInfinity)) return kNan;
  if (tail == 0.0) return kInfinity;
  if (tail == 1.0) return 0.0;
  const double a = 0.5 * freedom;
  const bool upper = tail <= 0.5;
  const double target = base::log(upper ? tail : 1.0 - tail);
  // Wilson and Hilferty; if the result is negative, the first term of the series.
  const double cube = 1.0 - 1.0 / (9.0 * a) + normal_quantile(tail) / (3.0 * std::sqrt(a));
  double logarithm = base::log(a) + 3.0 * base::log(cube);
  if (cube < 0.3) {
    logarithm = (base::log(1.0 - tail) + base::log(a) + stirling_rest(a) +
                 (a - 0.5) * base::log(a) - a + 0.5 * base::log(2.0 * kPi)) /
                a;
  }
  for (int step = 0; step < kSteps; ++step) {
    const double x = base::exp(logarithm);
    const double density = log_gamma_density(a, x, logarithm);
    const double found = log_gamma_tail(a, x, density, upper);
    const double rate = base::exp(density - found);
    const double move = (upper ? found - target : target - found) / rate;
    logarithm += move;
    if (!(std::fabs(move) > kSettled)) break;
  }
  return 2.0 * base::exp(logarithm);
}

}  // namespace jointid::base
