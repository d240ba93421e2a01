#pragma once
// Many searches of one penalty in parallel, each on one thread of the pool. One search per core is
// faster than all cores on one search.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "search/genetic.hpp"

namespace jointid::search {

struct Trial {
  GaOptions options;
  std::uint64_t seed = 0;
};

/// Short result of a search, without history and state, because thousands are kept.
struct TrialResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  std::int64_t evaluations = 0;
  std::int64_t generations = 0;
  Stop stop = Stop::generations;
};

enum class Searcher { genetic, random };

/// Returns one result per trial, in their order. The bits are those of separate searches, for any
/// number of threads. Throws what the pool's poll throws, within the time of one evaluation.
std::vector<TrialResult> minimise_trials(const Objective& objective, const Domain& domain,
                                         const std::vector<Trial>& trials, Searcher searcher,
                                         base::Pool& pool);

}  // namespace jointid::search
