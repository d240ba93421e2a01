#pragma once
// Pure random search, kept as a comparison: as many candidates as the genetic algorithm would
// evaluate, uniform over the domain.

#include <cstdint>

#include "search/genetic.hpp"

namespace jointid::search {

/// Of the options only population, islands and generations matter: batches of population * islands,
/// generations + 1 of them. The same bits for a seed and trial, whatever the number of threads.
GaResult minimise_random(const Objective& objective, const Domain& domain, const GaOptions& options,
                         std::uint64_t seed, std::uint32_t trial, base::Pool& pool,
                         const Observer& observer);

}  // namespace jointid::search
