#pragma once
// The minimum of a function of one variable in an interval (Brent 1973, chapter 5): parabolas
// through the last points, and golden sections where parabolas fail.

#include <functional>

namespace jointid::search {

struct Interval {
  double left;
  double right;
};

/// The point of the lowest value found, to an absolute tolerance: a local minimum of the interval.
/// The ends of the interval are not evaluated.
double minimise_brent(const std::function<double(double)>& value, Interval interval,
                      double tolerance);

}  // namespace jointid::search
