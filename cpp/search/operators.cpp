#include "search/operators.hpp"

#include <algorithm>

#include "base/clones.hpp"
#include "base/elementary.hpp"

namespace jointid::search {

namespace {

double towards(double gene, bool upper, double share) {
  return upper ? gene + (1.0 - gene) * share : gene - gene * share;
}

}  // namespace

JOINTID_CLONES void spread_factors(double* draws, std::size_t count, double eta) {
  const double power = 1.0 / (eta + 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    const bool contracting = draws[i] <= 0.5;
    const double argument = contracting ? 2.0 * draws[i] : 2.0 - 2.0 * draws[i];
    const double exponent = contracting ? power : -power;
    draws[i] = base::exp(exponent * base::log_normal(argument));
  }
}

std::pair<double, double> spread_children(double first, double second, double spread) {
  const double middle = 0.5 * (first + second);
  const double half = 0.5 * spread * (second - first);
  return {std::clamp(middle - half, 0.0, 1.0), std::clamp(middle + half, 0.0, 1.0)};
}

std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta) {
  spread_factors(&u, 1, eta);
  return spread_children(first, second, u);
}

std::pair<double, double> blend_crossover(double first, double second, double u, double v,
                                          double alpha) {
  const auto [low, high] = std::minmax(first, second);
  const double length = high - low;
  const double start = low - alpha * length;
  const double reach = (1.0 + 2.0 * alpha) * length;
  return {std::clamp(start + u * reach, 0.0, 1.0), std::clamp(start + v * reach, 0.0, 1.0)};
}

double non_uniform_mutation(double gene, double u, bool towards_upper, double progress,
                            double exponent) {
  return towards(gene, towards_upper, 1.0 - base::pow(u, base::pow(1.0 - progress, exponent)));
}

double shrinking_mutation(double gene, double u, bool towards_upper, double progress,
                          double exponent) {
  return towards(gene, towards_upper, u * base::pow(1.0 - progress, exponent));
}

double polynomial_mutation(double gene, double u, double eta) {
  const double power = 1.0 / (eta + 1.0);
  const bool upper = u > 0.5;
  return towards(gene, upper, 1.0 - base::pow(upper ? 2.0 - 2.0 * u : 2.0 * u, power));
}

}  // namespace jointid::search
