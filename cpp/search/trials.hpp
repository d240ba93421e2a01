#pragma once
// Many searches of one penalty: each on one thread, side by side over the pool's workers. What a
// population needs a hundred threads for, a study does with as many as there are cores.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "search/genetic.hpp"

namespace jointid::search {

struct Trial {
  GaOptions options;
  std::uint64_t seed = 0;
};

/// What is left of a search when thousands are kept: no history, no state.
struct TrialResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  std::int64_t evaluations = 0;
  std::int64_t generations = 0;
  Stop stop = Stop::generations;
};

enum class Searcher { genetic, random };

/// One result a trial, in their order: the same bits as each search for itself, whatever the number
/// of threads. Throws what the pool's poll throws, within one evaluation.
std::vector<TrialResult> minimise_trials(const Objective& objective, const Domain& domain,
                                         const std::vector<Trial>& trials, Searcher searcher,
                                         base::Pool& pool);

}  // namespace jointid::search
