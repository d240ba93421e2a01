#pragma once
// The genetic algorithm. Minimises anything that can be evaluated a population at a time.
//
//   population <- uniform in the domain
//   repeat: the elite survives; the rest are children of selected parents, crossed and mutated with
//           probabilities that may follow the diversity;  evaluate;  report
//   until the generations are used up, the population has collapsed, or the observer says stop
//
// Islands are such populations side by side. Every few generations each island's best replaces the
// worst of the next one in a ring.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "base/pool.hpp"
#include "search/domain.hpp"
#include "search/genetic_options.hpp"
#include "search/genetic_state.hpp"
#include "search/population.hpp"

namespace jointid::search {

enum class Stop { generations, converged, observer };

/// Called on the calling thread between generations. Returning true stops the search.
using Observer = std::function<bool(const Generation&)>;

struct GaResult {
  Eigen::VectorXd best;
  double penalty = 0.0;
  std::vector<Generation> history;
  std::int64_t evaluations = 0;
  Stop stop = Stop::generations;
  std::optional<GaState>
      state;  ///< state from which the run can continue; none after a random search
};

/// A long run in parts.
struct Continuation {
  const GaState* resume = nullptr;  ///< continue from here instead of starting
  /// Called on the calling thread after every `interval` generations, before the observer.
  std::function<void(const GaState&)> checkpoint;
  int interval = 50;
};

/// A seed and trial give the same bits, for any number of threads, in one run or resumed. Every
/// draw is a function of (seed, trial, generation, individual), and penalties do not depend on the
/// thread that computes them.
GaResult minimise_genetic(const Objective& objective, const Domain& domain,
                          const GaOptions& options, std::uint64_t seed, std::uint32_t trial,
                          base::Pool& pool, const Observer& observer,
                          const Continuation& continuation = {});

}  // namespace jointid::search
