// Philox-4x32-10 against the known answers of its authors' distribution, and what the draws
// promise: uniform, open at both ends, and the same in whatever order individuals are made.

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

using Block = std::array<std::uint32_t, 4>;
using base::Random;

std::vector<double> draws(Random random, int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  for (auto& value : values) value = random.uniform();
  return values;
}

double chi_square(const std::vector<int>& counts) {
  double total = 0.0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  double sum = 0.0;
  for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

CHECK_CASE("random: Philox-4x32-10 gives the published blocks") {
  const std::uint32_t ones = 0xffffffffU;
  CHECK((base::philox({0, 0, 0, 0}, {0, 0}) ==
         Block{0x6627e8d5U, 0xe169c58dU, 0xbc57ac4cU, 0x9b00dbd8U}));
  CHECK((base::philox({ones, ones, ones, ones}, {ones, ones}) ==
         Block{0x408f276dU, 0x41c83b0eU, 0xa20bc7c6U, 0x6d5451fdU}));
  CHECK((base::philox({0x243f6a88U, 0x85a308d3U, 0x13198a2eU, 0x03707344U},
                      {0xa4093822U, 0x299f31d0U}) ==
         Block{0xd16cfe09U, 0x94fdccebU, 0x5001e420U, 0x24126ea1U}));
}

CHECK_CASE("random: a draw is the block's bits at (seed, stream, generation, individual)") {
  const std::uint64_t seed = 0x0123456789abcdefULL;
  const Block first = base::philox({0, 5, 4, 3}, {0x89abcdefU, 0x01234567U});
  const Block second = base::philox({1, 5, 4, 3}, {0x89abcdefU, 0x01234567U});
  const auto unit = [](std::uint32_t high, std::uint32_t low) {
    return (high * 0x1p21 + static_cast<double>(low >> 11U) + 0.5) * 0x1p-53;
  };
  const auto values = draws(Random(seed, 3, 4, 5), 4);
  CHECK(values[0] == unit(first[0], first[1]));
  CHECK(values[1] == unit(first[2], first[3]));
  CHECK(values[2] == unit(second[0], second[1]));
  CHECK(values[3] == unit(second[2], second[3]));
}

CHECK_CASE("random: uniform draws stay off 0 and 1") {
  CHECK(base::unit_interval(0) > 0.0);
  CHECK(base::unit_interval((std::uint64_t{1} << 53U) - 1) < 1.0);
  CHECK_CLOSE(base::unit_interval(std::uint64_t{1} << 52U), 0.5, 1e-15);
}

CHECK_CASE("random: draws are uniform") {
  Random random(1, 0, 0, 0);
  constexpr int kCount = 1'000'000;
  std::vector<int> bins(256, 0);
  std::vector<int> pairs(1024, 0);
  double mean = 0.0;
  double previous = 0.5;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    mean += u / kCount;
    ++bins[static_cast<std::size_t>(u * 256.0)];
    ++pairs[static_cast<std::size_t>(u * 32.0) * 32 + static_cast<std::size_t>(previous * 32.0)];
    previous = u;
  }
  // Five standard deviations of chi-square with n degrees of freedom: n + 5 sqrt(2 n).
  CHECK_CLOSE(mean, 0.5, 5.0 * 0.289e-3);
  CHECK_CLOSE(chi_square(bins), 255.0, 5.0 * std::sqrt(510.0));
  CHECK_CLOSE(chi_square(pairs), 1023.0, 5.0 * std::sqrt(2046.0));
}

CHECK_CASE("random: integers below a count are uniform and below it") {
  Random random(2, 0, 0, 0);
  std::vector<int> counts(7, 0);
  for (int i = 0; i < 700'000; ++i) {
    const auto value = random.below(7);
    CHECK(value < 7);
    if (value < 7) ++counts[value];
  }
  CHECK_CLOSE(chi_square(counts), 6.0, 5.0 * std::sqrt(12.0));
  CHECK(random.below(1) == 0);
  CHECK(random.below(0xffffffffU) < 0xffffffffU);
}

CHECK_CASE("random: first draws over individuals and generations are uniform, too") {
  // How the genetic search uses it: few draws from each of very many starts.
  std::vector<int> individuals(256, 0);
  std::vector<int> generations(256, 0);
  std::vector<int> seeds(256, 0);
  for (std::uint32_t i = 0; i < 200'000; ++i) {
    ++individuals[static_cast<std::size_t>(Random(3, 0, 0, i).uniform() * 256.0)];
    ++generations[static_cast<std::size_t>(Random(3, 0, i, 0).uniform() * 256.0)];
    ++seeds[static_cast<std::size_t>(Random(i, 0, 0, 0).uniform() * 256.0)];
  }
  for (const auto& counts : {individuals, generations, seeds}) {
    CHECK_CLOSE(chi_square(counts), 255.0, 5.0 * std::sqrt(510.0));
  }
}

CHECK_CASE("random: the order of drawing changes nothing") {
  constexpr std::uint32_t kIndividuals = 50;
  constexpr int kDraws = 9;
  std::vector<std::vector<double>> forward(kIndividuals);
  for (std::uint32_t i = 0; i < kIndividuals; ++i) forward[i] = draws(Random(4, 1, 2, i), kDraws);
  for (std::uint32_t i = kIndividuals; i-- > 0;) {
    CHECK(draws(Random(4, 1, 2, i), kDraws) == forward[i]);
  }
  // Interleaved: one draw from each individual in turn.
  std::vector<Random> together;
  for (std::uint32_t i = 0; i < kIndividuals; ++i) together.emplace_back(4, 1, 2, i);
  for (std::size_t d = 0; d < kDraws; ++d) {
    for (std::size_t i = 0; i < kIndividuals; ++i) CHECK(together[i].uniform() == forward[i][d]);
  }
}

CHECK_CASE("random: seed, stream, generation and individual each give other draws") {
  const std::uint64_t high = std::uint64_t{1} << 32U;
  std::vector<double> firsts;
  for (const auto seed : {std::uint64_t{0}, std::uint64_t{1}, high, high + 1}) {
    for (std::uint32_t stream = 0; stream < 3; ++stream) {
      for (std::uint32_t generation = 0; generation < 3; ++generation) {
        for (std::uint32_t individual = 0; individual < 3; ++individual) {
          for (const double u : draws(Random(seed, stream, generation, individual), 4)) {
            firsts.push_back(u);
          }
        }
      }
    }
  }
  std::sort(firsts.begin(), firsts.end());
  CHECK(std::adjacent_find(firsts.begin(), firsts.end()) == firsts.end());
}

}  // namespace
}  // namespace jointid::tests
