#pragma once
// Selection of parents, and the probabilities of crossover and mutation.

#include <Eigen/Core>
#include <vector>

#include "base/random.hpp"
#include "search/genetic_options.hpp"

namespace jointid::search {

using Penalties = Eigen::Ref<const Eigen::VectorXd>;

/// Individuals from best to worst; equal ones in their original order.
std::vector<Eigen::Index> ranked(const Penalties& penalties);

/// Fitness of each individual: 1/P^2 (thesis 4.7), 1/P, or sum P - P (thesis's listing). Its unit
/// differs between populations, because roulette needs only shares. An infinite penalty has fitness
/// 0; a negative penalty counts as zero.
Eigen::VectorXd fitness_of(Fitness fitness, const Penalties& penalties);

/// The thesis's genetic diversity measure (3.2.2): near 0 when few individuals are good, and 1 when
/// all are equal. It is mean/max of the fitness, or min/mean of the penalty (thesis's listing).
double diversity_of(const GaOptions& options, const Penalties& penalties);

struct Probabilities {
  double crossover;
  double mutation;
};

/// Linear between diversity_low and diversity_high, constant outside; constant without `adaptive`.
Probabilities adapted(const GaOptions& options, double diversity);

/// Draws parents from an evaluated population. Reused from generation to generation, it allocates
/// only in the first.
class Selector {
 public:
  explicit Selector(const GaOptions& options) : options_(options) {}
  Selector(const GaOptions& options, const Penalties& penalties) : Selector(options) {
    prepare(penalties);
  }

  /// Switches to a population. Its penalties must outlive the draws.
  void prepare(const Penalties& penalties);
  /// The index of an individual.
  [[nodiscard]] Eigen::Index operator()(base::Random& random) const;
  /// The `elite` best individuals, best first.
  [[nodiscard]] const std::vector<Eigen::Index>& elite() const { return elite_; }

 private:
  [[nodiscard]] bool better(Eigen::Index one, Eigen::Index other) const {
    const double a = penalties_[one];
    const double b = penalties_[other];
    return a < b || (a == b && one < other);
  }
  void find_elite();
  void index_shares();

  GaOptions options_;
  const double* penalties_ = nullptr;
  Eigen::Index count_ = 0;
  std::vector<Eigen::Index> elite_;
  std::vector<Eigen::Index> order_;   ///< by rank (rank selection)
  std::vector<double> shares_;        ///< running sums: by individual (roulette) or by rank
  std::vector<std::uint32_t> guide_;  ///< start of the shares in each of `count` equal parts
};

}  // namespace jointid::search
