#pragma once
// The step from one generation to the next: parents are drawn in pairs, crossed and mutated.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "search/genetic_options.hpp"
#include "search/selection.hpp"

namespace jointid::search {

/// Makes the individuals of a run. Every draw is a function of (seed, trial, generation,
/// individual). Individuals are numbered through all islands; `offset` is the first one of an
/// island. Use one breeder per thread: it keeps its buffers, so that a generation allocates
/// nothing.
class Breeder {
 public:
  Breeder(const GaOptions& options, std::uint64_t seed, std::uint32_t trial)
      : options_(options), seed_(seed), trial_(trial) {}

  /// Uniform over the domain.
  void first(Eigen::MatrixXd& genes) const;

  /// Breeds one island's children; `generation` is the children's, at least 1.
  void next(int generation, const Probabilities& probabilities, const Selector& select,
            const Eigen::Ref<const Eigen::MatrixXd>& parents, Eigen::Index offset,
            Eigen::Ref<Eigen::MatrixXd> children);

 private:
  /// A gene that a pair of children will cross when its spread factor is known.
  struct Crossing {
    double* one;
    double* two;
  };

  void cross(base::Random& random, double* one, double* two, Eigen::Index genes);
  void cross_bits(base::Random& random, double* one, double* two, Eigen::Index genes) const;
  void finish_crossings();
  void mutate(base::Random& random, double probability, double progress, double* genes,
              Eigen::Index count) const;
  [[nodiscard]] double mutated(base::Random& random, double gene, double progress) const;
  void flip_bits(base::Random& random, double probability, double* genes, Eigen::Index count) const;

  GaOptions options_;
  std::uint64_t seed_;
  std::uint32_t trial_;
  Eigen::VectorXd spare_;            ///< the second child of an odd last pair
  std::vector<Crossing> crossings_;  ///< powers of the generation
  std::vector<double> spreads_;      ///< of these genes: first the draws, then the factors
};

}  // namespace jointid::search
