#include "search/breeder.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "search/binary.hpp"
#include "search/operators.hpp"

namespace jointid::search {

namespace {

// An individual's draws for mutation begin here, independent of the draws for selection and
// crossover of its pair.
constexpr std::uint32_t kMutationDraws = std::uint32_t{1} << 19U;

}  // namespace

void Breeder::first(Eigen::MatrixXd& genes) const {
  const auto codes = std::uint32_t{1} << static_cast<unsigned>(options_.bits);
  const auto key = base::Random::key(seed_, trial_, 0);
  for (Eigen::Index i = 0; i < genes.cols(); ++i) {
    base::Random random(key, static_cast<std::uint32_t>(i));
    for (Eigen::Index j = 0; j < genes.rows(); ++j) {
      genes(j, i) = options_.coding == Coding::real ? random.uniform()
                                                    : gene_of(random.below(codes), options_.bits);
    }
  }
}

void Breeder::next(int generation, const Probabilities& probabilities, const Selector& select,
                   const Eigen::Ref<const Eigen::MatrixXd>& parents, Eigen::Index offset,
                   Eigen::Ref<Eigen::MatrixXd> children) {
  const Eigen::Index count = parents.cols();
  const Eigen::Index genes = parents.rows();
  const auto key = base::Random::key(seed_, trial_, static_cast<std::uint32_t>(generation));
  const auto copy = [&](Eigen::Index from, double* to) {
    const double* source = parents.data() + from * parents.outerStride();
    for (Eigen::Index j = 0; j < genes; ++j) to[j] = source[j];
  };
  const auto child = [&](Eigen::Index i) { return children.data() + i * children.outerStride(); };
  Eigen::Index first = 0;
  for (const auto best : select.elite()) copy(best, child(first++));
  spare_.resize(genes);
  crossings_.clear();
  spreads_.clear();
  for (Eigen::Index i = first; i < count; i += 2) {
    base::Random random(key, static_cast<std::uint32_t>(offset + i));
    const bool paired = i + 1 < count;
    double* one = child(i);
    double* two = paired ? child(i + 1) : spare_.data();
    copy(select(random), one);
    copy(select(random), two);
    if (random.uniform() < probabilities.crossover) {
      options_.coding == Coding::real ? cross(random, one, two, genes)
                                      : cross_bits(random, one, two, genes);
    } else if (options_.uncrossed == Uncrossed::places) {
      copy(i, one);
      copy(paired ? i + 1 : i, two);
    }
  }
  finish_crossings();
  const double progress = static_cast<double>(generation) / options_.generations;
  for (Eigen::Index i = first; i < count; ++i) {
    base::Random random(key, static_cast<std::uint32_t>(offset + i), kMutationDraws);
    mutate(random, probabilities.mutation, progress, child(i), genes);
  }
}

void Breeder::cross(base::Random& random, double* one, double* two, Eigen::Index genes) {
  const bool all = options_.crossover_gene_probability >= 1.0;
  for (Eigen::Index j = 0; j < genes; ++j) {
    if (!all && random.uniform() >= options_.crossover_gene_probability) continue;
    if (options_.crossover == Crossover::blx) {
      const double u = random.uniform();
      std::tie(one[j], two[j]) =
          blend_crossover(one[j], two[j], u, random.uniform(), options_.blx_alpha);
      continue;
    }
    if (options_.crossover == Crossover::sorted_sbx && one[j] > two[j]) std::swap(one[j], two[j]);
    crossings_.push_back({one + j, two + j});
    spreads_.push_back(random.uniform());
  }
}

/// All powers of a generation are in one loop, which vectorises.
void Breeder::finish_crossings() {
  spread_factors(spreads_.data(), spreads_.size(), options_.crossover_eta);
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    const auto [one, two] = crossings_[i];
    std::tie(*one, *two) = spread_children(*one, *two, spreads_[i]);
  }
}

void Breeder::cross_bits(base::Random& random, double* one, double* two, Eigen::Index genes) const {
  const int bits = options_.bits;
  const int length = static_cast<int>(genes) * bits;
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
  for (Eigen::Index j = 0; j < genes; ++j) {
    std::uint32_t first = code_of(one[j], bits);
    std::uint32_t second = code_of(two[j], bits);
    exchange(first, second, cut(static_cast<int>(j), bits, begin, end));
    one[j] = gene_of(first, bits);
    two[j] = gene_of(second, bits);
  }
}

void Breeder::mutate(base::Random& random, double probability, double progress, double* genes,
                     Eigen::Index count) const {
  if (count == 0) return;
  if (options_.coding == Coding::binary) {
    flip_bits(random, probability, genes, count);
  } else if (options_.mutation_unit == MutationUnit::gene) {
    for (Eigen::Index j = 0; j < count; ++j) {
      if (random.uniform() < probability) genes[j] = mutated(random, genes[j], progress);
    }
  } else if (random.uniform() < probability) {
    double& gene = genes[random.below(static_cast<std::uint32_t>(count))];
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

void Breeder::flip_bits(base::Random& random, double probability, double* genes,
                        Eigen::Index count) const {
  const int bits = options_.bits;
  const auto flip = [bits](double& gene, std::uint32_t mask) {
    if (mask != 0) gene = gene_of(code_of(gene, bits) ^ mask, bits);
  };
  if (options_.mutation_unit == MutationUnit::gene) {
    for (Eigen::Index j = 0; j < count; ++j) {
      flip(genes[j], flips(random, bits, probability / bits));
    }
  } else if (random.uniform() < probability) {
    const auto place = random.below(static_cast<std::uint32_t>(count * bits));
    flip(genes[place / static_cast<std::uint32_t>(bits)],
         std::uint32_t{1} << (place % static_cast<std::uint32_t>(bits)));
  }
}

}  // namespace jointid::search
