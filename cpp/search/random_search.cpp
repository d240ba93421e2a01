#include "search/random_search.hpp"

#include "base/random.hpp"
#include "search/selection.hpp"

namespace jointid::search {

GaResult minimise_random(const Objective& objective, const Domain& domain, const GaOptions& options,
                         std::uint64_t seed, std::uint32_t trial, base::Pool& pool,
                         const Observer& observer) {
  options.validate();
  domain.validate();
  Population population(domain, static_cast<Eigen::Index>(options.population) * options.islands);
  GaResult result;
  for (int batch = 0; batch <= options.generations; ++batch) {
    for (Eigen::Index i = 0; i < population.genes.cols(); ++i) {
      base::Random random(seed, trial, static_cast<std::uint32_t>(batch),
                          static_cast<std::uint32_t>(i));
      for (double& gene : population.genes.col(i)) gene = random.uniform();
    }
    population.evaluate(objective, pool);
    result.evaluations += population.penalties.size();
    Eigen::Index place = 0;
    const double best = population.penalties.minCoeff(&place);
    if (batch == 0 || best < result.penalty) {
      result.penalty = best;
      result.best = population.candidate(place);
    }
    result.history.push_back({batch, result.penalty, population.penalties.mean(),
                              diversity_of(options, population.penalties), 0.0, 0.0,
                              result.evaluations});
    pool.poll();
    if (observer && observer(result.history.back())) {
      result.stop = Stop::observer;
      break;
    }
  }
  return result;
}

}  // namespace jointid::search
