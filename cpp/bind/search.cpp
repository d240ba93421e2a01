#include "bind/bind.hpp"
#include "identify/penalty.hpp"
#include "identify/separable.hpp"
#include "search/genetic.hpp"
#include "search/polish.hpp"

namespace jointid::bind {

using identify::Penalty;
using search::Domain;
using search::GaOptions;
using search::GaResult;
using search::Generation;
using search::Stop;

namespace {

search::ResidualFunction residual_function(const Penalty& penalty, const base::Pool& pool) {
  return [&](const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) {
    penalty.residuals(theta, residual, jacobian, &pool.cancel());
  };
}

}  // namespace

void bind_search(py::module_& m) {
  py::native_enum<Stop>(m, "Stop", "enum.Enum", "Why a search ended.")
      .value("generations", Stop::generations)
      .value("converged", Stop::converged)
      .value("observer", Stop::observer)
      .finalize();
  value(
      m, "GaOptions",
      "Settings of the real-coded genetic algorithm (SBX, non-uniform mutation, tournament, "
      "elitism).",
      Field{"population", &GaOptions::population, "Individuals, at least 4."},
      Field{"generations", &GaOptions::generations, "Generations, at most."},
      Field{"tournament", &GaOptions::tournament,
            "Individuals that compete for each parent place."},
      Field{"elite", &GaOptions::elite, "Best individuals that survive unchanged."},
      Field{"crossover_probability", &GaOptions::crossover_probability,
            "Probability that a pair crosses."},
      Field{"crossover_eta", &GaOptions::crossover_eta,
            "SBX distribution index; larger keeps children nearer."},
      Field{"mutation_probability", &GaOptions::mutation_probability,
            "Probability that a gene mutates."},
      Field{"mutation_exponent", &GaOptions::mutation_exponent, "How fast mutation steps shrink."},
      Field{"tolerance", &GaOptions::tolerance,
            "Stop when (worst - best) / best falls below; 0: never."},
      Field{"polish", &GaOptions::polish,
            "End with a local least-squares search from the best individual."});
  py::class_<Generation>(m, "Generation", "One generation, as the callback sees it.")
      .def_readonly("number", &Generation::number)
      .def_readonly("best", &Generation::best, "Best penalty so far.")
      .def_readonly("mean", &Generation::mean, "Mean penalty of the population.")
      .def_readonly("evaluations", &Generation::evaluations);
  py::class_<GaResult>(m, "GaResult", "Best individual, history and why the search ended.")
      .def_readonly("best", &GaResult::best)
      .def_readonly("penalty", &GaResult::penalty)
      .def_readonly("history", &GaResult::history)
      .def_readonly("evaluations", &GaResult::evaluations)
      .def_readonly("stop", &GaResult::stop);
  py::class_<identify::SeparableResult>(m, "SeparableResult", "The separable optimum.")
      .def_readonly("best", &identify::SeparableResult::best)
      .def_readonly("penalty", &identify::SeparableResult::penalty)
      .def_readonly("evaluations", &identify::SeparableResult::evaluations);
  py::class_<search::PolishResult>(m, "PolishResult", "A local optimum.")
      .def_readonly("best", &search::PolishResult::best)
      .def_readonly("penalty", &search::PolishResult::penalty)
      .def_readonly("iterations", &search::PolishResult::iterations)
      .def_readonly("converged", &search::PolishResult::converged);

  m.def(
      "minimise_genetic",
      [](const Penalty& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const GaOptions& options, std::uint64_t seed, std::uint32_t trial, int threads,
         const std::optional<py::function>& callback) {
        const Domain domain{std::move(lower), std::move(upper)};
        search::Observer observer;
        if (callback) {
          // The function outlives the call in its argument; only a pointer crosses, so no count
          // changes without the GIL.
          observer = [&callback = *callback](const Generation& generation) {
            const py::gil_scoped_acquire gil;
            const py::object stop = callback(generation);
            return !stop.is_none() && stop.cast<bool>();
          };
        }
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        const auto objective = [&](const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                                   base::Pool& workers) {
          penalty.evaluate(candidates, penalties, workers);
        };
        return search::minimise_genetic(objective, domain, options, seed, trial, pool, observer);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(), py::arg("options"),
      py::arg("seed") = 0, py::arg("trial") = 0, py::arg("threads") = 0,
      py::arg("callback") = py::none());
  m.def(
      "minimise_separable",
      [](const Penalty& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper, int threads) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return identify::minimise_separable(penalty, domain, pool);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(),
      py::arg("threads") = 0);
  m.def(
      "polish",
      [](const Penalty& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const Eigen::VectorXd& start, int iterations) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(1, SignalPoll{});
        return search::polish(residual_function(penalty, pool), domain, start, pool, iterations);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::arg("start"), py::kw_only(),
      py::arg("iterations") = 200);
}

}  // namespace jointid::bind
