#include "search/selection.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace jointid::search {

namespace {

/// Penalty over the least penalty (1 at best), so that no power overflows. If the least penalty is
/// 0, the penalty itself.
double relative(double least, double penalty) {
  return penalty == least ? 1.0 : least / penalty;
}

/// Passes each fitness on, in order.
template <class Take>
void each_sum_minus(const Penalties& penalties, Take take) {
  double largest = 0.0;
  for (const double p : penalties) {
    if (std::isfinite(p)) largest = std::max(largest, p);
  }
  const double unit = largest > 0.0 ? 1.0 / largest : 1.0;
  double sum = 0.0;
  double best = 0.0;
  for (const double p : penalties) sum += std::isfinite(p) ? std::max(0.0, p) * unit : 0.0;
  const auto of = [&](double p) {
    return std::isfinite(p) ? std::max(0.0, sum - std::max(0.0, p) * unit) : 0.0;
  };
  for (const double p : penalties) best = std::max(best, of(p));
  // All penalties are zero, or only one is finite: any finite individual is chosen.
  for (const double p : penalties) take(best > 0.0 ? of(p) : (std::isfinite(p) ? 1.0 : 0.0));
}

template <class Take>
void each_fitness(Fitness fitness, const Penalties& penalties, Take take) {
  const double least = std::max(0.0, penalties.minCoeff());
  if (!std::isfinite(least)) {
    for (Eigen::Index i = 0; i < penalties.size(); ++i) take(1.0);
  } else if (fitness == Fitness::sum_minus) {
    each_sum_minus(penalties, take);
  } else {
    for (const double p : penalties) {
      const double share = relative(least, std::max(0.0, p));
      take(fitness == Fitness::inverse ? share : share * share);
    }
  }
}

}  // namespace

std::vector<Eigen::Index> ranked(const Penalties& penalties) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(penalties.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  // Ties must not depend on the sorting algorithm.
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return penalties[a] != penalties[b] ? penalties[a] < penalties[b] : a < b;
  });
  return order;
}

Eigen::VectorXd fitness_of(Fitness fitness, const Penalties& penalties) {
  Eigen::VectorXd result(penalties.size());
  Eigen::Index i = 0;
  each_fitness(fitness, penalties, [&](double value) { result[i++] = value; });
  return result;
}

double diversity_of(const GaOptions& options, const Penalties& penalties) {
  double sum = 0.0;
  const auto count = static_cast<double>(penalties.size());
  if (options.diversity == Diversity::fitness) {
    double largest = 0.0;
    each_fitness(options.fitness, penalties, [&](double value) {
      sum += value;
      largest = std::max(largest, value);
    });
    return std::min(1.0, sum / count / largest);
  }
  const double least = std::max(0.0, penalties.minCoeff());
  for (const double p : penalties) sum += std::max(0.0, p);
  const double mean = sum / count;
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

void Selector::prepare(const Penalties& penalties) {
  penalties_ = penalties.data();
  count_ = penalties.size();
  find_elite();
  if (options_.selection == Selection::tournament) return;
  double sum = 0.0;
  shares_.clear();
  if (options_.selection == Selection::roulette) {
    each_fitness(options_.fitness, penalties,
                 [&](double fitness) { shares_.push_back(sum += fitness); });
  } else {
    order_ = ranked(penalties);
    // Linear ranking (Baker 1985): expected copies fall linearly from the pressure to 2 - pressure.
    const double pressure = options_.rank_pressure;
    for (Eigen::Index rank = 0; rank < count_; ++rank) {
      const double place = static_cast<double>(rank) / (static_cast<double>(count_) - 1.0);
      shares_.push_back(sum += pressure - 2.0 * (pressure - 1.0) * place);
    }
  }
  index_shares();
}

/// The few best individuals by insertion: sorting all would cost more than the rest of breeding.
void Selector::find_elite() {
  const auto wanted = static_cast<std::size_t>(options_.elite);
  elite_.clear();
  if (wanted > 16) {
    elite_.resize(static_cast<std::size_t>(count_));
    std::iota(elite_.begin(), elite_.end(), Eigen::Index{0});
    const auto end = elite_.begin() + options_.elite;
    std::partial_sort(elite_.begin(), end, elite_.end(),
                      [&](Eigen::Index a, Eigen::Index b) { return better(a, b); });
    elite_.resize(wanted);
    return;
  }
  if (wanted == 0) return;
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (elite_.size() == wanted && !better(i, elite_.back())) continue;
    if (elite_.size() == wanted) elite_.pop_back();
    auto place = elite_.end();
    while (place != elite_.begin() && better(i, *(place - 1))) --place;
    elite_.insert(place, i);
  }
}

/// A draw then starts its search a step or two before its end (Chen and Asau 1974).
void Selector::index_shares() {
  const auto count = shares_.size();
  guide_.resize(count);
  std::size_t at = 0;
  for (std::size_t part = 0; part < count; ++part) {
    const double begin = shares_.back() * static_cast<double>(part) / static_cast<double>(count);
    while (at + 1 < count && shares_[at] < begin) ++at;
    guide_[part] = static_cast<std::uint32_t>(at);
  }
}

Eigen::Index Selector::operator()(base::Random& random) const {
  const auto count = static_cast<std::uint32_t>(count_);
  if (options_.selection == Selection::tournament) {
    auto winner = static_cast<Eigen::Index>(random.below(count));
    for (int i = 1; i < options_.tournament; ++i) {
      const auto other = static_cast<Eigen::Index>(random.below(count));
      winner = better(other, winner) ? other : winner;
    }
    return winner;
  }
  const double u = random.uniform();
  const double wanted = u * shares_.back();
  auto place = static_cast<std::size_t>(guide_[static_cast<std::size_t>(u * count)]);
  // Rounding of the guide may start it one place too far.
  while (place > 0 && shares_[place - 1] >= wanted) --place;
  while (place + 1 < shares_.size() && shares_[place] < wanted) ++place;
  return options_.selection == Selection::roulette ? static_cast<Eigen::Index>(place)
                                                   : order_[place];
}

}  // namespace jointid::search
