// Quantiles compared with closed forms (Cauchy, two degrees of freedom, the exponential
// distribution) and with tables. The tests in Python compare them with SciPy over wide ranges.

#include <cmath>
#include <limits>
#include <numbers>

#include "base/normal.hpp"
#include "base/student.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

CHECK_CASE("distributions: Student's t has its closed forms") {
  for (const double p : {1e-300, 1e-20, 0.001, 0.2, 0.3, 0.499, 0.6, 0.8, 0.975, 0.999999}) {
    // Near a pole of the tangent, the cotangent from the other side keeps the relative error.
    const double near = p < 0.25   ? -1.0 / std::tan(std::numbers::pi * p)
                        : p > 0.75 ? 1.0 / std::tan(std::numbers::pi * (1.0 - p))
                                   : std::tan(std::numbers::pi * (p - 0.5));
    CHECK_CLOSE(base::student_quantile(p, 1.0) / near, 1.0, 2e-13);
    const double two = (2.0 * p - 1.0) / std::sqrt(2.0 * p * (1.0 - p));
    CHECK_CLOSE(base::student_quantile(p, 2.0) / two, 1.0, 2e-13);
  }
}

CHECK_CASE("distributions: table values") {
  CHECK_CLOSE(base::student_quantile(0.975, 10.0), 2.2281388519862748, 4e-15);
  CHECK_CLOSE(base::student_quantile(0.975, 7.5), 2.333039626864974, 1e-14);
  CHECK_CLOSE(base::student_quantile(0.975, kInfinity), 1.9599639845400545, 4e-15);
  CHECK_CLOSE(base::normal_quantile(1e-300), 37.047096299361201, 1e-13);
  CHECK_CLOSE(base::chi_square_quantile(0.05, 3.0), 7.814727903251178, 1e-14);
  CHECK_CLOSE(base::chi_square_quantile(0.1875, 0.1), 0.018538742158788785, 1e-12);
  CHECK_CLOSE(base::covering_half_width(0.95, 0.0), 1.9599639845400545, 4e-15);
}

CHECK_CASE("distributions: chi-square of two is exponential") {
  for (const double tail : {1e-300, 1e-10, 0.01, 0.3, 0.5, 0.7, 0.99}) {
    CHECK_CLOSE(base::chi_square_quantile(tail, 2.0) / (-2.0 * std::log(tail)), 1.0, 2e-14);
  }
}

CHECK_CASE("distributions: the ends, and values that are no probability") {
  CHECK(base::student_quantile(0.0, 3.0) == -kInfinity);
  CHECK(base::student_quantile(1.0, 3.0) == kInfinity);
  CHECK(base::student_quantile(0.5, 3.0) == 0.0);
  CHECK(std::isnan(base::student_quantile(-0.1, 3.0)));
  CHECK(std::isnan(base::student_quantile(0.5, 0.0)));
  CHECK(std::isnan(base::student_quantile(std::nan(""), 3.0)));
  CHECK(base::chi_square_quantile(0.0, 3.0) == kInfinity);
  CHECK(base::chi_square_quantile(1.0, 3.0) == 0.0);
  CHECK(std::isnan(base::covering_half_width(1.0, 0.0)));
}

}  // namespace
}  // namespace jointid::tests
