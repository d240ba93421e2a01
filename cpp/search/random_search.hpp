#pragma once
// Pure random search, kept for comparison: the same number of candidates as the genetic algorithm
// would evaluate, uniform over the domain.

#include <cstdint>

#include "search/genetic.hpp"

namespace jointid::search {

/// Uses only population, islands and generations of the options: generations + 1 batches of
/// population * islands. A seed and trial give the same bits for any number of threads.
GaResult minimise_random(const Objective& objective, const Domain& domain, const GaOptions& options,
                         std::uint64_t seed, std::uint32_t trial, base::Pool& pool,
                         const Observer& observer);

}  // namespace jointid::search
