#include "search/population.hpp"

#include <limits>

namespace jointid::search {

Population::Population(const Domain& domain, Eigen::Index count)
    : genes(static_cast<Eigen::Index>(domain.free().size()), count),
      penalties(count),
      free_(domain.free()),
      candidates_(domain.lower.replicate(1, count)) {
  for (const auto parameter : free_) {
    lower_.push_back(domain.lower[parameter]);
    upper_.push_back(domain.upper[parameter]);
  }
}

void Population::evaluate(const Objective& objective, base::Pool& pool) {
  const auto parameters = candidates_.rows();
  for (Eigen::Index i = 0; i < genes.cols(); ++i) {
    const double* gene = genes.data() + i * genes.rows();
    double* candidate = candidates_.data() + i * parameters;
    for (std::size_t j = 0; j < free_.size(); ++j) {
      const double low = lower_[j];
      const double high = upper_[j];
      // Convex form: stays within the bounds to the last bit.
      const double value = (1.0 - gene[j]) * low + gene[j] * high;
      candidate[free_[j]] = value < low ? low : (value > high ? high : value);
    }
  }
  objective(candidates_, penalties, pool);
  // NaN must lose every comparison.
  for (double& penalty : penalties) {
    if (!(penalty == penalty)) penalty = std::numeric_limits<double>::infinity();
  }
}

}  // namespace jointid::search
