#pragma once
// Extremes over the samples of a signal, several samples side by side: what passes over a whole
// recording ask for first. Any order of the samples gives the same bits.

#include <cstddef>
#include <cstdint>

namespace jointid::base {

struct Range {
  double low;
  double high;
};
/// Of at least one sample.
Range range_of(const double* x, std::size_t count);

struct Least {
  double any;       ///< infinite without a sample
  double positive;  ///< of those that are not 0; infinite without one
};
/// The smallest sizes |x|.
Least least_sizes(const double* x, std::size_t count);
/// The smallest sizes of `steps` steps from one sample to the next.
Least least_steps(const double* x, std::size_t steps);

/// What a signal's samples and the steps between them are like.
struct Survey {
  Range range;
  double smallest;       ///< of the steps that are not 0; infinite without one
  std::int64_t changes;  ///< steps that are not 0
};
/// Of `steps` + 1 samples.
Survey survey(const double* x, std::size_t steps);

/// Samples `width` apart from their neighbours on both sides, on the same side of both: the largest
/// distance from the nearer one, at `places` places; 0 without one.
double largest_height(const double* x, std::size_t width, std::size_t places);

/// The largest |x[k + width] - x[k]| over the time between both, k < count; 0 without one.
double largest_rate(const double* time, const double* x, std::size_t width, std::size_t count);

/// How many of `count` finite samples, at least one, have the first one's sign; 0 where that one
/// is 0.
std::size_t one_sided(const double* x, std::size_t count);

/// Whether no sample is infinite or no number.
bool all_finite(const double* x, std::size_t count);
/// Whether each of `steps` steps is upwards; of finite samples.
bool increases(const double* x, std::size_t steps);

}  // namespace jointid::base
