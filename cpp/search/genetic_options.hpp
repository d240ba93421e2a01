#pragma once
// Options of the genetic algorithm: operators by name, probabilities, presets.

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "base/choices.hpp"

namespace jointid::search {

enum class Coding { real, binary };
enum class Selection { tournament, roulette, rank };
enum class Fitness { inverse_square, inverse, sum_minus };
enum class Crossover { sbx, sorted_sbx, blx };
enum class BitCrossover { one_point, two_point };
enum class Uncrossed { mates, places };
enum class Mutation { non_uniform, shrinking, uniform, polynomial };
enum class MutationUnit { gene, individual };
enum class Diversity { penalty, fitness };

struct GaOptions {
  int population = 24;   ///< individuals per island, at least 4
  int generations = 40;  ///< largest number after the first population
  Coding coding = Coding::real;
  int bits = 16;  ///< per gene (binary coding)

  Selection selection = Selection::tournament;
  int tournament = 2;          ///< individuals that compete for each parent place
  double rank_pressure = 1.5;  ///< expected copies of the best individual (rank selection)
  Fitness fitness = Fitness::inverse_square;  ///< measure that the roulette uses
  int elite = 2;                              ///< best individuals that survive unchanged

  Crossover crossover = Crossover::sbx;
  BitCrossover bit_crossover = BitCrossover::two_point;
  double crossover_probability = 0.9;       ///< of a pair
  double crossover_gene_probability = 0.5;  ///< of a gene in a pair that crosses
  /// SBX distribution index: larger keeps children nearer their parents
  double crossover_eta = 5.0;
  double blx_alpha = 0.5;  ///< reach of BLX beyond the parents, in units of their distance
  Uncrossed uncrossed = Uncrossed::mates;  ///< individuals that replace a pair that does not cross

  Mutation mutation = Mutation::non_uniform;
  double mutation_probability = 0.1;  ///< of a gene or of an individual
  MutationUnit mutation_unit = MutationUnit::gene;
  double mutation_exponent =
      2.0;                     ///< exponent with which mutation steps shrink over the generations
  double mutation_eta = 20.0;  ///< distribution index of polynomial mutation

  bool adaptive = false;                     ///< adapt both probabilities to the diversity measure
  Diversity diversity = Diversity::penalty;  ///< the measure: 1 when all are equal
  double diversity_low = 0.7;                ///< the measure at which adaptation begins
  double diversity_high = 0.95;              ///< the measure at which adaptation is complete
  double crossover_probability_alike = 0.8;  ///< at `diversity_high`
  double mutation_probability_alike = 0.2;   ///< at `diversity_high`

  int islands = 1;              ///< number of populations, in a ring
  int migration_interval = 20;  ///< generations between migrations

  double tolerance = 1e-10;  ///< stop when the spread (worst - best) / best is below this; 0: never
  bool polish = true;        ///< end with a local least-squares search from the best individual

  void validate() const;
  /// The algorithm that the thesis describes.
  static GaOptions thesis();
  /// The different algorithm of the thesis's MATLAB listing.
  static GaOptions thesis_code();
};

/// Calls visit(name, member) for every field, in the order of storage and comparison.
template <class Options, class Visit>
void each_field(Options& o, Visit visit) {
  visit("population", o.population);
  visit("generations", o.generations);
  visit("coding", o.coding);
  visit("bits", o.bits);
  visit("selection", o.selection);
  visit("tournament", o.tournament);
  visit("rank_pressure", o.rank_pressure);
  visit("fitness", o.fitness);
  visit("elite", o.elite);
  visit("crossover", o.crossover);
  visit("bit_crossover", o.bit_crossover);
  visit("crossover_probability", o.crossover_probability);
  visit("crossover_gene_probability", o.crossover_gene_probability);
  visit("crossover_eta", o.crossover_eta);
  visit("blx_alpha", o.blx_alpha);
  visit("uncrossed", o.uncrossed);
  visit("mutation", o.mutation);
  visit("mutation_probability", o.mutation_probability);
  visit("mutation_unit", o.mutation_unit);
  visit("mutation_exponent", o.mutation_exponent);
  visit("mutation_eta", o.mutation_eta);
  visit("adaptive", o.adaptive);
  visit("diversity", o.diversity);
  visit("diversity_low", o.diversity_low);
  visit("diversity_high", o.diversity_high);
  visit("crossover_probability_alike", o.crossover_probability_alike);
  visit("mutation_probability_alike", o.mutation_probability_alike);
  visit("islands", o.islands);
  visit("migration_interval", o.migration_interval);
  visit("tolerance", o.tolerance);
  visit("polish", o.polish);
}

}  // namespace jointid::search

namespace jointid::base {

template <>
struct Words<search::Coding> {
  static constexpr std::string_view field = "GaOptions.coding";
  static constexpr std::array<std::string_view, 2> all{"real", "binary"};
};
template <>
struct Words<search::Selection> {
  static constexpr std::string_view field = "GaOptions.selection";
  static constexpr std::array<std::string_view, 3> all{"tournament", "roulette", "rank"};
};
template <>
struct Words<search::Fitness> {
  static constexpr std::string_view field = "GaOptions.fitness";
  static constexpr std::array<std::string_view, 3> all{"inverse_square", "inverse", "sum_minus"};
};
template <>
struct Words<search::Crossover> {
  static constexpr std::string_view field = "GaOptions.crossover";
  static constexpr std::array<std::string_view, 3> all{"sbx", "sorted_sbx", "blx"};
};
template <>
struct Words<search::BitCrossover> {
  static constexpr std::string_view field = "GaOptions.bit_crossover";
  static constexpr std::array<std::string_view, 2> all{"one_point", "two_point"};
};
template <>
struct Words<search::Uncrossed> {
  static constexpr std::string_view field = "GaOptions.uncrossed";
  static constexpr std::array<std::string_view, 2> all{"mates", "places"};
};
template <>
struct Words<search::Mutation> {
  static constexpr std::string_view field = "GaOptions.mutation";
  static constexpr std::array<std::string_view, 4> all{"non_uniform", "shrinking", "uniform",
                                                       "polynomial"};
};
template <>
struct Words<search::MutationUnit> {
  static constexpr std::string_view field = "GaOptions.mutation_unit";
  static constexpr std::array<std::string_view, 2> all{"gene", "individual"};
};
template <>
struct Words<search::Diversity> {
  static constexpr std::string_view field = "GaOptions.diversity";
  static constexpr std::array<std::string_view, 2> all{"penalty", "fitness"};
};

}  // namespace jointid::base
