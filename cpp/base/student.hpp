#pragma once
// Quantiles of Student's t and of chi-square, in plain arithmetic.

namespace jointid::base {

/// The value below which Student's t lies with `probability`. The degrees of freedom are above 0,
/// whole or not, or infinite. Infinite for 0 and 1, NaN outside [0, 1].
double student_quantile(double probability, double freedom);

/// The value beyond which chi-square lies with probability `tail`. The degrees of freedom are above
/// 0. Infinite for 0, 0 for 1, NaN outside [0, 1].
double chi_square_quantile(double tail, double freedom);

}  // namespace jointid::base
