// The minimum of a function of one variable.

#include <algorithm>
#include <cmath>
#include <vector>

#include "check.hpp"
#include "search/brent.hpp"

namespace jointid::tests {
namespace {

using search::minimise_brent;

CHECK_CASE("brent: finds the minimum of smooth and of kinked functions") {
  const auto parabola = [](double x) { return (x - 0.3) * (x - 0.3); };
  const auto quartic = [](double x) { return std::pow(x - 0.7, 4.0); };
  const auto kink = [](double x) { return std::fabs(x - 0.123456789); };
  CHECK_CLOSE(minimise_brent(parabola, {0.0, 1.0}, 1e-9), 0.3, 1e-8);
  CHECK_CLOSE(minimise_brent(quartic, {0.0, 1.0}, 1e-9), 0.7, 1e-3);  // flat: 1e-16 is 1e-4 away
  CHECK_CLOSE(minimise_brent(kink, {0.0, 1.0}, 1e-9), 0.123456789, 1e-8);
}

CHECK_CASE("brent: a parabola takes few evaluations, and none at the ends") {
  int evaluations = 0;
  const auto counted = [&](double x) {
    ++evaluations;
    CHECK(x > 2.0 && x < 5.0);
    return (x - 3.0) * (x - 3.0);
  };
  CHECK_CLOSE(minimise_brent(counted, {2.0, 5.0}, 1e-9), 3.0, 1e-8);
  CHECK_WITH(evaluations < 20, std::to_string(evaluations));
}

CHECK_CASE("brent: evaluates no two points nearer to each other than the tolerance") {
  constexpr double kTolerance = 1e-6;
  for (const double lowest : {0.1, 0.3, 0.62}) {
    std::vector<double> places;
    const auto watched = [&](double x) {
      places.push_back(x);
      return std::fabs(x - lowest) * (x - lowest) * (x - lowest) + (x - lowest) * (x - lowest);
    };
    CHECK_CLOSE(minimise_brent(watched, {0.0, 1.0}, kTolerance), lowest, 2.0 * kTolerance);
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) {
      CHECK(places[i] - places[i - 1] >= 0.999 * kTolerance);
    }
  }
}

CHECK_CASE("brent: without a minimum inside it approaches the lower end") {
  CHECK_CLOSE(minimise_brent([](double x) { return x; }, {1.0, 2.0}, 1e-6), 1.0, 1e-5);
  CHECK_CLOSE(minimise_brent([](double x) { return -x; }, {1.0, 2.0}, 1e-6), 2.0, 1e-5);
}

}  // namespace
}  // namespace jointid::tests
