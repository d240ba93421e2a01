#pragma once
// Genetic operators on genes scaled to [0, 1]. Each takes its uniform draws as arguments: published
// distributions are then testable number by number, and the source of randomness is the caller's
// business.

#include <utility>

namespace jointid::search {

/// Simulated binary crossover of one gene (Deb and Agrawal 1995; thesis 3-2, 3-3): the children lie
/// symmetrically about the parents' mean, spread by (2u)^(1/(eta+1)) for u <= 1/2, else (2 -
/// 2u)^(-1/(eta+1)). Clamped to [0, 1].
std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta);

/// Non-uniform mutation of one gene (Michalewicz; thesis 3-4, 3-5): a step towards a bound, 1 -
/// u^((1-progress)^exponent) of the way, so that steps shrink as progress goes from 0 to 1.
/// `towards_upper` chooses the bound.
double non_uniform_mutation(double gene, double u, bool towards_upper, double progress,
                            double exponent);

}  // namespace jointid::search
