// The genetic search: reproducible, inside its domain, and able to find known minima.

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "check.hpp"
#include "landscapes.hpp"

namespace jointid::tests {
namespace {

using search::Domain;
using search::GaOptions;
using search::GaResult;
using search::Generation;
using search::minimise_genetic;
using search::Stop;

CHECK_CASE("genetic: the same bits for 1, 2 and 7 threads") {
  for (const int population : {60, 11}) {
    GaOptions options;
    options.population = population;
    const auto expected = search_for(rippled, cube(5, -4.0, 5.0), options, 42);
    for (const int threads : {1, 2, 7}) {
      const auto result = search_for(rippled, cube(5, -4.0, 5.0), options, 42, threads);
      CHECK(result.best == expected.best);
      CHECK(result.penalty == expected.penalty);
      CHECK(result.history.size() == expected.history.size());
      for (std::size_t i = 0; i < result.history.size(); ++i) {
        CHECK(result.history[i].mean == expected.history[i].mean);
      }
    }
    CHECK(search_for(rippled, cube(5, -4.0, 5.0), options, 43).best != expected.best);
    CHECK(search_for(rippled, cube(5, -4.0, 5.0), options, 42, 1, 1).best != expected.best);
  }
}

CHECK_CASE("genetic: the default's bits are known") {
  // Every operation is our own or exactly rounded, so these bits hold on any x86-64 host.
  const auto result = search_for(rippled, cube(3, -4.0, 5.0), {}, 42);
  CHECK(result.best ==
        Eigen::Vector3d(-0x1.40365100ad3p-7, -0x1.8b06696c2b8p-10, 0x1.7641d6af99cp-8));
  CHECK(result.penalty == 0x1.d5d5343c00ep-8);
  CHECK(result.history.back().mean == 0x1.7d31223bcc8p-7);
  CHECK(result.evaluations == 984);
}

CHECK_CASE("genetic: finds a sphere's minimum, and the deepest of many valleys") {
  GaOptions options;
  options.generations = 300;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto smooth = search_for(sphere, cube(4, -1.0, 2.0), options, seed);
    CHECK_CLOSE(smooth.penalty, 0.0, 1e-5);
    CHECK(smooth.penalty == sphere(smooth.best));
    const auto deepest = search_for(rippled, cube(3, -4.0, 5.0), options, seed);
    CHECK_CLOSE(deepest.penalty, 0.0, 1e-3);
  }
}

CHECK_CASE("genetic: with an elite the population's best never worsens") {
  for (const int elite : {1, 2, 5, 19}) {
    GaOptions options;
    options.population = 20;
    options.generations = 120;
    options.elite = elite;
    options.tolerance = 0.0;
    std::vector<double> bests;
    const auto inner = each(rippled);
    const search::Objective watched = [&](const Eigen::MatrixXd& candidates,
                                          Eigen::VectorXd& penalties, base::Pool& pool) {
      inner(candidates, penalties, pool);
      bests.push_back(penalties.minCoeff());
    };
    base::Pool pool(2);
    const auto result = minimise_genetic(watched, cube(4, -4.0, 5.0), options, 5, 0, pool, {});
    CHECK(bests.size() == 121);
    CHECK(std::is_sorted(bests.rbegin(), bests.rend()));
    CHECK(result.penalty == bests.back());
    for (std::size_t i = 0; i < bests.size(); ++i) CHECK(result.history[i].best == bests[i]);
    CHECK(result.evaluations == 121 * 20);
    CHECK(result.stop == Stop::generations);
  }
}

CHECK_CASE("genetic: without an elite the best ever seen is kept") {
  GaOptions options;
  options.elite = 0;
  options.tolerance = 0.0;
  const auto result = search_for(rippled, cube(4, -4.0, 5.0), options, 6);
  CHECK(result.penalty == rippled(result.best));
  for (std::size_t i = 1; i < result.history.size(); ++i) {
    CHECK(result.history[i].best <= result.history[i - 1].best);
  }
}

CHECK_CASE("genetic: the observer sees every generation and stops") {
  base::Pool pool(2);
  std::vector<int> numbers;
  GaOptions options;
  options.tolerance = 0.0;
  const auto result = minimise_genetic(each(sphere), cube(3, -1.0, 1.0), options, 1, 0, pool,
                                       [&](const Generation& generation) {
                                         numbers.push_back(generation.number);
                                         CHECK(generation.best <= generation.mean);
                                         return generation.number == 17;
                                       });
  CHECK(result.stop == Stop::observer);
  CHECK(result.history.size() == 18);
  for (int i = 0; i < 18; ++i) CHECK(numbers[static_cast<std::size_t>(i)] == i);
}

CHECK_CASE("genetic: stops when the population has collapsed, and when the poll throws") {
  GaOptions options;
  options.generations = 5000;
  options.mutation_probability = 0.0;
  options.tolerance = 1e-6;
  const auto result = search_for([](const Candidate& x) { return 1.0 + sphere(x); },
                                 cube(2, -1.0, 1.0), options, 2);
  CHECK(result.stop == Stop::converged);
  CHECK(result.history.size() < 1000);
  base::Pool pool(1, [] { throw std::runtime_error("interrupted"); });
  CHECK(message_of<std::runtime_error>(
            [&] { minimise_genetic(each(sphere), cube(2, -1.0, 1.0), {}, 2, 0, pool, {}); }, "poll",
            __FILE__, __LINE__) == "interrupted");
}

CHECK_CASE("genetic: stays in the domain to the last bit; fixed parameters stay") {
  Domain domain{Eigen::VectorXd(6), Eigen::VectorXd(6)};
  const double next = std::nextafter(0.1, 1.0);
  domain.lower << 0.1, -1e308, 0.1, 1e-310, 0.7, -3.0;
  domain.upper << 0.3, 1e308, next, 2e-310, 0.7, -1.0 / 3.0;
  bool inside = true;
  Eigen::VectorXd least = domain.upper;
  Eigen::VectorXd most = domain.lower;
  const search::Objective objective = [&](const Eigen::MatrixXd& candidates,
                                          Eigen::VectorXd& penalties, base::Pool&) {
    for (Eigen::Index i = 0; i < candidates.cols(); ++i) {
      const Eigen::VectorXd x = candidates.col(i);
      inside = inside && (x.array() >= domain.lower.array()).all() &&
               (x.array() <= domain.upper.array()).all() && x[4] == 0.7;
      least = least.cwiseMin(x);
      most = most.cwiseMax(x);
      penalties[i] = -x[0] + x[5];  // pulls two of them to their bounds
    }
  };
  GaOptions options;
  options.mutation_probability = 0.5;
  options.crossover_eta = 0.0;
  options.tolerance = 0.0;
  base::Pool pool(1);
  const auto result = minimise_genetic(objective, domain, options, 3, 0, pool, {});
  CHECK(inside);
  CHECK(result.best[4] == 0.7);
  CHECK_CLOSE(result.best[0], 0.3, 1e-6);
  CHECK_CLOSE(result.best[5], -3.0, 1e-6);
  CHECK(least[2] == 0.1 && most[2] == next);
  CHECK(least[1] < -5e307 && most[1] > 5e307);
  // All parameters are fixed: one answer, and no crash.
  const Domain point{domain.lower, domain.lower};
  CHECK(search_for(sphere, point, {}, 1).best == point.lower);
}

CHECK_CASE("genetic: a penalty of NaN loses") {
  const auto result = search_for(
      [](const Candidate& x) {
        return x[0] < 0.0 ? std::numeric_limits<double>::quiet_NaN() : sphere(x);
      },
      cube(2, -1.0, 1.0), {}, 4);
  CHECK(result.best[0] >= 0.0);
  CHECK_CLOSE(result.penalty, 0.0, 1e-4);
  const auto never =
      search_for([](const Candidate&) { return std::numeric_limits<double>::quiet_NaN(); },
                 cube(2, -1.0, 1.0), {}, 4);
  CHECK(never.best.size() == 2);
  CHECK(never.penalty == std::numeric_limits<double>::infinity());
}

CHECK_CASE("genetic: options are refused with name, value and limit") {
  const auto refused = [](auto spoil, std::string_view name, std::string_view value,
                          std::string_view limit) {
    GaOptions options;
    spoil(options);
    CHECK_REFUSED(options.validate(), "GaOptions." + std::string(name) + " is " +
                                          std::string(value) + ": must be " + std::string(limit));
    CHECK_REFUSED(search_for(sphere, cube(2, -1.0, 1.0), options, 1), name);
  };
  refused([](GaOptions& o) { o.population = 3; }, "population", "3", "4 to 1000000");
  refused([](GaOptions& o) { o.generations = 0; }, "generations", "0", "1 to 10000000");
  refused([](GaOptions& o) { o.tournament = 0; }, "tournament", "0", "1 to population");
  refused([](GaOptions& o) { o.tournament = 25; }, "tournament", "25", "1 to population");
  refused([](GaOptions& o) { o.elite = 24; }, "elite", "24", "0 to population - 1");
  refused([](GaOptions& o) { o.elite = -1; }, "elite", "-1", "0 to population - 1");
  refused([](GaOptions& o) { o.crossover_probability = 1.5; }, "crossover_probability", "1.5",
          "0 to 1");
  refused([](GaOptions& o) { o.crossover_eta = -2.0; }, "crossover_eta", "-2", "at least 0");
  refused([](GaOptions& o) { o.mutation_probability = std::nan(""); }, "mutation_probability",
          "nan", "0 to 1");
  refused([](GaOptions& o) { o.mutation_exponent = 0.0; }, "mutation_exponent", "0", "above 0");
  refused([](GaOptions& o) { o.bits = 31; }, "bits", "31", "1 to 30");
  refused([](GaOptions& o) { o.rank_pressure = 2.5; }, "rank_pressure", "2.5", "1 to 2");
  refused([](GaOptions& o) { o.crossover_gene_probability = -0.1; }, "crossover_gene_probability",
          "-0.1", "0 to 1");
  refused([](GaOptions& o) { o.blx_alpha = -0.5; }, "blx_alpha", "-0.5", "at least 0");
  refused([](GaOptions& o) { o.mutation_eta = -1.0; }, "mutation_eta", "-1", "at least 0");
  refused([](GaOptions& o) { o.diversity_low = 1.5; }, "diversity_low", "1.5", "0 to 1");
  refused([](GaOptions& o) { o.diversity_high = 0.5; }, "diversity_high", "0.5",
          "above diversity_low");
  refused([](GaOptions& o) { o.crossover_probability_alike = 2.0; }, "crossover_probability_alike",
          "2", "0 to 1");
  refused([](GaOptions& o) { o.mutation_probability_alike = -2.0; }, "mutation_probability_alike",
          "-2", "0 to 1");
  refused([](GaOptions& o) { o.islands = 0; }, "islands", "0", "1 to 1000000 / population");
  refused([](GaOptions& o) { o.islands = 50000; }, "islands", "50000", "1 to 1000000 / population");
  refused([](GaOptions& o) { o.migration_interval = 0; }, "migration_interval", "0", "at least 1");
  refused([](GaOptions& o) { o.tolerance = 1.0 / 0.0; }, "tolerance", "inf", "at least 0");
  // A tiny value must not be reported as 0.
  refused([](GaOptions& o) { o.tolerance = -1e-10; }, "tolerance", "-1e-10", "at least 0");
  refused([](GaOptions& o) { o.generations = -10; }, "generations", "-10", "1 to 10000000");
  GaOptions().validate();
  CHECK_REFUSED(search_for(sphere, {Eigen::Vector2d(0, 2), Eigen::Vector2d(1, 1)}, {}, 1),
                "parameter 1");
  CHECK_REFUSED(search_for(sphere, cube(0, 0.0, 1.0), {}, 1), "domain");
}

}  // namespace
}  // namespace jointid::tests
