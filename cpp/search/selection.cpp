#include "search/selection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace jointid::search {

namespace {

/// Penalty over the least (1 at best), so that no power overflows; the least's own where it is 0.
double relative(double least, double penalty) {
  if (penalty == least) return 1.0;
  return least / penalty;
}

Eigen::VectorXd sum_minus(const Eigen::VectorXd& penalties) {
  double largest = 0.0;
  for (const double p : penalties) {
    if (std::isfinite(p)) largest = std::max(largest, p);
  }
  const double unit = largest > 0.0 ? 1.0 / largest : 1.0;
  double sum = 0.0;
  for (const double p : penalties) sum += std::isfinite(p) ? p * unit : 0.0;
  Eigen::VectorXd fitness(penalties.size());
  for (Eigen::Index i = 0; i < penalties.size(); ++i) {
    fitness[i] = std::isfinite(penalties[i]) ? std::max(0.0, sum - penalties[i] * unit) : 0.0;
  }
  if (fitness.maxCoeff() > 0.0) return fitness;
  // All penalties zero, or a single finite one: whoever is finite.
  for (Eigen::Index i = 0; i < penalties.size(); ++i) {
    fitness[i] = std::isfinite(penalties[i]) ? 1.0 : 0.0;
  }
  return fitness;
}

}  // namespace

std::vector<Eigen::Index> ranked(const Penalties& penalties) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(penalties.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  // Ties must not depend on the sort.
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return penalties[a] != penalties[b] ? penalties[a] < penalties[b] : a < b;
  });
  return order;
}

Eigen::VectorXd fitness_of(Fitness fitness, const Penalties& penalties) {
  const Eigen::VectorXd from_zero = penalties.cwiseMax(0.0);
  const double least = from_zero.minCoeff();
  if (!std::isfinite(least)) return Eigen::VectorXd::Ones(penalties.size());
  if (fitness == Fitness::sum_minus) return sum_minus(from_zero);
  return from_zero.unaryExpr([&](double p) {
    const double share = relative(least, p);
    return fitness == Fitness::inverse ? share : share * share;
  });
}

double diversity_of(const GaOptions& options, const Penalties& penalties) {
  if (options.diversity == Diversity::fitness) {
    const Eigen::VectorXd fitness = fitness_of(options.fitness, penalties);
    return std::min(1.0, fitness.mean() / fitness.maxCoeff());
  }
  const Eigen::VectorXd from_zero = penalties.cwiseMax(0.0);
  const double least = from_zero.minCoeff();
  const double mean = from_zero.mean();
  return mean == least ? 1.0 : std::min(1.0, least / mean);
}

Probabilities adapted(const GaOptions& options, double diversity) {
  if (!options.adaptive) return {options.crossover_probability, options.mutation_probability};
  const double along = std::clamp(
      (diversity - options.diversity_low) / (options.diversity_high - options.diversity_low), 0.0,
      1.0);
  const auto between = [&](double apart, double alike) {
    return (1.0 - along) * apart + along * alike;
  };
  return {between(options.crossover_probability, options.crossover_probability_alike),
          between(options.mutation_probability, options.mutation_probability_alike)};
}

Selector::Selector(const GaOptions& options, const Penalties& penalties)
    : selection_(options.selection), tournament_(options.tournament), order_(ranked(penalties)) {
  if (selection_ == Selection::tournament) return;
  const auto count = static_cast<double>(order_.size());
  double sum = 0.0;
  shares_.reserve(order_.size());
  if (selection_ == Selection::roulette) {
    for (const double fitness : fitness_of(options.fitness, penalties)) {
      shares_.push_back(sum += fitness);
    }
    return;
  }
  // Linear ranking (Baker 1985): expected copies fall linearly from the pressure to 2 - pressure.
  for (std::size_t rank = 0; rank < order_.size(); ++rank) {
    const double place = static_cast<double>(rank) / (count - 1.0);
    shares_.push_back(sum += options.rank_pressure - 2.0 * (options.rank_pressure - 1.0) * place);
  }
}

Eigen::Index Selector::operator()(base::Random& random) const {
  const auto count = static_cast<std::uint32_t>(order_.size());
  if (selection_ == Selection::tournament) {
    auto rank = count;
    for (int i = 0; i < tournament_; ++i) rank = std::min(rank, random.below(count));
    return order_[rank];
  }
  const auto found =
      std::lower_bound(shares_.begin(), shares_.end(), random.uniform() * shares_.back());
  const auto place =
      std::min<std::ptrdiff_t>(found - shares_.begin(), static_cast<std::ptrdiff_t>(count) - 1);
  return selection_ == Selection::roulette ? place : order_[static_cast<std::size_t>(place)];
}

}  // namespace jointid::search
