// Binary coding: codes, cuts, flips, and a search with them.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "breeding.hpp"
#include "check.hpp"
#include "landscapes.hpp"
#include "search/binary.hpp"

namespace jointid::tests {
namespace {

using search::BitCrossover;
using search::code_of;
using search::Coding;
using search::cut;
using search::GaOptions;
using search::gene_of;
using search::MutationUnit;

CHECK_CASE("binary: a gene gives its code back, for every width") {
  base::Random random(1, 0, 0, 0);
  for (int bits = 1; bits <= 30; ++bits) {
    const std::uint32_t codes = std::uint32_t{1} << static_cast<unsigned>(bits);
    CHECK(gene_of(0, bits) == 0.0 && gene_of(codes - 1, bits) == 1.0);
    for (int i = 0; i < 1000; ++i) {
      const std::uint32_t code = random.below(codes);
      CHECK(code_of(gene_of(code, bits), bits) == code);
    }
  }
}

CHECK_CASE("binary: a cut takes the chromosome's positions from the left") {
  CHECK(cut(0, 4, 1, 3) == 0b0110);
  CHECK(cut(0, 4, 0, 12) == 0b1111 && cut(2, 4, 0, 12) == 0b1111);
  CHECK(cut(1, 4, 6, 12) == 0b0011);
  CHECK(cut(1, 4, 0, 5) == 0b1000);
  CHECK(cut(1, 4, 8, 12) == 0 && cut(1, 4, 0, 4) == 0 && cut(1, 4, 6, 6) == 0);
}

CHECK_CASE("binary: bits flip at the set rate, each independently") {
  base::Random random(2, 0, 0, 0);
  constexpr int kDraws = 50'000;
  const double probability = 0.05;
  std::vector<int> counts(16, 0);
  int neighbours = 0;
  for (int i = 0; i < kDraws; ++i) {
    const auto mask = search::flips(random, 16, probability);
    for (unsigned bit = 0; bit < 16; ++bit) counts[bit] += static_cast<int>((mask >> bit) & 1U);
    neighbours += static_cast<int>((mask & (mask >> 1U) & 1U));
  }
  const double allowed = 4.0 * std::sqrt(probability * (1.0 - probability) / kDraws);
  for (const int count : counts) CHECK_CLOSE(count / double{kDraws}, probability, allowed);
  CHECK_CLOSE(neighbours / double{kDraws}, probability * probability,
              4.0 * std::sqrt(0.0025 / kDraws));
}

CHECK_CASE("binary: crossing exchanges one tail, or one stretch, and loses no bit") {
  for (const auto kind : {BitCrossover::one_point, BitCrossover::two_point}) {
    GaOptions options;
    options.coding = Coding::binary;
    options.bits = 8;
    options.elite = 0;
    options.bit_crossover = kind;
    options.crossover_probability = 1.0;
    options.mutation_probability = 0.0;
    // Parents of only zeros and only ones: a child's bits show where it was cut.
    Eigen::MatrixXd parents(3, 2000);
    for (Eigen::Index i = 0; i < parents.cols(); ++i) {
      parents.col(i).setConstant(static_cast<double>(i % 2));
    }
    const auto children = children_of(options, parents, Eigen::VectorXd::LinSpaced(2000, 1.0, 2.0));
    std::vector<int> cuts(24, 0);
    int unlike = 0;
    int uncut = 0;
    for (Eigen::Index i = 0; i < parents.cols(); i += 2) {
      int changes = 0;
      bool previous = false;
      for (int position = 0; position < 24; ++position) {
        const int gene = position / 8;
        const auto low = static_cast<unsigned>(7 - position % 8);
        const auto bit = [&](Eigen::Index who) {
          return ((code_of(children(gene, who), 8) >> low) & 1U) != 0;
        };
        if (bit(i) == bit(i + 1)) {
          changes = -100;  // equal parents, or a lost bit
        } else if (position > 0 && bit(i) != previous) {
          ++changes;
          ++cuts[static_cast<std::size_t>(position)];
        }
        previous = bit(i);
      }
      CHECK(changes < 0 || changes <= (kind == BitCrossover::one_point ? 1 : 2));
      if (kind == BitCrossover::one_point) CHECK(changes < 0 || changes == 1);
      unlike += changes < 0 ? 0 : 1;
      uncut += changes == 0 ? 1 : 0;
    }
    // Two points of 23 places, drawn in any order, are equal once in 23 times.
    const double expected = kind == BitCrossover::one_point ? 0.0 : 1.0 / 23.0;
    CHECK_CLOSE(static_cast<double>(uncut) / unlike, expected, 4.0 * std::sqrt(expected / unlike));
    for (std::size_t position = 1; position < 24; ++position) CHECK(cuts[position] > 0);
  }
}

CHECK_CASE("binary: mutation flips the expected number of bits, or exactly one") {
  GaOptions options;
  options.coding = Coding::binary;
  options.bits = 10;
  options.elite = 0;
  options.crossover_probability = 0.0;
  options.mutation_probability = 0.3;
  const Eigen::MatrixXd parents = Eigen::MatrixXd::Zero(4, 20'000);
  const Eigen::VectorXd penalties = Eigen::VectorXd::Ones(20'000);
  for (const auto unit : {MutationUnit::gene, MutationUnit::individual}) {
    options.mutation_unit = unit;
    const auto children = children_of(options, parents, penalties);
    double flipped = 0.0;
    int most = 0;
    for (Eigen::Index i = 0; i < children.cols(); ++i) {
      int here = 0;
      for (const double gene : children.col(i)) here += std::popcount(code_of(gene, 10));
      flipped += here;
      most = std::max(most, here);
    }
    const double expected = unit == MutationUnit::gene ? 4 * 0.3 : 0.3;
    CHECK_CLOSE(flipped / 20'000.0, expected, 4.0 * std::sqrt(expected / 20'000.0));
    CHECK(unit == MutationUnit::gene ? most > 1 : most == 1);
  }
}

CHECK_CASE("binary: finds a sphere's minimum up to a Hamming cliff, and nothing between codes") {
  GaOptions options;
  options.coding = Coding::binary;
  options.bits = 10;
  options.population = 60;
  options.generations = 300;
  // 0.2 is code 409.2 = 0110011001; from 383 = 0101111111 no single flip leads nearer.
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto result = search_for(sphere, cube(3, -1.0, 2.0), options, seed);
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double code = (result.best[j] + 1.0) / 3.0 * 1023.0;
      CHECK_CLOSE(code, std::round(code), 1e-9);
      CHECK_CLOSE(result.best[j], 0.1 * static_cast<double>(j + 1), 40.0 * 3.0 / 1023.0);
    }
  }
}

}  // namespace
}  // namespace jointid::tests
