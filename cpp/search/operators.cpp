#include "search/operators.hpp"

#include <algorithm>

#include "base/elementary.hpp"

namespace jointid::search {

namespace {

double towards(double gene, bool upper, double share) {
  return upper ? gene + (1.0 - gene) * share : gene - gene * share;
}

}  // namespace

std::pair<double, double> simulated_binary_crossover(double first, double second, double u,
                                                     double eta) {
  const double power = 1.0 / (eta + 1.0);
  const double spread = u <= 0.5 ? base::pow(2.0 * u, power) : base::pow(2.0 - 2.0 * u, -power);
  const double middle = 0.5 * (first + second);
  const double half = 0.5 * spread * (second - first);
  return {std::clamp(middle - half, 0.0, 1.0), std::clamp(middle + half, 0.0, 1.0)};
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
