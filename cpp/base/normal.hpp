#pragma once
// The normal distribution in plain arithmetic, so that intervals are the same bits on any host.

namespace jointid::base {

/// ln Gamma(a + 1/2) - ln Gamma(a), a > 0.
double log_half_step(double a);

/// ln Gamma(a) minus Stirling's (a - 1/2) ln a - a + ln(2 pi) / 2, a > 0.
double stirling_rest(double a);

/// ln(1 + x), x > -1, also for the smallest x.
double log_one_plus(double x);

/// The density at x.
double normal_density(double x);

/// The probability beyond x, with small relative error also far out; 0 beyond 37.
double normal_tail(double x);

/// The value beyond which this probability lies; infinite for 0 and 1, NaN outside [0, 1].
double normal_quantile(double tail);

/// Half the width of the symmetric interval that covers a normal variable of mean `offset` and
/// deviation 1 with this probability (0 to 1, exclusive).
double covering_half_width(double probability, double offset);

}  // namespace jointid::base
