// Facts about a signal, compared with counts one sample after the other: blocks, their ends,
// infinite sizes. The same source counts pairs where no function has clones.

#include "diagnose/signal_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"

namespace jointid::tests {
namespace {

struct Counted {
  bool fine = false;
  std::int64_t changes = 0;
  std::int64_t moving = 0;
  std::int64_t near = 0;
  std::int64_t stale = 0;
};

Counted counted(const std::vector<double>& x, const std::vector<double>& v, double peak) {
  Counted found;
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double close = 0.01 * (*high - *low);
  std::vector<double> steps;
  for (std::size_t i = 0; i < x.size(); ++i) {
    found.near += x[i] - *low <= close ? 1 : 0;
    found.near += *high - x[i] <= close ? 1 : 0;
    if (i + 1 == x.size()) break;
    const double step = std::fabs(x[i + 1] - x[i]);
    const bool moves = std::min(std::fabs(v[i]), std::fabs(v[i + 1])) > 0.1 * peak;
    found.moving += moves ? 1 : 0;
    found.stale += moves && step == 0.0 && x[i] > *low && x[i] < *high ? 1 : 0;
    if (step > 0.0) steps.push_back(step);
  }
  found.changes = static_cast<std::int64_t>(steps.size());
  if (steps.empty()) return found;
  std::sort(steps.begin(), steps.end());
  const std::size_t half = steps.size() / 2;
  const double median = steps.size() % 2 == 1 ? steps[half] : 0.5 * (steps[half - 1] + steps[half]);
  found.fine = median / steps[0] >= 30.0;
  return found;
}

void compare(const std::vector<double>& x, const std::vector<double>& v) {
  double peak = 0.0;
  for (const double speed : v) peak = std::max(peak, std::fabs(speed));
  const auto size = static_cast<Eigen::Index>(x.size());
  const auto facts = diagnose::inspect_signal(Eigen::Map<const Eigen::VectorXd>(x.data(), size),
                                              Eigen::Map<const Eigen::VectorXd>(v.data(), size),
                                              peak, 1e-3, nullptr);
  const Counted expected = counted(x, v, peak);
  CHECK(facts.changes == expected.changes);
  CHECK(facts.moving == expected.moving);
  CHECK(facts.stale == expected.stale);
  CHECK(facts.lower.near + facts.upper.near == expected.near);
  CHECK(facts.fine == expected.fine);
}

CHECK_CASE("signal facts: as counted one sample after the other, at any length") {
  base::Random draw(7, 0, 0, 0);
  for (int trial = 0; trial < 600; ++trial) {
    const auto count = 2 + static_cast<std::size_t>(trial % 90);
    const double kinds = trial % 2 == 0 ? 1e6 : 1.0 + draw.uniform() * 30.0;
    std::vector<double> x(count);
    std::vector<double> v(count);
    for (double& value : x) value = std::floor(draw.uniform() * kinds);
    for (double& value : v) value = draw.uniform() - 0.5;
    compare(x, v);
  }
}

CHECK_CASE("signal facts: NaN steps are not fine") {
  constexpr double kLargest = std::numeric_limits<double>::max();
  for (const std::size_t count : {std::size_t{6}, std::size_t{9}, std::size_t{33}}) {
    std::vector<double> x(count);
    for (std::size_t i = 0; i < count; ++i) x[i] = i % 2 == 0 ? kLargest : -kLargest;
    const std::vector<double> v(count, 1.0);
    const auto size = static_cast<Eigen::Index>(count);
    const auto facts = diagnose::inspect_signal(Eigen::Map<const Eigen::VectorXd>(x.data(), size),
                                                Eigen::Map<const Eigen::VectorXd>(v.data(), size),
                                                1.0, 1e-3, nullptr);
    CHECK(facts.changes == static_cast<std::int64_t>(count) - 1);
    CHECK(!facts.fine);
  }
}

}  // namespace
}  // namespace jointid::tests
