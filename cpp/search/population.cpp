#include "search/population.hpp"

#include <limits>

namespace jointid::search {

Population::Population(const Domain& domain, Eigen::Index count)
    : genes(static_cast<Eigen::Index>(domain.free().size()), count),
      penalties(count),
      domain_(domain),
      free_(domain.free()),
      candidates_(domain.lower.replicate(1, count)) {}

void Population::evaluate(const Objective& objective, base::Pool& pool) {
  for (Eigen::Index j = 0; j < genes.rows(); ++j) {
    const auto parameter = free_[static_cast<std::size_t>(j)];
    const double low = domain_.lower[parameter];
    const double high = domain_.upper[parameter];
    // Convex form: stays inside the bounds to the last bit.
    candidates_.row(parameter) = ((1.0 - genes.row(j).array()) * low + genes.row(j).array() * high)
                                     .cwiseMax(low)
                                     .cwiseMin(high);
  }
  objective(candidates_, penalties, pool);
  // A penalty that is not a number must lose.
  for (double& penalty : penalties) {
    if (!(penalty == penalty)) penalty = std::numeric_limits<double>::infinity();
  }
}

}  // namespace jointid::search
