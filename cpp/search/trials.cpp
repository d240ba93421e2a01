#include "search/trials.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "search/random_search.hpp"

namespace jointid::search {

namespace {

std::int64_t budget(const GaOptions& options) {
  return std::int64_t{options.population} * options.islands * (options.generations + 1);
}

/// Longest first: short ones then fill the gaps. Equal ones keep their order. A stable sort would
/// need a buffer that clang with an older library calls deprecated.
std::vector<std::size_t> by_length(const std::vector<Trial>& trials) {
  std::vector<std::size_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const std::int64_t one = budget(trials[a].options);
    const std::int64_t other = budget(trials[b].options);
    return one == other ? a < b : one > other;
  });
  return order;
}

}  // namespace

std::vector<TrialResult> minimise_trials(const Objective& objective, const Domain& domain,
                                         const std::vector<Trial>& trials, Searcher searcher,
                                         base::Pool& pool) {
  for (const auto& trial : trials) trial.options.validate();
  const auto order = by_length(trials);
  std::vector<TrialResult> results(trials.size());
  const auto search = [&](std::size_t index, base::Pool& alone) {
    const auto& [options, seed] = trials[index];
    auto found = searcher == Searcher::genetic
                     ? minimise_genetic(objective, domain, options, seed, 0, alone, {})
                     : minimise_random(objective, domain, options, seed, 0, alone, {});
    results[index] = {std::move(found.best), found.penalty, found.evaluations,
                      found.history.back().number, found.stop};
  };
  pool.for_each(
      trials.size(),
      [&](std::size_t begin, std::size_t end) {
        base::Pool alone(1, [&] { pool.cancel().check(); });
        for (std::size_t place = begin; place < end; ++place) search(order[place], alone);
      },
      1);
  return results;
}

}  // namespace jointid::search
