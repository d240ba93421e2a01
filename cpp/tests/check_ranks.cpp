// Order statistics compared with a sort: values in any order, many of them equal, few and many.

#include "base/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

void compare(const std::vector<double>& values, std::size_t rank) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto found = base::at_rank(values.data(), values.size(), rank);
  CHECK(found.value == sorted[rank]);
  CHECK(found.next == sorted[std::min(rank + 1, sorted.size() - 1)]);
}

CHECK_CASE("ranks: the same as from a sort") {
  base::Random draw(5, 0, 0, 0);
  for (int trial = 0; trial < 3000; ++trial) {
    const auto count = 1 + static_cast<std::size_t>(draw.uniform() * (trial % 3 == 0 ? 30 : 900));
    // With few different values most are equal; with one, all.
    const double kinds = trial % 2 == 0 ? 1e9 : 1.0 + draw.uniform() * 20.0;
    std::vector<double> values(count);
    for (double& value : values) value = std::floor(draw.uniform() * kinds) - 0.5 * kinds;
    compare(values, static_cast<std::size_t>(draw.uniform() * static_cast<double>(count)));
    compare(values, 0);
    compare(values, count - 1);
  }
}

CHECK_CASE("ranks: sorted values, and orders that no pivot divides well") {
  std::vector<double> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  for (const std::size_t rank : {std::size_t{0}, std::size_t{499}, std::size_t{999}}) {
    compare(values, rank);
  }
  std::reverse(values.begin(), values.end());
  compare(values, 250);
  // Two of the three places of a pivot hold the smallest values in every round, so each round
  // removes only two values. A partition reverses the values above the pivot.
  std::vector<std::size_t> left(400);
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<double> poor(left.size());
  double next = 0.0;
  while (left.size() > 24) {
    const std::size_t one = left[left.size() / 4];
    const std::size_t other = left[left.size() / 2];
    poor[one] = next++;
    poor[other] = next++;
    std::erase_if(left, [&](std::size_t i) { return i == one || i == other; });
    std::reverse(left.begin(), left.end());
  }
  for (const std::size_t i : left) poor[i] = next++;
  compare(poor, 399);
  compare(poor, 200);
}

}  // namespace
}  // namespace jointid::tests
