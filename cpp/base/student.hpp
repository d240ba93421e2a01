#pragma once
// Quantiles of Student's t and of chi-square, in plain arithmetic.

namespace jointid::base {

/// Below which `probability` of Student's t lies; degrees of freedom above 0, whole or not, also
/// infinite. Infinite for 0 and 1, NaN for what is neither.
double student_quantile(double probability, double freedom);

/// Beyond which `tail` of chi-square lies; degrees of freedom above 0. Infinite for 0, 0 for 1, NaN
/// for what is neither.
double chi_square_quantile(double tail, double freedom);

}  // namespace jointid::base
