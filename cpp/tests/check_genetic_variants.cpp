// Operators in a population, islands, the thesis's two variants, and random search.

#include <cmath>
#include <cstdint>
#include <vector>

#include "breeding.hpp"
#include "check.hpp"
#include "landscapes.hpp"
#include "search/random_search.hpp"

namespace jointid::tests {
namespace {

using search::GaOptions;
using search::MutationUnit;

CHECK_CASE("mutation: genes, or one gene of an individual, at the set rate") {
  GaOptions options;
  options.elite = 0;
  options.crossover_probability = 0.0;
  options.mutation_probability = 0.2;
  const Eigen::MatrixXd parents = Eigen::MatrixXd::Constant(6, 20'000, 0.5);
  const Eigen::VectorXd penalties = Eigen::VectorXd::Ones(20'000);
  for (const auto mutation : {search::Mutation::non_uniform, search::Mutation::shrinking,
                              search::Mutation::uniform, search::Mutation::polynomial}) {
    for (const auto unit : {MutationUnit::gene, MutationUnit::individual}) {
      options.mutation = mutation;
      options.mutation_unit = unit;
      const Eigen::ArrayXXd moved =
          (children_of(options, parents, penalties).array() != 0.5).cast<double>();
      const Eigen::ArrayXd by_gene = moved.rowwise().mean();
      const double expected = unit == MutationUnit::gene ? 0.2 : 0.2 / 6.0;
      for (const double share : by_gene) {
        CHECK_CLOSE(share, expected, 4.0 * std::sqrt(expected / 20'000.0));
      }
      const double most = moved.colwise().sum().maxCoeff();
      CHECK(unit == MutationUnit::gene ? most > 1.0 : most == 1.0);
    }
  }
}

CHECK_CASE("mutation: the steps of both shrinking operators are as long as their formulas say") {
  GaOptions options;
  options.elite = 0;
  options.generations = 4;
  options.crossover_probability = 0.0;
  options.mutation_probability = 1.0;
  options.mutation_exponent = 2.0;
  const Eigen::MatrixXd parents = Eigen::MatrixXd::Constant(4, 20'000, 0.5);
  const auto length = [&](search::Mutation mutation) {  // mean share of the distance to a bound
    options.mutation = mutation;
    const auto children = children_of(options, parents, Eigen::VectorXd::Ones(20'000), 2);
    return 2.0 * (children.array() - 0.5).abs().mean();
  };
  const double reach = 0.25;                                            // (1 - progress)^exponent
  CHECK_CLOSE(length(search::Mutation::shrinking), 0.5 * reach, 1e-3);  // of u reach
  CHECK_CLOSE(length(search::Mutation::non_uniform), reach / (1.0 + reach), 3e-3);  // 1 - u^reach
}

CHECK_CASE("uncrossed pairs: mates are selected, places are not") {
  GaOptions options;
  options.elite = 0;
  options.population = 7;
  options.tournament = 7;
  options.crossover_probability = 0.0;
  options.mutation_probability = 0.0;
  const auto parents = random_genes(2, 7, options);
  const Eigen::VectorXd penalties = Eigen::VectorXd::LinSpaced(7, 1.0, 7.0);
  options.uncrossed = search::Uncrossed::places;
  CHECK(children_of(options, parents, penalties) == parents);
  options.uncrossed = search::Uncrossed::mates;
  const auto mates = children_of(options, parents, penalties);
  CHECK(mates != parents);
  for (const auto& child : mates.colwise()) {
    CHECK((parents.colwise() - child).cwiseAbs().colwise().sum().minCoeff() == 0.0);
  }
}

CHECK_CASE(
    "sorted parents: the first child is bred from the smaller genes, the second from the larger") {
  GaOptions options;
  options.elite = 0;
  options.crossover_probability = 1.0;
  options.crossover_gene_probability = 1.0;
  options.mutation_probability = 0.0;
  options.tournament = 1;
  const auto parents = random_genes(5, 1000, options);
  const Eigen::VectorXd penalties = Eigen::VectorXd::LinSpaced(1000, 1.0, 2.0);
  const auto share = [&] {
    const auto children = children_of(options, parents, penalties);
    int ordered = 0;
    for (Eigen::Index i = 0; i < 1000; i += 2) {
      ordered += static_cast<int>((children.col(i).array() <= children.col(i + 1).array()).count());
    }
    return ordered / 2500.0;
  };
  CHECK_CLOSE(share(), 0.5, 0.05);
  options.crossover = search::Crossover::sorted_sbx;
  CHECK(share() == 1.0);
}

CHECK_CASE("islands: the same bits for 1, 2 and 7 threads") {
  for (const bool adaptive : {false, true}) {
    GaOptions options;
    options.population = 13;
    options.islands = 5;
    options.migration_interval = 7;
    options.adaptive = adaptive;
    const auto expected = search_for(rippled, cube(5, -4.0, 5.0), options, 42);
    for (const int threads : {1, 2, 7}) {
      CHECK(same_run(search_for(rippled, cube(5, -4.0, 5.0), options, 42, threads), expected));
    }
    CHECK(expected.history.back().evaluations == 41 * 65);
    options.migration_interval = 1'000'000;
    const auto alone = search_for(rippled, cube(5, -4.0, 5.0), options, 42);
    CHECK(alone.history[7].mean == expected.history[7].mean);
    CHECK(alone.history[8].mean != expected.history[8].mean);
  }
}

CHECK_CASE("islands: the best moves around the ring, and the first island is a run of its own") {
  // If all but one are elite, nothing else moves: each migration moves the best to the next island.
  GaOptions options;
  options.population = 5;
  options.islands = 4;
  options.elite = 4;
  options.migration_interval = 10;
  options.mutation_probability = 0.0;
  options.tolerance = 0.0;
  std::vector<int> holders;
  const auto inner = each(sphere);
  const search::Objective watched = [&](const Eigen::MatrixXd& candidates,
                                        Eigen::VectorXd& penalties, base::Pool& pool) {
    inner(candidates, penalties, pool);
    int count = 0;
    const double best = penalties.minCoeff();
    for (Eigen::Index k = 0; k < 4; ++k) count += penalties.segment(5 * k, 5).minCoeff() == best;
    holders.push_back(count);
  };
  options.generations = 45;
  options.crossover_probability = 0.0;
  base::Pool pool(2);
  minimise_genetic(watched, cube(3, -1.0, 1.0), options, 5, 0, pool, {});
  for (const int at : {0, 10}) CHECK(holders[static_cast<std::size_t>(at)] == 1);
  CHECK(holders[11] == 2 && holders[20] == 2 && holders[21] == 3 && holders[31] == 4);
  // Individuals are numbered through, so before any migration the first island is the single run.
  GaOptions several;
  several.islands = 3;
  several.tolerance = 0.0;
  several.generations = 15;
  GaOptions single = several;
  single.islands = 1;
  const auto many = search_for(rippled, cube(3, -4.0, 5.0), several, 8);
  const auto one = search_for(rippled, cube(3, -4.0, 5.0), single, 8);
  CHECK(many.state->genes.leftCols(several.population) == one.state->genes);
}

CHECK_CASE("presets: the thesis's settings, deterministic, adapting") {
  const auto text = GaOptions::thesis();
  const auto code = GaOptions::thesis_code();
  text.validate();
  code.validate();
  CHECK(text.elite == 0 && code.elite == 0 && !text.polish && !code.polish);
  CHECK(text.crossover_eta == 4.0 && code.crossover_eta == 4.0);
  for (auto options : {text, code}) {
    options.population = 20;
    options.generations = 200;
    const auto result = search_for(rippled, cube(4, -4.0, 5.0), options, 1);
    CHECK(same_run(search_for(rippled, cube(4, -4.0, 5.0), options, 1, 7), result));
    CHECK(result.history.size() == 201);
    CHECK(result.penalty == rippled(result.best));
    for (const auto& g : result.history) {
      CHECK(g.diversity >= 0.0 && g.diversity <= 1.0);
      const auto p = search::adapted(options, g.diversity);
      CHECK(g.crossover_probability == p.crossover && g.mutation_probability == p.mutation);
    }
    CHECK(result.penalty < 0.5 * result.history.front().best);
  }
}

CHECK_CASE("islands: the same bits where breeding uses threads") {
  GaOptions options;
  options.population = 700;
  options.generations = 6;
  options.islands = 4;
  options.migration_interval = 2;
  const auto expected = search_for(rippled, cube(5, -4.0, 5.0), options, 42);
  for (const int threads : {2, 7}) {
    CHECK(same_run(search_for(rippled, cube(5, -4.0, 5.0), options, 42, threads), expected));
  }
}

CHECK_CASE("random search: the genetic algorithm's budget, uniform, deterministic, and worse") {
  GaOptions options;
  options.population = 60;
  options.generations = 120;
  options.islands = 2;
  options.tolerance = 0.0;
  const auto go = [&](std::uint64_t seed, int threads) {
    base::Pool pool(threads);
    return search::minimise_random(each(rippled), cube(5, -4.0, 5.0), options, seed, 0, pool, {});
  };
  const auto result = go(3, 1);
  CHECK(same_run(go(3, 7), result));
  CHECK(go(4, 1).best != result.best);
  CHECK(result.evaluations == 121 * 120 && result.history.size() == 121);
  CHECK(result.penalty == rippled(result.best) && !result.state);
  CHECK(search_for(rippled, cube(5, -4.0, 5.0), options, 3).penalty < 0.1 * result.penalty);
  // The mean of x^2 + 3 - 3 cos 6x over [-4, 5], five times.
  const double expected = 5.0 * (7.0 + 3.0 - 3.0 * (std::sin(30.0) + std::sin(24.0)) / 54.0);
  double mean = 0.0;
  for (const auto& g : result.history) mean += g.mean / 121.0;
  CHECK_CLOSE(mean, expected, 0.01 * expected);
  base::Pool pool(1);
  const auto stopped =
      search::minimise_random(each(sphere), cube(2, -1.0, 1.0), options, 0, 0, pool,
                              [](const search::Generation& g) { return g.number == 4; });
  CHECK(stopped.stop == search::Stop::observer && stopped.history.size() == 5);
}

}  // namespace
}  // namespace jointid::tests
