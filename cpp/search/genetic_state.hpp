#pragma once
// All that a run of the genetic algorithm knows between two generations: what a checkpoint holds.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "search/domain.hpp"
#include "search/genetic_options.hpp"

namespace jointid::search {

/// One generation, as the observer sees it.
struct Generation {
  int number;
  double best;       ///< so far
  double mean;       ///< of all islands' individuals
  double diversity;  ///< by the options' measure, 1 when all are alike; mean of the islands
  double crossover_probability;  ///< that the next generation is bred with; mean of the islands
  double mutation_probability;
  std::int64_t evaluations;
};

/// An evaluated population and how it came about. Randomness has no state of its own: it is counted
/// by seed, trial, generation and individual.
struct GaState {
  GaOptions options;
  std::uint64_t seed = 0;
  std::uint32_t trial = 0;
  Domain domain;
  int generation = 0;         ///< the last evaluated
  Eigen::MatrixXd genes;      ///< free parameters x individuals, in [0, 1]
  Eigen::VectorXd penalties;  ///< of the individuals
  Eigen::VectorXd best;       ///< parameters of the best so far
  double penalty = 0.0;       ///< its penalty
  std::int64_t evaluations = 0;
  std::vector<Generation> history;
};

/// Exact, with a checksum; from_bytes throws std::invalid_argument for anything else.
std::string to_bytes(const GaState& state);
GaState state_from_bytes(std::string_view bytes);

/// Throws std::invalid_argument naming the first difference that would make a continued run another
/// run.
void require_same_run(const GaState& state, const GaOptions& options, const Domain& domain,
                      std::uint64_t seed, std::uint32_t trial);

}  // namespace jointid::search
