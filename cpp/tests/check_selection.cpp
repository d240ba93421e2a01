// Frequency of selection, fitness, diversity, and its effect on the probabilities.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "check.hpp"
#include "search/selection.hpp"

namespace jointid::tests {
namespace {

using search::adapted;
using search::Diversity;
using search::diversity_of;
using search::Fitness;
using search::fitness_of;
using search::GaOptions;
using search::Selection;
using search::Selector;

constexpr int kSelections = 200'000;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

Eigen::VectorXd of(std::initializer_list<double> values) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), result.begin());
  return result;
}

/// Compares how often each individual was drawn with the expected number: within four standard
/// deviations.
void check_shares(const GaOptions& options, const Eigen::VectorXd& penalties,
                  const Eigen::VectorXd& expected, const std::string& what) {
  const Selector select(options, penalties);
  base::Random random(11, 0, 0, 0);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(penalties.size());
  for (int i = 0; i < kSelections; ++i) counts[select(random)] += 1.0;
  for (Eigen::Index i = 0; i < penalties.size(); ++i) {
    const double p = expected[i];
    const double allowed = 4.0 * std::sqrt(p * (1.0 - p) / kSelections);
    CHECK_WITH(std::fabs(counts[i] / kSelections - p) <= allowed,
               what + ", individual " + std::to_string(i) + ": " +
                   std::to_string(counts[i] / kSelections) + " against " + std::to_string(p));
  }
}

const Eigen::VectorXd kPenalties = of({3.0, 1.0, 10.0, 2.0, 5.0});
const Eigen::VectorXd kRanks = of({2.0, 0.0, 4.0, 1.0, 3.0});

CHECK_CASE("selection: a tournament of k takes the best with 1 - ((n-1)/n)^k, and so on down") {
  for (const int size : {1, 2, 3, 5}) {
    GaOptions options;
    options.tournament = size;
    // Rank r wins if all k draws are at least r, minus the cases in which all are beyond it.
    const Eigen::VectorXd expected = kRanks.unaryExpr([&](double rank) {
      return std::pow((5.0 - rank) / 5.0, size) - std::pow((4.0 - rank) / 5.0, size);
    });
    check_shares(options, kPenalties, expected, "tournament of " + std::to_string(size));
  }
}

CHECK_CASE("selection: linear ranking gives the best its pressure, the worst 2 - pressure") {
  for (const double pressure : {1.0, 1.5, 2.0}) {
    GaOptions options;
    options.selection = Selection::rank;
    options.rank_pressure = pressure;
    const Eigen::VectorXd expected = kRanks.unaryExpr(
        [&](double rank) { return (pressure - 2.0 * (pressure - 1.0) * rank / 4.0) / 5.0; });
    CHECK_CLOSE(expected[1], pressure / 5.0, 1e-15);
    check_shares(options, kPenalties, expected, "rank, pressure " + std::to_string(pressure));
  }
}

CHECK_CASE("selection: roulette draws in proportion to the fitness") {
  GaOptions options;
  options.selection = Selection::roulette;
  options.fitness = Fitness::inverse_square;
  Eigen::VectorXd fitness = kPenalties.cwiseInverse().cwiseAbs2();
  check_shares(options, kPenalties, fitness / fitness.sum(), "1/P^2");
  options.fitness = Fitness::inverse;
  fitness = kPenalties.cwiseInverse();
  check_shares(options, kPenalties, fitness / fitness.sum(), "1/P");
  options.fitness = Fitness::sum_minus;
  fitness = kPenalties.sum() - kPenalties.array();
  check_shares(options, kPenalties, fitness / fitness.sum(), "sum - P");
}

CHECK_CASE("selection: infinite penalties never become parents, zero ones share") {
  GaOptions options;
  options.selection = Selection::roulette;
  for (const auto fitness : {Fitness::inverse_square, Fitness::inverse, Fitness::sum_minus}) {
    options.fitness = fitness;
    const std::string name(base::word(fitness));
    check_shares(options, of({kInfinite, 2.0, kInfinite, 2.0}), of({0, 0.5, 0, 0.5}), name);
    check_shares(options, of({kInfinite, 2.0, kInfinite, kInfinite}), of({0, 1, 0, 0}), name);
    check_shares(options, Eigen::VectorXd::Constant(4, kInfinite), of({0.25, 0.25, 0.25, 0.25}),
                 name);
    check_shares(options, Eigen::VectorXd::Zero(4), of({0.25, 0.25, 0.25, 0.25}), name);
    check_shares(options, of({1e308, 1e308, 1e308, 1e308}), of({0.25, 0.25, 0.25, 0.25}), name);
  }
  options.fitness = Fitness::inverse_square;
  check_shares(options, of({0.0, 1.0, 0.0, 5.0}), of({0.5, 0, 0.5, 0}), "two zeros");
  check_shares(options, of({-1.0, 1.0, 0.0, 5.0}), of({0.5, 0, 0.5, 0}), "negative");
}

CHECK_CASE("selection: 1/P^2 selects much harder than sum - P") {
  // The pressure (expected copies of the best) on a population in which one is ten times better.
  Eigen::VectorXd penalties = Eigen::VectorXd::Constant(100, 10.0);
  penalties[17] = 1.0;
  const auto pressure = [&](Fitness fitness) {
    const Eigen::VectorXd all = fitness_of(fitness, penalties);
    return 100.0 * all[17] / all.sum();
  };
  CHECK_CLOSE(pressure(Fitness::inverse_square), 100.0 / 1.99, 1e-9);
  CHECK_CLOSE(pressure(Fitness::sum_minus), 990.0 / 981.0 * 100.0 / (99.0 + 990.0 / 981.0), 1e-9);
  CHECK(pressure(Fitness::sum_minus) < 1.01);
}

CHECK_CASE("selection: the diversity measures equal their formulas") {
  GaOptions options;
  CHECK_CLOSE(diversity_of(options, kPenalties), 1.0 / 4.2, 1e-15);
  options.diversity = Diversity::fitness;
  CHECK_CLOSE(diversity_of(options, kPenalties), (1.0 / 9.0 + 1.0 + 0.01 + 0.25 + 0.04) / 5.0,
              1e-15);
  options.fitness =
      Fitness::sum_minus;  // the reason for the listing's own measure: this one is never low
  CHECK_CLOSE(diversity_of(options, kPenalties), 4.0 * 4.2 / 20.0, 1e-15);
  for (const auto diversity : {Diversity::penalty, Diversity::fitness}) {
    for (const auto fitness : {Fitness::inverse_square, Fitness::sum_minus}) {
      options.diversity = diversity;
      options.fitness = fitness;
      for (const double all : {0.0, 0.1, 1e300, kInfinite}) {
        CHECK_CLOSE(diversity_of(options, Eigen::VectorXd::Constant(7, all)), 1.0, 1e-15);
        CHECK(diversity_of(options, Eigen::VectorXd::Constant(7, all)) <= 1.0);
      }
      const double one = diversity_of(options, of({1.0, 1.0, kInfinite, kInfinite}));
      CHECK(one >= 0.0 && one <= 0.5);
    }
  }
}

CHECK_CASE("selection: adaptation is constant outside the two limits and linear between") {
  GaOptions options = GaOptions::thesis();
  const auto pair = [&](double diversity) {
    const auto p = adapted(options, diversity);
    return of({p.crossover, p.mutation});
  };
  CHECK(pair(0.0) == of({0.95, 0.03}));
  CHECK(pair(0.7) == of({0.95, 0.03}));
  CHECK(pair(0.95) == of({0.80, 0.08}));
  CHECK(pair(1.0) == of({0.80, 0.08}));
  CHECK((pair(0.825) - of({0.875, 0.055})).norm() < 1e-15);
  CHECK((pair(0.75) - of({0.92, 0.04})).norm() < 1e-15);
  options.adaptive = false;
  CHECK(pair(1.0) == of({0.95, 0.03}));
}

}  // namespace
}  // namespace jointid::tests
