#pragma once
// Genetic operators on genes scaled to [0, 1]. Each takes its uniform draws as arguments: published
// distributions are then testable number by number, and the source of randomness is the caller's
// business.

#include <cstddef>
#include <utility>

namespace jointid::search {

/// Simulated binary crossover of one gene (Deb and Agrawal 1995; thesis 3-2, 3-3): the children lie
/// symmetrically about the parents' mean, spread by (2u)^(1/(eta+1)) for u <= 1/2, else (2 -
/// 2u)^(-1/(eta+1)). Clamped to [0, 1].
std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta);

/// The spread factors of many draws at once (u in, spread out), and the children for one: what
/// simulated_binary_crossover does, in two steps.
void spread_factors(double* draws, std::size_t count, double eta);
std::pair<double, double> spread_children(double first, double second, double spread);

/// Blend crossover of one gene, BLX-alpha (Eshelman and Schaffer 1993; thesis 3-1): a child is
/// uniform over the parents' interval widened by alpha of its length at either end. Two draws, two
/// children. Clamped to [0, 1].
std::pair<double, double> blend_crossover(double first, double second, double u, double v,
                                          double alpha);

/// Non-uniform mutation of one gene (Michalewicz; thesis 3-4, 3-5): a step towards a bound, 1 -
/// u^((1-progress)^exponent) of the way, so that steps shrink as progress goes from 0 to 1.
/// `towards_upper` chooses the bound.
double non_uniform_mutation(double gene, double u, bool towards_upper, double progress,
                            double exponent);

/// The mutation of the thesis's listing: a step towards a bound, u (1-progress)^exponent of the
/// way. Uniform up to a reach that shrinks, where 3-5 crowds the steps near zero.
double shrinking_mutation(double gene, double u, bool towards_upper, double progress,
                          double exponent);

/// Polynomial mutation of one gene (Deb and Agrawal 1999): the step has the density (eta+1)/2
/// (1-|d|)^eta over -1 < d < 1, in units of the way to the bound it goes towards (Deb and Deb
/// 2014), so that it stays in the domain without clamping.
double polynomial_mutation(double gene, double u, double eta);

}  // namespace jointid::search
