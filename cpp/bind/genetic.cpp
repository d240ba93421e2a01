#include "search/genetic.hpp"

#include <utility>

#include "bind/bind.hpp"
#include "bind/choices.hpp"
#include "identify/penalty/penalty_function.hpp"
#include "search/random_search.hpp"
#include "search/trials.hpp"

namespace jointid::bind {

using identify::PenaltyFunction;
using search::Domain;
using search::GaOptions;
using search::GaResult;
using search::GaState;
using search::Generation;
using search::Stop;

namespace {

using Function = std::optional<py::function>;

search::Objective objective(const PenaltyFunction& penalty) {
  return [&penalty](const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                    base::Pool& pool) { penalty.evaluate(candidates, penalties, pool); };
}

// The function lives longer than the call. Only a pointer is captured, so no reference count
// changes without the GIL.
search::Observer observer(const Function& callback) {
  if (!callback) return {};
  return [function = &*callback](const Generation& generation) {
    const py::gil_scoped_acquire gil;
    const py::object stop = (*function)(generation);
    return !stop.is_none() && stop.cast<bool>();
  };
}

std::function<void(const GaState&)> checkpoint(const Function& callback) {
  if (!callback) return {};
  return [function = &*callback](const GaState& state) {
    const py::gil_scoped_acquire gil;
    (*function)(py::cast(state, py::return_value_policy::copy));
  };
}

py::bytes bytes_of(const GaState& state) {
  return search::to_bytes(state);
}

GaState state_of(const py::bytes& bytes) {
  return search::state_from_bytes(static_cast<std::string_view>(bytes));
}

/// One row per generation, one column per field.
Eigen::Matrix<double, Eigen::Dynamic, 7> series_of(const GaResult& result) {
  Eigen::Matrix<double, Eigen::Dynamic, 7> series(static_cast<Eigen::Index>(result.history.size()),
                                                  7);
  for (Eigen::Index i = 0; i < series.rows(); ++i) {
    const auto& one = result.history[static_cast<std::size_t>(i)];
    series.row(i) << one.number, one.best, one.mean, one.diversity, one.crossover_probability,
        one.mutation_probability, static_cast<double>(one.evaluations);
  }
  return series;
}

void bind_options(py::module_& m) {
  value(
      m, "GaOptions", "Settings of the genetic algorithm. Choices are written and shown as words.",
      Field{"population", &GaOptions::population, "Individuals per island, at least 4."},
      Field{"generations", &GaOptions::generations,
            "Largest number of generations after the first population."},
      Field{"coding", &GaOptions::coding,
            "\"real\", or \"binary\" for comparison, where each gene is a code of `bits` bits."},
      Field{"bits", &GaOptions::bits, "Bits per gene, 1 to 30 (binary coding)."},
      Field{"selection", &GaOptions::selection,
            "\"tournament\", \"roulette\" (by fitness) or \"rank\" (linear ranking)."},
      Field{"tournament", &GaOptions::tournament,
            "Individuals that compete for each parent place."},
      Field{"rank_pressure", &GaOptions::rank_pressure,
            "Expected copies of the best individual under rank selection, 1 to 2."},
      Field{"fitness", &GaOptions::fitness,
            "Fitness from the penalty P: \"inverse_square\" (1/P²), \"inverse\" (1/P) or "
            "\"sum_minus\" (the population's sum of P, minus P)."},
      Field{"elite", &GaOptions::elite,
            "Number of best individuals that survive unchanged. The best one ever is kept in any "
            "case."},
      Field{"crossover", &GaOptions::crossover,
            "\"sbx\" (3-2, 3-3), \"sorted_sbx\" (the first child is bred from the smaller genes of "
            "both parents, the second from the larger ones) or \"blx\" (3-1)."},
      Field{"bit_crossover", &GaOptions::bit_crossover,
            "\"one_point\" or \"two_point\" (binary coding)."},
      Field{"crossover_probability", &GaOptions::crossover_probability,
            "Probability that a pair crosses."},
      Field{"crossover_gene_probability", &GaOptions::crossover_gene_probability,
            "Probability that a gene takes part when its pair crosses."},
      Field{"crossover_eta", &GaOptions::crossover_eta,
            "SBX distribution index; larger values keep children nearer to their parents."},
      Field{"blx_alpha", &GaOptions::blx_alpha,
            "Reach of BLX beyond the parents, in units of their distance."},
      Field{"uncrossed", &GaOptions::uncrossed,
            "Individuals that survive when a pair does not cross: the selected \"mates\", or those "
            "at the same \"places\" in the last generation, selected or not."},
      Field{
          "mutation", &GaOptions::mutation,
          "\"non_uniform\" (3-4, 3-5), \"shrinking\" (a uniform share of the distance to a bound, "
          "which shrinks), \"uniform\" or \"polynomial\". Binary coding flips bits instead."},
      Field{"mutation_probability", &GaOptions::mutation_probability,
            "Probability that a gene mutates, or that one gene of an individual does. Binary "
            "coding: expected flips per gene, or probability of one flip per individual."},
      Field{"mutation_unit", &GaOptions::mutation_unit,
            "Unit of that probability: \"gene\" or \"individual\"."},
      Field{"mutation_exponent", &GaOptions::mutation_exponent,
            "Exponent with which mutation steps shrink over the generations."},
      Field{"mutation_eta", &GaOptions::mutation_eta,
            "Distribution index of polynomial mutation; larger values keep the child nearer."},
      Field{"adaptive", &GaOptions::adaptive,
            "Adapt both probabilities to the diversity measure (3.2.2)."},
      Field{"diversity", &GaOptions::diversity,
            "The diversity measure, which is 1 when all individuals are equal: \"penalty\" "
            "(min/mean of the penalty) or \"fitness\" (mean/max of the fitness)."},
      Field{"diversity_low", &GaOptions::diversity_low,
            "Measure at which the adaptation begins (V_min)."},
      Field{"diversity_high", &GaOptions::diversity_high,
            "Measure at which the adaptation is complete (V_max)."},
      Field{"crossover_probability_alike", &GaOptions::crossover_probability_alike,
            "Crossover probability reached at `diversity_high`."},
      Field{"mutation_probability_alike", &GaOptions::mutation_probability_alike,
            "Mutation probability reached at `diversity_high`."},
      Field{"islands", &GaOptions::islands, "Number of populations, arranged in a ring."},
      Field{"migration_interval", &GaOptions::migration_interval,
            "Generations between migrations. Each island's best individual replaces the next "
            "island's worst."},
      Field{"tolerance", &GaOptions::tolerance,
            "Stop when (worst - best) / best falls below this value; 0: never."},
      Field{"polish", &GaOptions::polish,
            "End with a local least-squares search from the best individual."})
      .def_static("thesis", &GaOptions::thesis,
                  R"(The genetic algorithm that the thesis describes, for comparison.

Selection is by roulette on 1/P². SBX crosses every gene, with eta 4. Non-uniform mutation with exponent
2 changes one gene of an individual, which is drawn with the mutation probability
(`mutation_unit="gene"` draws every gene instead). The crossover probability goes from 0.95 to 0.80 and
the mutation probability from 0.03 to 0.08 as mean/max of the fitness goes from 0.7 to 0.95. There is no
elite and no polish. Population 100, 1000 generations; the thesis's study also has 200 and 1500.
Progress counts from the random first population, so there is one population more than generations.)")
      .def_static("thesis_code", &GaOptions::thesis_code,
                  R"(The genetic algorithm of the thesis's MATLAB listing, for comparison.

It differs from `thesis()`. Roulette is on sum P - P, which hardly selects. Parents are sorted gene by
gene, which breaks the linkage between parameters. A pair that does not cross leaves its places to the
individuals that had them. Mutation moves a gene by a uniform share of its distance to a bound, which
shrinks with exponent 2. Crossover goes from 0.9 to 0.8 and mutation from 0.03 to 0.15 by min/mean of the
penalty. Children are clamped to the domain, where the listing takes absolute values and half the upper
bound.)");
}

void bind_state(py::module_& m) {
  py::class_<GaState>(
      m, "GaState",

      "State of a genetic search between two generations. A resumed search gives the same bits.")
      .def_readonly("options", &GaState::options)
      .def_readonly("seed", &GaState::seed)
      .def_readonly("trial", &GaState::trial)
      .def_readonly("generation", &GaState::generation, "The last evaluated generation.")
      .def_readonly("genes", &GaState::genes,
                    "Free parameters scaled to [0, 1], shape (parameters, individuals).")
      .def_readonly("penalties", &GaState::penalties, "Penalties of the individuals.")
      .def_readonly("best", &GaState::best, "Parameters of the best individual so far.")
      .def_readonly("penalty", &GaState::penalty, "Penalty of the best individual.")
      .def_readonly("evaluations", &GaState::evaluations)
      .def_readonly("history", &GaState::history)
      .def("to_bytes", &bytes_of,
           "Return the exact state with a checksum: the content of a checkpoint file.")
      .def_static("from_bytes", &state_of, py::arg("content"),
                  "Restore a state from `to_bytes`. Raise ValueError for any other content.")
      .def("__eq__",
           [](const GaState& self, const py::object& other) {
             return py::isinstance<GaState>(other) &&
                    search::to_bytes(self) == search::to_bytes(other.cast<const GaState&>());
           })
      .def("__hash__", [](const GaState& self) { return py::hash(bytes_of(self)); })
      .def(py::pickle(&bytes_of, &state_of));
}

void bind_trials(py::module_& m) {
  using search::TrialResult;
  py::class_<TrialResult>(m, "TrialResult", "Short result of one search among many.")
      .def_readonly("best", &TrialResult::best)
      .def_readonly("penalty", &TrialResult::penalty)
      .def_readonly("evaluations", &TrialResult::evaluations)
      .def_readonly("generations", &TrialResult::generations)
      .def_readonly("stop", &TrialResult::stop);
  m.def(
      "minimise_trials",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const std::vector<GaOptions>& options, const std::vector<std::uint64_t>& seeds,
         bool random, int threads) {
        if (options.size() != seeds.size()) {
          throw std::invalid_argument("options and seeds must be equally many, got " +
                                      std::to_string(options.size()) + " and " +
                                      std::to_string(seeds.size()));
        }
        const Domain domain{std::move(lower), std::move(upper)};
        std::vector<search::Trial> trials(options.size());
        for (std::size_t i = 0; i < trials.size(); ++i) trials[i] = {options[i], seeds[i]};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return search::minimise_trials(
            objective(penalty), domain, trials,
            random ? search::Searcher::random : search::Searcher::genetic, pool);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(), py::arg("options"),
      py::arg("seeds"), py::arg("random") = false, py::arg("threads") = 0,

      "Run many genetic (or random) searches in parallel, one per thread. The results have the "
      "same bits as separate searches.");
}

}  // namespace

void bind_genetic(py::module_& m) {
  py::native_enum<Stop>(m, "Stop", "enum.Enum", "Why a search ended.")
      .value("generations", Stop::generations)
      .value("converged", Stop::converged)
      .value("observer", Stop::observer)
      .finalize();
  bind_options(m);
  py::class_<Generation>(m, "Generation", "One generation, as the callback receives it.")
      .def_readonly("number", &Generation::number)
      .def_readonly("best", &Generation::best, "Best penalty so far.")
      .def_readonly("mean", &Generation::mean, "Mean penalty of the population.")
      .def_readonly("diversity", &Generation::diversity,
                    "The diversity measure of the options, which is 1 when all individuals are "
                    "equal; mean of the islands.")
      .def_readonly("crossover_probability", &Generation::crossover_probability,
                    "Crossover probability of the next generation; mean of the islands.")
      .def_readonly("mutation_probability", &Generation::mutation_probability,
                    "Mutation probability of the next generation; mean of the islands.")
      .def_readonly("evaluations", &Generation::evaluations);
  bind_state(m);
  py::class_<GaResult>(m, "GaResult", "Best individual, history and why the search ended.")
      .def_readonly("best", &GaResult::best)
      .def_readonly("penalty", &GaResult::penalty)
      .def_readonly("history", &GaResult::history)
      .def_property_readonly("series", &series_of,
                             "One row per generation: number, best, mean, diversity, probabilities "
                             "of crossover and mutation, evaluations.")
      .def_readonly("evaluations", &GaResult::evaluations)
      .def_readonly("stop", &GaResult::stop)
      .def_readonly("state", &GaResult::state,
                    "State from which the search can continue; None after a random search.");

  m.def(
      "minimise_genetic",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const GaOptions& options, std::uint64_t seed, std::uint32_t trial, int threads,
         const Function& callback, const std::optional<GaState>& resume,
         const Function& on_checkpoint, int checkpoint_interval) {
        const Domain domain{std::move(lower), std::move(upper)};
        const search::Continuation parts{resume ? &*resume : nullptr, checkpoint(on_checkpoint),
                                         checkpoint_interval};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return search::minimise_genetic(objective(penalty), domain, options, seed, trial, pool,
                                        observer(callback), parts);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(), py::arg("options"),
      py::arg("seed") = 0, py::arg("trial") = 0, py::arg("threads") = 0,
      py::arg("callback") = py::none(), py::arg("resume") = py::none(),
      py::arg("checkpoint") = py::none(), py::arg("checkpoint_interval") = 50,

      "Genetic search. `resume` continues from a state made with the same options, seed, trial, "
      "bounds and penalty. `checkpoint` is called with the state every `checkpoint_interval` "
      "generations.");
  m.def(
      "minimise_random",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const GaOptions& options, std::uint64_t seed, std::uint32_t trial, int threads,
         const Function& callback) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return search::minimise_random(objective(penalty), domain, options, seed, trial, pool,
                                       observer(callback));
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(), py::arg("options"),
      py::arg("seed") = 0, py::arg("trial") = 0, py::arg("threads") = 0,
      py::arg("callback") = py::none(),
      "Random search with the budget of the genetic search. Only population, islands and "
      "generations of the options count.");
  bind_trials(m);
}

}  // namespace jointid::bind
