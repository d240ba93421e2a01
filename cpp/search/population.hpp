#pragma once
// Individuals and their penalties: genes in [0, 1], one individual a column, placed in the domain
// to be evaluated.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/pool.hpp"
#include "search/domain.hpp"

namespace jointid::search {

/// Penalties of candidates, one a column.
using Objective = std::function<void(const Eigen::MatrixXd&, Eigen::VectorXd&, base::Pool&)>;

class Population {
 public:
  Population(const Domain& domain, Eigen::Index count);

  Eigen::MatrixXd genes;      ///< free parameters x individuals
  Eigen::VectorXd penalties;  ///< never NaN: what is not a number counts as infinite

  void evaluate(const Objective& objective, base::Pool& pool);
  /// An individual's parameters, as they were evaluated.
  [[nodiscard]] Eigen::VectorXd candidate(Eigen::Index individual) const {
    return candidates_.col(individual);
  }

 private:
  std::vector<Eigen::Index> free_;
  std::vector<double> lower_;  ///< of the free parameters
  std::vector<double> upper_;
  Eigen::MatrixXd candidates_;
};

}  // namespace jointid::search
