#pragma once
// Binary coding, kept as a comparison: a gene in [0, 1] stands for one of 2^bits codes, a
// chromosome is all genes' codes in a row.

#include <cstdint>

#include "base/random.hpp"

namespace jointid::search {

/// 2^bits codes over [0, 1]; bits at most 30, so that a gene gives its code back exactly.
double gene_of(std::uint32_t code, int bits);
std::uint32_t code_of(double gene, int bits);

/// A gene's share of the chromosome's positions [begin, end): its first position is gene * bits and
/// belongs to its highest bit.
std::uint32_t cut(int gene, int bits, int begin, int end);

/// Two codes with the masked bits exchanged.
void exchange(std::uint32_t& first, std::uint32_t& second, std::uint32_t mask);

/// The bits that flip, each with this probability, independently.
std::uint32_t flips(base::Random& random, int bits, double probability);

}  // namespace jointid::search
