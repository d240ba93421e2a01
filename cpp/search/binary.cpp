#include "search/binary.hpp"

#include <algorithm>

namespace jointid::search {

namespace {

std::uint32_t last_code(int bits) {
  return (std::uint32_t{1} << static_cast<unsigned>(bits)) - 1U;
}

}  // namespace

double gene_of(std::uint32_t code, int bits) {
  return static_cast<double>(code) / static_cast<double>(last_code(bits));
}

std::uint32_t code_of(double gene, int bits) {
  return static_cast<std::uint32_t>(gene * static_cast<double>(last_code(bits)) + 0.5);
}

std::uint32_t cut(int gene, int bits, int begin, int end) {
  const int first = std::clamp(begin - gene * bits, 0, bits);
  const int last = std::clamp(end - gene * bits, first, bits);
  // The `bits - first` low bits without the `bits - last` low bits.
  return last_code(bits - first) ^ last_code(bits - last);
}

void exchange(std::uint32_t& first, std::uint32_t& second, std::uint32_t mask) {
  const std::uint32_t differing = (first ^ second) & mask;
  first ^= differing;
  second ^= differing;
}

std::uint32_t flips(base::Random& random, int bits, double probability) {
  std::uint32_t mask = 0;
  for (int i = 0; i < bits; ++i) {
    mask = (mask << 1U) | (random.uniform() < probability ? 1U : 0U);
  }
  return mask;
}

}  // namespace jointid::search
