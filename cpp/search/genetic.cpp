#include "search/genetic.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "base/random.hpp"
#include "search/operators.hpp"

namespace jointid::search {

namespace {

void require(bool holds, const char* name, double value, const char* limit) {
  if (holds) return;
  std::ostringstream text;
  text.precision(15);
  text << "GaOptions." << name << " must be " << limit << ", got " << value;
  throw std::invalid_argument(text.str());
}

bool probability(double p) {
  return p >= 0.0 && p <= 1.0;
}

/// The generation's individuals: genes in [0, 1], one individual a column.
class Breeder {
 public:
  Breeder(const GaOptions& options, std::uint64_t seed, std::uint32_t trial)
      : options_(options), seed_(seed), trial_(trial) {}

  void first(Eigen::MatrixXd& genes) const {
    for (Eigen::Index i = 0; i < genes.cols(); ++i) {
      base::Random random(seed_, trial_, 0, static_cast<std::uint32_t>(i));
      for (Eigen::Index j = 0; j < genes.rows(); ++j) genes(j, i) = random.uniform();
    }
  }

  /// order: individuals from best to worst.
  void next(int generation, const Eigen::MatrixXd& parents, const std::vector<Eigen::Index>& order,
            Eigen::MatrixXd& children) const {
    const Eigen::Index count = parents.cols();
    for (Eigen::Index i = 0; i < options_.elite; ++i) {
      children.col(i) = parents.col(order[static_cast<std::size_t>(i)]);
    }
    const double progress = static_cast<double>(generation) / options_.generations;
    Eigen::VectorXd spare(parents.rows());  // the second child of an odd last pair
    for (Eigen::Index i = options_.elite; i < count; i += 2) {
      base::Random random(seed_, trial_, static_cast<std::uint32_t>(generation),
                          static_cast<std::uint32_t>(i));
      const auto first = parents.col(select(random, order));
      const auto second = parents.col(select(random, order));
      auto one = children.col(i);
      auto two = i + 1 < count ? children.col(i + 1) : Eigen::Ref<Eigen::VectorXd>(spare);
      cross(random, first, second, one, two);
      mutate(random, progress, one);
      mutate(random, progress, two);
    }
  }

 private:
  using Genes = Eigen::Ref<Eigen::VectorXd>;

  /// Tournament on ranks: the lowest of `tournament` draws wins.
  [[nodiscard]] Eigen::Index select(base::Random& random,
                                    const std::vector<Eigen::Index>& order) const {
    auto rank = static_cast<std::uint32_t>(order.size());
    for (int i = 0; i < options_.tournament; ++i) {
      rank = std::min(rank, random.below(static_cast<std::uint32_t>(order.size())));
    }
    return order[rank];
  }

  void cross(base::Random& random, const Eigen::Ref<const Eigen::VectorXd>& first,
             const Eigen::Ref<const Eigen::VectorXd>& second, Genes one, Genes two) const {
    one = first;
    two = second;
    if (random.uniform() >= options_.crossover_probability) return;
    for (Eigen::Index j = 0; j < one.size(); ++j) {
      if (random.uniform() >= 0.5)
        continue;  // a gene crosses with probability one half, as in Deb's SBX
      const auto [a, b] =
          simulated_binary_crossover(first[j], second[j], random.uniform(), options_.crossover_eta);
      one[j] = a;
      two[j] = b;
    }
  }

  void mutate(base::Random& random, double progress, Genes genes) const {
    for (Eigen::Index j = 0; j < genes.size(); ++j) {
      if (random.uniform() >= options_.mutation_probability) continue;
      const bool upper = random.uniform() < 0.5;
      genes[j] = non_uniform_mutation(genes[j], random.uniform(), upper, progress,
                                      options_.mutation_exponent);
    }
  }

  const GaOptions& options_;
  std::uint64_t seed_;
  std::uint32_t trial_;
};

}  // namespace

void GaOptions::validate() const {
  require(population >= 4 && population <= 1'000'000, "population", population, "4 to 1000000");
  require(generations >= 1 && generations <= 10'000'000, "generations", generations,
          "1 to 10000000");
  require(tournament >= 1 && tournament <= population, "tournament", tournament, "1 to population");
  require(elite >= 0 && elite < population, "elite", elite, "0 to population - 1");
  require(probability(crossover_probability), "crossover_probability", crossover_probability,
          "0 to 1");
  require(crossover_eta >= 0.0 && std::isfinite(crossover_eta), "crossover_eta", crossover_eta,
          "at least 0");
  require(probability(mutation_probability), "mutation_probability", mutation_probability,
          "0 to 1");
  require(mutation_exponent > 0.0 && std::isfinite(mutation_exponent), "mutation_exponent",
          mutation_exponent, "above 0");
  require(tolerance >= 0.0 && std::isfinite(tolerance), "tolerance", tolerance, "at least 0");
}

GaResult minimise_genetic(const Objective& objective, const Domain& domain,
                          const GaOptions& options, std::uint64_t seed, std::uint32_t trial,
                          base::Pool& pool, const Observer& observer) {
  options.validate();
  domain.validate();
  const auto free = domain.free();
  const auto genes_each = static_cast<Eigen::Index>(free.size());
  const Eigen::Index count = options.population;
  const Breeder breeder(options, seed, trial);

  Eigen::MatrixXd genes(genes_each, count);
  Eigen::MatrixXd children(genes_each, count);
  Eigen::MatrixXd candidates = domain.lower.replicate(1, count);
  Eigen::VectorXd penalties(count);
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count));
  GaResult result;
  breeder.first(genes);
  for (int generation = 0;; ++generation) {
    for (Eigen::Index j = 0; j < genes_each; ++j) {
      const auto parameter = free[static_cast<std::size_t>(j)];
      const double low = domain.lower[parameter];
      const double high = domain.upper[parameter];
      // Convex form: stays inside the bounds to the last bit.
      candidates.row(parameter) = ((1.0 - genes.row(j).array()) * low + genes.row(j).array() * high)
                                      .cwiseMax(low)
                                      .cwiseMin(high);
    }
    objective(candidates, penalties, pool);
    result.evaluations += count;
    // A penalty that is not a number must lose, and ties must not depend on the sort.
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!(penalties[i] == penalties[i])) penalties[i] = std::numeric_limits<double>::infinity();
    }
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
      return penalties[a] != penalties[b] ? penalties[a] < penalties[b] : a < b;
    });
    const double best = penalties[order.front()];
    const double worst = penalties[order.back()];
    if (generation == 0 || best < result.penalty) {
      result.penalty = best;
      result.best = candidates.col(order.front());
    }
    result.history.push_back({generation, result.penalty, penalties.mean(), result.evaluations});
    pool.poll();
    if (observer && observer(result.history.back())) {
      result.stop = Stop::observer;
      break;
    }
    if (worst - best <= options.tolerance * std::fabs(best) && options.tolerance > 0.0) {
      result.stop = Stop::converged;
      break;
    }
    if (generation == options.generations) break;
    breeder.next(generation + 1, genes, order, children);
    genes.swap(children);
  }
  return result;
}

}  // namespace jointid::search
