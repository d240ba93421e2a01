#pragma once
// Real-coded genetic algorithm. Minimises anything that can be evaluated a population at a time.
//
//   population <- uniform in the domain (and the starts given)
//   repeat: the elite survives; the rest are children of parents chosen by tournament,
//           crossed gene by gene (SBX), mutated (non-uniform);  evaluate;  report
//   until the generations are used up, the population has collapsed, or the observer says stop

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "search/domain.hpp"

namespace jointid::search {

struct GaOptions {
  int population = 60;                 ///< individuals, even, at least 4
  int generations = 120;               ///< at most
  int tournament = 2;                  ///< individuals that compete for each parent place
  int elite = 2;                       ///< best individuals that survive unchanged
  double crossover_probability = 0.9;  ///< of a pair
  double crossover_eta =
      5.0;  ///< SBX distribution index: larger keeps children nearer their parents
  double mutation_probability = 0.1;  ///< of a gene
  double mutation_exponent = 2.0;     ///< how fast mutation steps shrink over the generations
  double tolerance = 1e-10;  ///< stop when the spread (worst - best) / best falls below; 0: never
  bool polish = true;        ///< end with a local least-squares search from the best individual
  void validate() const;
};

enum class Stop { generations, converged, observer };

/// What the observer sees after each generation.
struct Generation {
  int number;
  double best;
  double mean;
  std::int64_t evaluations;
};

/// Called on the calling thread between generations; true stops.
using Observer = std::function<bool(const Generation&)>;
/// Penalties of candidates, one a column.
using Objective = std::function<void(const Eigen::MatrixXd&, Eigen::VectorXd&, base::Pool&)>;

struct GaResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  std::vector<Generation> history;
  std::int64_t evaluations = 0;
  Stop stop = Stop::generations;
};

/// The same bits for a seed and trial, whatever the number of threads: every draw is a function of
/// (seed, trial, generation, individual), and penalties do not depend on who computes them.
GaResult minimise_genetic(const Objective& objective, const Domain& domain,
                          const GaOptions& options, std::uint64_t seed, std::uint32_t trial,
                          base::Pool& pool, const Observer& observer);

}  // namespace jointid::search
