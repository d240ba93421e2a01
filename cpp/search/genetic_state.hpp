#pragma once
// The complete state of the genetic algorithm between two generations: the content of a checkpoint.

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "search/domain.hpp"
#include "search/genetic_options.hpp"

namespace jointid::search {

/// One generation, as the observer receives it.
struct Generation {
  int number;
  double best;       ///< so far
  double mean;       ///< mean over all islands' individuals
  double diversity;  ///< the measure of the options, 1 when all are equal; mean of the islands
  double crossover_probability;  ///< probability for the next generation; mean of the islands
  double mutation_probability;
  std::int64_t evaluations;
};

/// An evaluated population and its history. Random numbers need no state: they are counted by seed,
/// trial, generation and individual.
struct GaState {
  GaOptions options;
  std::uint64_t seed = 0;
  std::uint32_t trial = 0;
  Domain domain;
  int generation = 0;         ///< the last evaluated generation
  Eigen::MatrixXd genes;      ///< free parameters x individuals, in [0, 1]
  Eigen::VectorXd penalties;  ///< penalties of the individuals
  Eigen::VectorXd best;       ///< parameters of the best individual so far
  double penalty = 0.0;       ///< penalty of the best individual
  std::int64_t evaluations = 0;
  std::vector<Generation> history;
};

/// Exact, with a checksum. from_bytes throws std::invalid_argument for any other content.
std::string to_bytes(const GaState& state);
GaState state_from_bytes(std::string_view bytes);

/// Throws std::invalid_argument with the first difference that would change a continued run.
void require_same_run(const GaState& state, const GaOptions& options, const Domain& domain,
                      std::uint64_t seed, std::uint32_t trial);

}  // namespace jointid::search
