#include "search/operators.hpp"

#include <algorithm>

#include "base/elementary.hpp"

namespace jointid::search {

std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta) {
  const double power = 1.0 / (eta + 1.0);
  const double spread = u <= 0.5 ? base::pow(2.0 * u, power) : base::pow(2.0 - 2.0 * u, -power);
  const double middle = 0.5 * (first + second);
  const double half = 0.5 * spread * (second - first);
  return {std::clamp(middle - half, 0.0, 1.0), std::clamp(middle + half, 0.0, 1.0)};
}

double non_uniform_mutation(double gene, double u, bool towards_upper, double progress,
                            double exponent) {
  const double reach = 1.0 - base::pow(u, base::pow(1.0 - progress, exponent));
  return towards_upper ? gene + (1.0 - gene) * reach : gene - gene * reach;
}

}  // namespace jointid::search
