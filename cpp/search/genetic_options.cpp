#include "search/genetic_options.hpp"

#include <cmath>

#include "base/require.hpp"

namespace jointid::search {

namespace {

constexpr int kMostIndividuals = 1'000'000;

template <class Number>
void require(bool holds, const char* name, Number value, const char* limit) {
  base::Requirement("GaOptions").that(holds, name, value, limit);
}

void probability(const char* name, double p) {
  require(p >= 0.0 && p <= 1.0, name, p, "0 to 1");
}

void at_least_zero(const char* name, double value) {
  require(value >= 0.0 && std::isfinite(value), name, value, "at least 0");
}

}  // namespace

void GaOptions::validate() const {
  require(population >= 4 && population <= kMostIndividuals, "population", population,
          "4 to 1000000");
  require(generations >= 1 && generations <= 10'000'000, "generations", generations,
          "1 to 10000000");
  require(bits >= 1 && bits <= 30, "bits", bits, "1 to 30");
  require(tournament >= 1 && tournament <= population, "tournament", tournament, "1 to population");
  require(rank_pressure >= 1.0 && rank_pressure <= 2.0, "rank_pressure", rank_pressure, "1 to 2");
  require(elite >= 0 && elite < population, "elite", elite, "0 to population - 1");
  probability("crossover_probability", crossover_probability);
  probability("crossover_gene_probability", crossover_gene_probability);
  at_least_zero("crossover_eta", crossover_eta);
  at_least_zero("blx_alpha", blx_alpha);
  probability("mutation_probability", mutation_probability);
  require(mutation_exponent > 0.0 && std::isfinite(mutation_exponent), "mutation_exponent",
          mutation_exponent, "above 0");
  at_least_zero("mutation_eta", mutation_eta);
  probability("diversity_low", diversity_low);
  require(diversity_high > diversity_low && diversity_high <= 1.0, "diversity_high", diversity_high,
          "above diversity_low and at most 1");
  probability("crossover_probability_alike", crossover_probability_alike);
  probability("mutation_probability_alike", mutation_probability_alike);
  require(islands >= 1 && islands <= kMostIndividuals / population, "islands", islands,
          "1 to 1000000 / population");
  require(migration_interval >= 1, "migration_interval", migration_interval, "at least 1");
  at_least_zero("tolerance", tolerance);
}

GaOptions GaOptions::thesis() {
  GaOptions o;
  o.population = 100;
  o.generations = 1000;
  o.selection = Selection::roulette;
  o.fitness = Fitness::inverse_square;
  o.elite = 0;
  o.crossover_gene_probability = 1.0;
  o.crossover_eta = 4.0;
  o.mutation_unit = MutationUnit::individual;
  o.mutation_exponent = 2.0;
  o.adaptive = true;
  o.diversity = Diversity::fitness;
  o.diversity_low = 0.7;
  o.diversity_high = 0.95;
  o.crossover_probability = 0.95;
  o.crossover_probability_alike = 0.80;
  o.mutation_probability = 0.03;
  o.mutation_probability_alike = 0.08;
  o.tolerance = 0.0;
  o.polish = false;
  return o;
}

GaOptions GaOptions::thesis_code() {
  GaOptions o = thesis();
  o.fitness = Fitness::sum_minus;
  o.crossover = Crossover::sorted_sbx;
  o.uncrossed = Uncrossed::places;
  o.mutation = Mutation::shrinking;
  o.diversity = Diversity::penalty;
  o.crossover_probability = 0.9;
  o.mutation_probability_alike = 0.15;
  return o;
}

}  // namespace jointid::search
