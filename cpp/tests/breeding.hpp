#pragma once
// One step of breeding, for checks of its effect on genes.

#include "search/breeder.hpp"

namespace jointid::tests {

/// Breeds one generation, with the options' probabilities.
inline Eigen::MatrixXd children_of(const search::GaOptions& options, const Eigen::MatrixXd& parents,
                                   const Eigen::VectorXd& penalties, int generation = 1) {
  search::Breeder breeder(options, 5, 0);
  Eigen::MatrixXd children(parents.rows(), parents.cols());
  breeder.next(generation, {options.crossover_probability, options.mutation_probability},
               search::Selector(options, penalties), parents, 0, children);
  return children;
}

/// Makes a first population.
inline Eigen::MatrixXd random_genes(Eigen::Index rows, Eigen::Index columns,
                                    const search::GaOptions& options) {
  Eigen::MatrixXd genes(rows, columns);
  search::Breeder(options, 77, 0).first(genes);
  return genes;
}

}  // namespace jointid::tests
