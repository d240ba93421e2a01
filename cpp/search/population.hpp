#pragma once
// Individuals and their penalties. Genes lie in [0, 1], one individual per column, and are scaled
// to the domain for evaluation.

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/pool.hpp"
#include "search/domain.hpp"

namespace jointid::search {

/// Computes the penalties of candidates, one per column.
using Objective = std::function<void(const Eigen::MatrixXd&, Eigen::VectorXd&, base::Pool&)>;

class Population {
 public:
  Population(const Domain& domain, Eigen::Index count);

  Eigen::MatrixXd genes;      ///< free parameters x individuals
  Eigen::VectorXd penalties;  ///< never NaN: NaN counts as infinite

  void evaluate(const Objective& objective, base::Pool& pool);
  /// An individual's parameters, as evaluated.
  [[nodiscard]] Eigen::VectorXd candidate(Eigen::Index individual) const {
    return candidates_.col(individual);
  }

 private:
  std::vector<Eigen::Index> free_;
  std::vector<double> lower_;  ///< indices of the free parameters
  std::vector<double> upper_;
  Eigen::MatrixXd candidates_;
};

}  // namespace jointid::search
