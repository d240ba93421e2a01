#include "search/brent.hpp"

#include <cmath>

namespace jointid::search {

namespace {

constexpr double kGolden = 0.6180339887498949;

}  // namespace

double minimise_brent(const std::function<double(double)>& value, Interval interval,
                      double tolerance) {
  auto [left, right] = interval;
  struct Point {
    double at;
    double value;
  };
  const double begin = left + (1.0 - kGolden) * (right - left);
  Point best{begin, value(begin)};
  Point second = best;
  Point third = best;
  double step = 0.0;
  double before = 0.0;  // the step before the last
  for (;;) {
    const double middle = 0.5 * (left + right);
    if (std::fabs(best.at - middle) <= 2.0 * tolerance - 0.5 * (right - left)) break;
    // The parabola's lowest point is best.at + p / q.
    const double r = (best.at - second.at) * (best.value - third.value);
    double q = (best.at - third.at) * (best.value - second.value);
    double p = (best.at - third.at) * q - (best.at - second.at) * r;
    q = 2.0 * (q - r);
    p = q > 0.0 ? -p : p;
    q = std::fabs(q);
    if (std::fabs(p) < std::fabs(0.5 * q * before) && p > q * (left - best.at) &&
        p < q * (right - best.at)) {
      before = step;
      step = p / q;
      const double to = best.at + step;
      if (to - left < 2.0 * tolerance || right - to < 2.0 * tolerance) {
        step = best.at < middle ? tolerance : -tolerance;
      }
    } else {
      before = (best.at < middle ? right : left) - best.at;
      step = (1.0 - kGolden) * before;
    }
    if (std::fabs(step) < tolerance) step = step > 0.0 ? tolerance : -tolerance;
    const double at = best.at + step;
    const Point next{at, value(at)};
    if (next.value <= best.value) {
      (next.at < best.at ? right : left) = best.at;
      third = second;
      second = best;
      best = next;
    } else {
      (next.at < best.at ? left : right) = next.at;
      if (next.value <= second.value || second.at == best.at) {
        third = second;
        second = next;
      } else if (next.value <= third.value || third.at == best.at || third.at == second.at) {
        third = next;
      }
    }
  }
  return best.at;
}

}  // namespace jointid::search
