#pragma once
// Genetic operators on genes scaled to [0, 1]. Each takes its uniform draws as arguments, so that
// published distributions can be tested number by number. The caller chooses the source of random
// numbers.

#include <cstddef>
#include <utility>

namespace jointid::search {

/// Simulated binary crossover of one gene (Deb and Agrawal 1995; thesis 3-2, 3-3). The children lie
/// symmetrically about the parents' mean. Their spread is (2u)^(1/(eta+1)) for u <= 1/2, otherwise
/// (2 - 2u)^(-1/(eta+1)). Clamped to [0, 1].
std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta);

/// simulated_binary_crossover in two steps: the spread factors of many draws at once (u in, spread
/// out), and the children for one factor.
void spread_factors(double* draws, std::size_t count, double eta);
std::pair<double, double> spread_children(double first, double second, double spread);

/// Blend crossover of one gene, BLX-alpha (Eshelman and Schaffer 1993; thesis 3-1). A child is
/// uniform over the parents' interval, extended by alpha times its length at both ends. Two draws,
/// two children. Clamped to [0, 1].
std::pair<double, double> blend_crossover(double first, double second, double u, double v,
                                          double alpha);

/// Non-uniform mutation of one gene (Michalewicz; thesis 3-4, 3-5): a step towards a bound by the
/// share 1 - u^((1-progress)^exponent) of the distance. Steps shrink as progress goes from 0 to 1.
/// `towards_upper` chooses the bound.
double non_uniform_mutation(double gene, double u, bool towards_upper, double progress,
                            double exponent);

/// The mutation of the thesis's listing: a step towards a bound by the share u
/// (1-progress)^exponent of the distance. It is uniform up to a reach that shrinks; the steps of
/// 3-5 crowd near zero.
double shrinking_mutation(double gene, double u, bool towards_upper, double progress,
                          double exponent);

/// Polynomial mutation of one gene (Deb and Agrawal 1999). The step d has the density (eta+1)/2
/// (1-|d|)^eta over -1 < d < 1, in units of the distance to the bound in its direction (Deb and Deb
/// 2014). It stays in the domain without clamping.
double polynomial_mutation(double gene, double u, double eta);

}  // namespace jointid::search
