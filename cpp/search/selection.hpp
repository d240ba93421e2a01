#pragma once
// Who becomes a parent, and how often a population crosses and mutates.

#include <Eigen/Core>
#include <vector>

#include "base/random.hpp"
#include "search/genetic_options.hpp"

namespace jointid::search {

using Penalties = Eigen::Ref<const Eigen::VectorXd>;

/// Individuals from best to worst; equal ones in their own order.
std::vector<Eigen::Index> ranked(const Penalties& penalties);

/// Fitness of each individual, in units that differ between populations (roulette asks for shares
/// only): 1/P^2 (thesis 4.7), 1/P, or sum P - P (its listing). An infinite penalty has fitness 0, a
/// negative one counts as zero.
Eigen::VectorXd fitness_of(Fitness fitness, const Penalties& penalties);

/// The thesis's genetic diversity measure (3.2.2), near 0 when few are good and 1 when all are
/// alike: mean/max of the fitness, or min/mean of the penalty (its listing).
double diversity_of(const GaOptions& options, const Penalties& penalties);

struct Probabilities {
  double crossover;
  double mutation;
};

/// Linear between diversity_low and diversity_high, constant outside; constant when not adaptive.
Probabilities adapted(const GaOptions& options, double diversity);

/// Draws parents from an evaluated population. Kept from one generation to the next, it allocates
/// nothing after the first.
class Selector {
 public:
  explicit Selector(const GaOptions& options) : options_(options) {}
  Selector(const GaOptions& options, const Penalties& penalties) : Selector(options) {
    prepare(penalties);
  }

  /// Turns to a population; its penalties must outlive the draws.
  void prepare(const Penalties& penalties);
  /// An individual's number.
  [[nodiscard]] Eigen::Index operator()(base::Random& random) const;
  /// The best individuals, as many as the options' elite, best first.
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
  std::vector<std::uint32_t> guide_;  ///< for each of `count` equal parts, where its shares begin
};

}  // namespace jointid::search
