#pragma once
// Binary coding, kept for comparison: a gene in [0, 1] represents one of 2^bits codes. A chromosome
// is the sequence of all genes' codes.

#include <cstdint>

#include "base/random.hpp"

namespace jointid::search {

/// 2^bits codes over [0, 1]; bits at most 30, so that each gene gives its code back exactly.
double gene_of(std::uint32_t code, int bits);
std::uint32_t code_of(double gene, int bits);

/// A gene's share of the chromosome's positions [begin, end). The first position of a gene is gene
/// * bits, which is its highest bit.
std::uint32_t cut(int gene, int bits, int begin, int end);

/// Exchanges the masked bits of two codes.
void exchange(std::uint32_t& first, std::uint32_t& second, std::uint32_t mask);

/// Chooses the bits that flip, each independently with this probability.
std::uint32_t flips(base::Random& random, int bits, double probability);

}  // namespace jointid::search
