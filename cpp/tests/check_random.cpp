// SplitMix64 compared with its known sequence, and the promised properties of draws: uniform, open
// at both ends, and the same in any order of individuals.

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

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

CHECK_CASE("random: SplitMix64 gives its known sequence") {
  // The sequence of seed 1234567, as other implementations print it.
  std::uint64_t state = 1234567;
  for (const std::uint64_t expected :
       {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
        4593380528125082431ULL, 16408922859458223821ULL}) {
    CHECK(base::mixed(state += base::kSplitMixStep) == expected);
  }
}

CHECK_CASE("random: a draw is the key's sequence at (individual, draw)") {
  const std::uint64_t key = Random::key(0x0123456789abcdefULL, 3, 4);
  const auto values = draws(Random(0x0123456789abcdefULL, 3, 4, 5), 4);
  const auto later = draws(Random(key, 5, 2), 2);
  for (std::uint64_t n = 0; n < 4; ++n) {
    const std::uint64_t bits =
        base::mixed(key + base::kSplitMixStep * ((std::uint64_t{5} << 20U) + n + 1));
    CHECK(values[n] == (static_cast<double>(bits >> 11U) + 0.5) * 0x1p-53);
    if (n >= 2) CHECK(values[n] == later[n - 2]);
  }
}

CHECK_CASE("random: uniform draws never reach 0 and 1") {
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
  // The use of the genetic search: few draws from each of very many starts.
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
