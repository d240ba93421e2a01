#pragma once
// Extremes over the samples of a signal, several samples in parallel. Passes over a whole recording
// start with them. Any order of the samples gives the same bits.

#include <cstddef>
#include <cstdint>

namespace jointid::base {

struct Range {
  double low;
  double high;
};
/// Range of at least one sample.
Range range_of(const double* x, std::size_t count);

struct Least {
  double any;       ///< infinite without a sample
  double positive;  ///< smallest size that is not 0; infinite if there is none
};
/// The smallest sizes |x|.
Least least_sizes(const double* x, std::size_t count);
/// The smallest sizes of `steps` steps from one sample to the next.
Least least_steps(const double* x, std::size_t steps);

/// Facts about a signal's samples and the steps between them.
struct Survey {
  Range range;
  double smallest;       ///< smallest step that is not 0; infinite if there is none
  std::int64_t changes;  ///< number of steps that are not 0
};
/// Survey of `steps` + 1 samples.
Survey survey(const double* x, std::size_t steps);

/// The largest height of a sample above or below both samples `width` apart, as the distance from
/// the nearer one. `places` samples are examined; 0 if none is on one side of both.
double largest_height(const double* x, std::size_t width, std::size_t places);

/// The largest |x[k + width] - x[k]| over the time between the two, k < count; 0 without one.
double largest_rate(const double* time, const double* x, std::size_t width, std::size_t count);

/// The number of samples, from the first on, with the sign of the first one; 0 if the first one is
/// 0. `count` finite samples, at least one.
std::size_t one_sided(const double* x, std::size_t count);

/// Whether every sample is a finite number.
bool all_finite(const double* x, std::size_t count);
/// Whether each of `steps` steps is upwards; the samples must be finite.
bool increases(const double* x, std::size_t steps);

}  // namespace jointid::base
