#include "search/breeder.hpp"

#include <algorithm>
#include <utility>

#include "search/binary.hpp"
#include "search/operators.hpp"

namespace jointid::search {

void Breeder::first(Eigen::MatrixXd& genes) const {
  const auto codes = std::uint32_t{1} << static_cast<unsigned>(options_.bits);
  for (Eigen::Index i = 0; i < genes.cols(); ++i) {
    base::Random random(seed_, trial_, 0, static_cast<std::uint32_t>(i));
    for (Eigen::Index j = 0; j < genes.rows(); ++j) {
      genes(j, i) = options_.coding == Coding::real ? random.uniform()
                                                    : gene_of(random.below(codes), options_.bits);
    }
  }
}

void Breeder::next(int generation, const Probabilities& probabilities, const Selector& select,
                   const Eigen::Ref<const Eigen::MatrixXd>& parents, Eigen::Index offset,
                   Eigen::Ref<Eigen::MatrixXd> children) const {
  const Eigen::Index count = parents.cols();
  for (Eigen::Index i = 0; i < options_.elite; ++i) {
    children.col(i) = parents.col(select.order()[static_cast<std::size_t>(i)]);
  }
  const double progress = static_cast<double>(generation) / options_.generations;
  Eigen::VectorXd spare(parents.rows());  // the second child of an odd last pair
  for (Eigen::Index i = options_.elite; i < count; i += 2) {
    base::Random random(seed_, trial_, static_cast<std::uint32_t>(generation),
                        static_cast<std::uint32_t>(offset + i));
    const bool paired = i + 1 < count;
    auto one = children.col(i);
    auto two = paired ? children.col(i + 1) : Genes(spare);
    one = parents.col(select(random));
    two = parents.col(select(random));
    if (random.uniform() < probabilities.crossover) {
      options_.coding == Coding::real ? cross(random, one, two) : cross_bits(random, one, two);
    } else if (options_.uncrossed == Uncrossed::places) {
      one = parents.col(i);
      two = parents.col(paired ? i + 1 : i);
    }
    mutate(random, probabilities.mutation, progress, one);
    mutate(random, probabilities.mutation, progress, two);
  }
}

void Breeder::cross(base::Random& random, Genes one, Genes two) const {
  for (Eigen::Index j = 0; j < one.size(); ++j) {
    if (random.uniform() >= options_.crossover_gene_probability) continue;
    double first = one[j];
    double second = two[j];
    if (options_.crossover == Crossover::sorted_sbx && first > second) std::swap(first, second);
    const double u = random.uniform();
    const auto [a, b] =
        options_.crossover == Crossover::blx
            ? blend_crossover(first, second, u, random.uniform(), options_.blx_alpha)
            : simulated_binary_crossover(first, second, u, options_.crossover_eta);
    one[j] = a;
    two[j] = b;
  }
}

void Breeder::cross_bits(base::Random& random, Genes one, Genes two) const {
  const int bits = options_.bits;
  const int length = static_cast<int>(one.size()) * bits;
  if (length < 2) return;
  const auto between = [&] {
    return 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(length - 1)));
  };
  int begin = between();
  int end = length;
  if (options_.bit_crossover == BitCrossover::two_point) {
    end = between();
    if (begin > end) std::swap(begin, end);
  }
  for (Eigen::Index j = 0; j < one.size(); ++j) {
    std::uint32_t first = code_of(one[j], bits);
    std::uint32_t second = code_of(two[j], bits);
    exchange(first, second, cut(static_cast<int>(j), bits, begin, end));
    one[j] = gene_of(first, bits);
    two[j] = gene_of(second, bits);
  }
}

void Breeder::mutate(base::Random& random, double probability, double progress, Genes genes) const {
  if (genes.size() == 0) return;
  if (options_.coding == Coding::binary) {
    flip_bits(random, probability, genes);
  } else if (options_.mutation_unit == MutationUnit::gene) {
    for (double& gene : genes) {
      if (random.uniform() < probability) gene = mutated(random, gene, progress);
    }
  } else if (random.uniform() < probability) {
    double& gene = genes[random.below(static_cast<std::uint32_t>(genes.size()))];
    gene = mutated(random, gene, progress);
  }
}

double Breeder::mutated(base::Random& random, double gene, double progress) const {
  switch (options_.mutation) {
    case Mutation::uniform:
      return random.uniform();
    case Mutation::polynomial:
      return polynomial_mutation(gene, random.uniform(), options_.mutation_eta);
    default:
      break;
  }
  const bool upper = random.uniform() < 0.5;
  const auto step =
      options_.mutation == Mutation::shrinking ? shrinking_mutation : non_uniform_mutation;
  return step(gene, random.uniform(), upper, progress, options_.mutation_exponent);
}

void Breeder::flip_bits(base::Random& random, double probability, Genes genes) const {
  const int bits = options_.bits;
  const auto flip = [bits](double& gene, std::uint32_t mask) {
    if (mask != 0) gene = gene_of(code_of(gene, bits) ^ mask, bits);
  };
  if (options_.mutation_unit == MutationUnit::gene) {
    for (double& gene : genes) flip(gene, flips(random, bits, probability / bits));
  } else if (random.uniform() < probability) {
    const auto place = random.below(static_cast<std::uint32_t>(genes.size() * bits));
    flip(genes[place / static_cast<std::uint32_t>(bits)],
         std::uint32_t{1} << (place % static_cast<std::uint32_t>(bits)));
  }
}

}  // namespace jointid::search
