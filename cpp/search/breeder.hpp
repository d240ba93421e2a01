#pragma once
// From one generation to the next: parents are drawn in pairs, crossed, mutated.

#include <Eigen/Core>
#include <cstdint>

#include "base/random.hpp"
#include "search/genetic_options.hpp"
#include "search/selection.hpp"

namespace jointid::search {

/// Makes the individuals of a run. Every draw is a function of (seed, trial, generation,
/// individual), where individuals are numbered through all islands: `offset` is an island's first.
class Breeder {
 public:
  Breeder(const GaOptions& options, std::uint64_t seed, std::uint32_t trial)
      : options_(options), seed_(seed), trial_(trial) {}

  /// Uniform over the domain.
  void first(Eigen::MatrixXd& genes) const;

  /// One island's children; `generation` is theirs, at least 1.
  void next(int generation, const Probabilities& probabilities, const Selector& select,
            const Eigen::Ref<const Eigen::MatrixXd>& parents, Eigen::Index offset,
            Eigen::Ref<Eigen::MatrixXd> children) const;

 private:
  using Genes = Eigen::Ref<Eigen::VectorXd>;

  void cross(base::Random& random, Genes one, Genes two) const;
  void cross_bits(base::Random& random, Genes one, Genes two) const;
  void mutate(base::Random& random, double probability, double progress, Genes genes) const;
  [[nodiscard]] double mutated(base::Random& random, double gene, double progress) const;
  void flip_bits(base::Random& random, double probability, Genes genes) const;

  GaOptions options_;
  std::uint64_t seed_;
  std::uint32_t trial_;
};

}  // namespace jointid::search
