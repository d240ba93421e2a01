// Genetic operators compared with their published distributions.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "search/operators.hpp"

namespace jointid::tests {
namespace {

using search::blend_crossover;
using search::non_uniform_mutation;
using search::polynomial_mutation;
using search::shrinking_mutation;
using search::simulated_binary_crossover;

constexpr int kDraws = 100'000;

/// Largest distance between the empirical distribution and `cumulative` (Kolmogorov and Smirnov).
template <class Cumulative>
double distance(std::vector<double> values, Cumulative cumulative) {
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = cumulative(values[i]);
    largest = std::max({largest, std::fabs(expected - static_cast<double>(i) / count),
                        std::fabs(expected - static_cast<double>(i + 1) / count)});
  }
  return largest;
}

const double kFar = 2.0 / std::sqrt(kDraws);  // exceeded by chance once in 1500

/// Deb and Agrawal's density of the spread factor.
double spread_density(double spread, double eta) {
  return spread <= 1.0 ? 0.5 * (eta + 1.0) * std::pow(spread, eta)
                       : 0.5 * (eta + 1.0) / std::pow(spread, eta + 2.0);
}

CHECK_CASE("operators: SBX children lie about their parents' mean") {
  base::Random random(1, 0, 0, 0);
  for (int i = 0; i < kDraws; ++i) {
    const double first = random.uniform();
    const double second = random.uniform();
    const double u = random.uniform();
    const double eta = 20.0 * random.uniform();
    const auto [one, two] = simulated_binary_crossover(first, second, u, eta);
    CHECK(one >= 0.0 && one <= 1.0 && two >= 0.0 && two <= 1.0);
    const bool clamped = one == 0.0 || one == 1.0 || two == 0.0 || two == 1.0;
    if (!clamped) CHECK_CLOSE(one + two, first + second, 1e-15 + 1e-15 * (first + second));
    if (u <= 0.5) {  // contracting
      CHECK(std::fabs(one - two) <= std::fabs(first - second) * (1.0 + 1e-14));
    }
  }
}

CHECK_CASE("operators: SBX keeps equal parents, and parents' sides") {
  base::Random random(2, 0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const double gene = random.uniform();
    const double u = random.uniform();
    const auto [one, two] = simulated_binary_crossover(gene, gene, u, 5.0);
    CHECK(one == gene && two == gene);
    const auto [low, high] = simulated_binary_crossover(0.4, 0.6, u, 5.0);
    CHECK(low <= high);
    const auto [swapped_high, swapped_low] = simulated_binary_crossover(0.6, 0.4, u, 5.0);
    CHECK_CLOSE(swapped_high, high, 1e-15);
    CHECK_CLOSE(swapped_low, low, 1e-15);
  }
}

CHECK_CASE("operators: SBX's spread factor has the published density") {
  for (const double eta : {0.5, 2.0, 5.0, 20.0}) {
    base::Random random(3, 0, 0, 0);
    const double half = 1e-7;  // so near that no child is clamped
    std::vector<double> spreads;
    for (int i = 0; i < kDraws; ++i) {
      const auto [one, two] =
          simulated_binary_crossover(0.5 - half, 0.5 + half, random.uniform(), eta);
      spreads.push_back((two - one) / (2.0 * half));
    }
    // The distribution function, by the trapezoidal rule over a table of the density.
    constexpr int kTable = 200'000;
    constexpr double kLast = 20.0;
    std::vector<double> table(kTable + 1, 0.0);
    for (std::size_t i = 1; i <= kTable; ++i) {
      const double step = kLast / kTable;
      const double left = static_cast<double>(i - 1) * step;
      table[i] = table[i - 1] +
                 0.5 * step * (spread_density(left, eta) + spread_density(left + step, eta));
    }
    const double far = distance(spreads, [&](double spread) {
      if (spread >= kLast) return 1.0 - 0.5 * std::pow(spread, -(eta + 1.0));
      return table[static_cast<std::size_t>(spread / kLast * kTable)];
    });
    CHECK_WITH(far < kFar, "eta " + std::to_string(eta) + ": " + std::to_string(far));
  }
}

CHECK_CASE("operators: SBX at the ends of its draw is finite") {
  for (const double u : {0x1p-54, 0.5, std::nextafter(0.5, 1.0), std::nextafter(1.0, 0.0)}) {
    for (const double eta : {0.0, 1.0, 100.0}) {
      const auto [one, two] = simulated_binary_crossover(0.2, 0.9, u, eta);
      CHECK(one >= 0.0 && one <= two && two <= 1.0);
    }
  }
}

CHECK_CASE("operators: non-uniform mutation has the published distribution") {
  // A step moves by the share 1 - u^e of the distance to a bound, e = (1 - progress)^exponent. The
  // share x has the distribution function 1 - (1 - x)^(1/e).
  for (const double exponent : {1.0, 2.0, 5.0}) {
    for (const double progress : {0.0, 0.3, 0.8}) {
      for (const bool upper : {false, true}) {
        base::Random random(4, 0, 0, 0);
        const double gene = 0.3;
        std::vector<double> shares;
        for (int i = 0; i < kDraws; ++i) {
          const double moved =
              non_uniform_mutation(gene, random.uniform(), upper, progress, exponent);
          shares.push_back(upper ? (moved - gene) / (1.0 - gene) : (gene - moved) / gene);
        }
        const double e = std::pow(1.0 - progress, exponent);
        const double far =
            distance(shares, [&](double x) { return 1.0 - std::pow(1.0 - x, 1.0 / e); });
        CHECK_WITH(far < kFar, std::to_string(progress) + ": " + std::to_string(far));
      }
    }
  }
}

CHECK_CASE("operators: non-uniform mutation shrinks, and stays in the domain") {
  base::Random random(5, 0, 0, 0);
  for (int i = 0; i < 20'000; ++i) {
    const double gene = random.uniform();
    const double u = random.uniform();
    const bool upper = random.uniform() < 0.5;
    double previous = 2.0;
    for (int g = 0; g <= 10; ++g) {
      const double moved = non_uniform_mutation(gene, u, upper, 0.1 * g, 2.0);
      CHECK(moved >= 0.0 && moved <= 1.0);
      CHECK(upper ? moved >= gene : moved <= gene);
      CHECK(std::fabs(moved - gene) <= previous);
      previous = std::fabs(moved - gene);
    }
    CHECK(non_uniform_mutation(gene, u, upper, 1.0, 2.0) == gene);
  }
  for (const double edge : {0.0, 1.0}) {
    CHECK(non_uniform_mutation(edge, 1e-300, edge == 1.0, 0.0, 2.0) == edge);
    CHECK_CLOSE(non_uniform_mutation(edge, 1e-300, edge == 0.0, 0.0, 2.0), 1.0 - edge, 1e-15);
  }
}

CHECK_CASE("operators: BLX children are uniform over the widened interval, each by its own draw") {
  for (const double alpha : {0.0, 0.5, 1.0}) {
    base::Random random(6, 0, 0, 0);
    std::vector<double> first;
    std::vector<double> second;
    double product = 0.0;
    for (int i = 0; i < kDraws; ++i) {
      const bool swapped = random.uniform() < 0.5;
      const double u = random.uniform();
      const auto [one, two] =
          blend_crossover(swapped ? 0.55 : 0.45, swapped ? 0.45 : 0.55, u, random.uniform(), alpha);
      first.push_back(one);
      second.push_back(two);
      product += (one - 0.5) * (two - 0.5);
    }
    const double reach = 0.05 + 0.1 * alpha;  // either side of the middle
    const auto uniform = [&](double x) { return (x - 0.5 + reach) / (2.0 * reach); };
    CHECK(distance(first, uniform) < kFar);
    CHECK(distance(second, uniform) < kFar);
    CHECK_CLOSE(product / kDraws, 0.0, reach * reach / std::sqrt(kDraws));  // 3 standard deviations
  }
}

CHECK_CASE("operators: BLX stays in the domain and keeps equal parents") {
  base::Random random(7, 0, 0, 0);
  for (int i = 0; i < 10'000; ++i) {
    const double first = random.uniform();
    const double u = random.uniform();
    const auto [one, two] = blend_crossover(first, random.uniform(), u, random.uniform(), 3.0);
    CHECK(one >= 0.0 && one <= 1.0 && two >= 0.0 && two <= 1.0);
    const auto [same, again] = blend_crossover(first, first, u, u, 0.5);
    CHECK(same == first && again == first);
  }
}

CHECK_CASE("operators: shrinking mutation is uniform up to its reach") {
  for (const double progress : {0.0, 0.3, 0.8}) {
    for (const bool upper : {false, true}) {
      base::Random random(8, 0, 0, 0);
      const double gene = 0.3;
      const double reach = std::pow(1.0 - progress, 2.0) * (upper ? 1.0 - gene : gene);
      std::vector<double> steps;
      for (int i = 0; i < kDraws; ++i) {
        const double moved = shrinking_mutation(gene, random.uniform(), upper, progress, 2.0);
        steps.push_back(upper ? moved - gene : gene - moved);
      }
      const double far = distance(steps, [&](double x) { return x / reach; });
      CHECK_WITH(far < kFar, std::to_string(progress) + ": " + std::to_string(far));
    }
  }
  CHECK(shrinking_mutation(0.3, 0.9, true, 1.0, 2.0) == 0.3);
}

CHECK_CASE("operators: polynomial mutation has the published density, and stays in the domain") {
  // (eta+1)/2 (1-|d|)^eta has the distribution function (1+d)^(eta+1)/2 below 0, and its mirror
  // above.
  for (const double eta : {0.0, 1.0, 20.0, 100.0}) {
    for (const double gene : {0.3, 0.9}) {
      base::Random random(9, 0, 0, 0);
      std::vector<double> steps;
      for (int i = 0; i < kDraws; ++i) {
        const double moved = polynomial_mutation(gene, random.uniform(), eta);
        CHECK(moved >= 0.0 && moved <= 1.0);
        steps.push_back(moved > gene ? (moved - gene) / (1.0 - gene) : (moved - gene) / gene);
      }
      const double far = distance(steps, [&](double d) {
        return d <= 0.0 ? 0.5 * std::pow(1.0 + d, eta + 1.0)
                        : 1.0 - 0.5 * std::pow(1.0 - d, eta + 1.0);
      });
      CHECK_WITH(far < kFar, "eta " + std::to_string(eta) + ": " + std::to_string(far));
    }
  }
  for (const double edge : {0.0, 1.0}) {
    CHECK(polynomial_mutation(edge, edge == 0.0 ? 0.1 : 0.9, 20.0) == edge);
  }
}

}  // namespace
}  // namespace jointid::tests
