#include "bind/recordings.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/solve/projected_search.hpp"
#include "identify/solve/separable.hpp"
#include "identify/solve/window_shifts.hpp"
#include "search/polish.hpp"

namespace jointid::bind {

using identify::Penalty;
using identify::PenaltyFunction;
using search::Domain;

namespace {

search::ResidualFunction residual_function(const PenaltyFunction& penalty, const base::Pool& pool) {
  return [&](const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) {
    penalty.residuals(theta, residual, jacobian, &pool.cancel());
  };
}

}  // namespace

void bind_search(py::module_& m) {
  bind_genetic(m);
  py::class_<identify::SeparableResult>(m, "SeparableResult", "Result of the separable search.")
      .def_readonly("best", &identify::SeparableResult::best)
      .def_readonly("penalty", &identify::SeparableResult::penalty)
      .def_readonly("evaluations", &identify::SeparableResult::evaluations);
  py::class_<identify::Projected>(m, "Projected",
                                  "Optimum of the projected search, if there is one.")
      .def_readonly("found", &identify::Projected::found)
      .def_readonly("reason", &identify::Projected::reason,
                    "Why nothing was found; empty otherwise.");
  py::class_<search::PolishResult>(m, "PolishResult", "Result of a local search.")
      .def_readonly("best", &search::PolishResult::best)
      .def_readonly("penalty", &search::PolishResult::penalty)
      .def_readonly("iterations", &search::PolishResult::iterations)
      .def_readonly("converged", &search::PolishResult::converged);

  m.def(
      "minimise_separable",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         int threads) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return identify::minimise_separable(penalty, domain, pool);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(),
      py::arg("threads") = 0);
  m.def(
      "minimise_projected",
      [](const identify::Penalty& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         int threads) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return identify::minimise_projected(penalty, domain, pool);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(), py::arg("threads") = 0,

      "Return the separable optimum by a dozen direct sums, or nothing where that is not safe.");
  m.def(
      "refine_separable",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const Eigen::VectorXd& start, bool everywhere, int threads) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(threads, SignalPoll{});
        return identify::refine_separable(penalty, domain, start, pool, everywhere);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::arg("start"), py::kw_only(),
      py::arg("everywhere") = true, py::arg("threads") = 0,
      "Return the local optimum near a start. `everywhere` also searches the whole ranges of the "
      "free shapes.");
  m.def(
      "polish",
      [](const PenaltyFunction& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
         const Eigen::VectorXd& start, int iterations) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        base::Pool pool(1, SignalPoll{});
        return search::polish(residual_function(penalty, pool), domain, start, pool, iterations);
      },
      py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::arg("start"), py::kw_only(),
      py::arg("iterations") = 200);
  m.def(
      "window_shifts",
      [](const Penalty& penalty, const Recordings& recordings,
         const std::vector<std::string>& terms, bool mask_standstill, double gear_ratio,
         const std::vector<std::string>& per_recording, Eigen::VectorXd lower,
         Eigen::VectorXd upper, const Eigen::VectorXd& best, int threads) {
        const Domain domain{std::move(lower), std::move(upper)};
        const py::gil_scoped_release nogil;
        return with_pool(samples_of(recordings), threads, [&](base::Pool* pool) {
          auto found =
              identify::window_shifts(penalty, all_masked(recordings, mask_standstill, pool), terms,
                                      gear_ratio, per_recording, domain, best, pool);
          return std::make_pair(std::move(found.halved), std::move(found.doubled));
        });
      },
      py::arg("penalty"), py::kw_only(), py::arg("recordings"), py::arg("terms"),
      py::arg("mask_standstill"), py::arg("gear_ratio"), py::arg("per_recording"), py::arg("lower"),
      py::arg("upper"), py::arg("best"), py::arg("threads") = 0,
      "Return the minima with each window halved, and with neighbours joined in pairs. None where "
      "there are no such windows.");
}

}  // namespace jointid::bind
