#include "identify/penalty/penalty.hpp"

#include <cmath>
#include <utility>

#include "bind/recordings.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/penalty/link_motion.hpp"
#include "identify/solve/refit.hpp"

namespace jointid::bind {

using identify::CompressedPenalty;
using identify::Penalty;
using identify::PenaltyFunction;
using identify::Residual;
using identify::WindowOptions;

void bind_penalty(py::module_& m) {
  py::native_enum<Residual>(m, "Residual", "enum.Enum",
                            "Signal with which a window's residual is formed.")
      .value("sensor", Residual::sensor)
      .value("torque", Residual::torque)
      .value("instruments", Residual::instruments)
      .finalize();
  py::class_<PenaltyFunction>(m, "PenaltyFunction",
                              "Interface of every form of the penalty for a search.")
      .def(
          "__call__",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) { return p(theta); },
          py::arg("theta"), py::call_guard<py::gil_scoped_release>(),
          "Return the sum of squared residuals.")
      .def(
          "evaluate",
          [](const PenaltyFunction& p, const Eigen::MatrixXd& candidates, int threads) {
            if (candidates.rows() != p.parameters()) {
              throw std::invalid_argument("candidates must have one row per parameter, " +
                                          std::to_string(p.parameters()) + ", got " +
                                          std::to_string(candidates.rows()));
            }
            Eigen::VectorXd penalties(candidates.cols());
            base::Pool pool(threads, SignalPoll{});
            p.evaluate(candidates, penalties, pool);
            return penalties;
          },
          py::arg("candidates"), py::kw_only(), py::arg("threads") = 0,
          py::call_guard<py::gil_scoped_release>(),
          "Return the penalties of many candidates, one per column, shape (parameters, count).")
      .def(
          "residuals",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            p.residuals(theta, residual, nullptr);
            return residual;
          },
          py::arg("theta"), "Return the residuals, one per row.")
      .def(
          "jacobian",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            Eigen::MatrixXd jacobian;
            p.residuals(theta, residual, &jacobian);
            return jacobian;
          },
          py::arg("theta"), "Return the derivatives of the residuals, shape (rows, parameters).")
      .def(
          "columns",
          [](const PenaltyFunction& p, const Eigen::VectorXd& shapes) {
            Eigen::MatrixXd columns;
            p.columns(shapes, columns);
            return columns;
          },
          py::arg("shapes"), "Return the columns of all coefficients, shape (rows, coefficients).")
      .def(
          "linear_columns",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::MatrixXd columns;
            const Eigen::Index c = p.coefficients();
            p.linear_columns(theta.tail(theta.size() - c), theta.head(c), columns);
            return columns;
          },
          py::arg("theta"),
          "Return the columns of the balance linearised at theta, shape (rows, coefficients).")
      .def_property_readonly("is_linear", &PenaltyFunction::is_linear,
                             "Whether the balance is linear in the coefficients for given shapes.")
      .def_property_readonly("target", &PenaltyFunction::target,
                             "Sum that the columns must reach [N m s], one entry per row.")
      .def_property_readonly("names", &PenaltyFunction::names)
      .def_property_readonly("coefficients", &PenaltyFunction::coefficients)
      .def_property_readonly("residual", &PenaltyFunction::residual);
  using identify::FirstStage;
  py::class_<FirstStage>(m, "FirstStage",
                         "Fit of the sensor's reading by the motion of a rigid link.")
      .def_readonly("acceleration", &FirstStage::acceleration,
                    "Whether the velocity change is among the instruments. It is left out where "
                    "gravity suffices.")
      .def_readonly("strength", &FirstStage::strength,
                    "F statistic of the link's columns in addition to those of the balance.")
      .def_readonly("share", &FirstStage::share,
                    "Share of the reading's variance that only the link's columns explain.")
      .def_property_readonly(
          "weak", &FirstStage::weak,
          "Whether the link's columns explain too little for an estimate of the gain.");
  py::class_<Penalty, PenaltyFunction>(
      m, "Penalty",

      "The integral penalty of recordings and terms, by the direct sum. Each row is a window.")
      .def(py::init([](const Recordings& recordings, const std::vector<std::string>& terms,
                       const WindowOptions& windows, Residual residual, bool mask_standstill,
                       double gear_ratio, const std::vector<std::string>& per_recording,
                       int threads) {
             const py::gil_scoped_release nogil;
             return with_pool(samples_of(recordings), threads, [&](base::Pool* pool) {
               const auto masked = all_masked(recordings, mask_standstill, pool);
               return std::make_unique<Penalty>(masked, terms, windows, residual, gear_ratio,
                                                per_recording, pool);
             });
           }),
           py::kw_only(), py::arg("recordings"), py::arg("terms"), py::arg("windows"),
           py::arg("residual"), py::arg("mask_standstill") = true, py::arg("gear_ratio") = 1.0,
           py::arg("per_recording") = std::vector<std::string>{}, py::arg("threads") = 0)
      .def(
          "linearised",
          [](const Penalty& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            Eigen::MatrixXd jacobian;
            double penalty = 0.0;
            {
              const py::gil_scoped_release nogil;
              p.residuals(theta, residual, &jacobian);
              penalty = residual.squaredNorm();
              p.observe(theta, residual);
            }
            return py::make_tuple(penalty, std::move(residual), std::move(jacobian));
          },
          py::arg("theta"),

          "Return, in one pass, the penalty, the window residuals with the reading itself, and the "
          "derivatives of the penalty's residuals. The sandwich covariance of an estimate is "
          "computed from them.")
      .def(
          "balance_at",
          [](const Penalty& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            Eigen::MatrixXd jacobian;
            Eigen::MatrixXd columns;
            double penalty = 0.0;
            {
              const py::gil_scoped_release nogil;
              penalty = p.linearise(theta, residual, jacobian, columns);
            }
            return std::make_tuple(penalty, std::move(residual), std::move(jacobian),
                                   std::move(columns));
          },
          py::arg("theta"),
          "Return the same as `linearised`, and the columns at the shapes of theta.")
      .def(
          "residuals",
          [](const Penalty& p, const Eigen::VectorXd& theta) {
            const py::gil_scoped_release nogil;
            Eigen::VectorXd residual;
            p.residuals(theta, residual, nullptr);
            p.observe(theta, residual);
            return residual;
          },
          py::arg("theta"), "Return the residuals of the windows, with the reading itself.")
      .def(
          "columns",
          [](const Penalty& p, const Eigen::VectorXd& shapes) {
            const py::gil_scoped_release nogil;
            Eigen::MatrixXd columns;
            p.columns(shapes, columns);
            if (p.first_stage()) columns.col(p.gain_index()) = p.reading();
            return columns;
          },
          py::arg("shapes"),

          "Return the window integrals of all coefficients, with the reading itself, shape "
          "(windows, coefficients).")
      .def_property_readonly("reading", &Penalty::reading,
                             "Window integrals of the sensor's reading. Only with a gain.")
      .def(
          "project_reading",
          [](Penalty& p, const std::vector<Eigen::Index>& free, int threads) {
            const py::gil_scoped_release nogil;
            with_pool(p.total_samples(), threads, [&](base::Pool* pool) {
              p.project_reading(free, pool);
              return 0;
            });
          },
          py::arg("free"), py::kw_only(), py::arg("threads") = 0,
          "Replace the gain's column by the part of the reading that the motion explains. `free` "
          "are the free parameters. Only with the residual 'instruments', which is the residual of "
          "the torque until then.")
      .def_property_readonly(
          "first_stage", &Penalty::first_stage,
          "Fit of the reading by the motion; None if the reading is not projected.")
      .def(
          "torque_steps",
          [](const Penalty& p, const Recordings& recordings, bool mask_standstill) {
            const py::gil_scoped_release nogil;
            return p.torque_steps(all_masked(recordings, mask_standstill, nullptr));
          },
          py::arg("recordings"), py::arg("mask_standstill"),
          "Return the rise of the torque over each window's usable intervals.")
      .def(
          "link_motion",
          [](const Penalty& p, const Recordings& recordings, bool mask_standstill,
             const std::vector<double>& periods, double slow) {
            if (p.gain_index() < 0) throw std::invalid_argument("there is no reading");
            if (periods.size() != recordings.size()) {
              throw std::invalid_argument("periods must have a number for each recording");
            }
            const py::gil_scoped_release nogil;
            return identify::link_motion(p, all_masked(recordings, mask_standstill, nullptr),
                                         periods, slow);
          },
          py::arg("recordings"), py::arg("mask_standstill"), py::arg("periods"), py::arg("slow"),

          "Motion of a rigid link in each window, shape (window_count, 11). Columns: the velocity "
          "change; cosine and sine of the angle in the middle, times the integrated time; that "
          "time; the rise of the torque over the usable intervals, times the recording's period in "
          "`periods`; friction that is constant, that is viscous, and that decays with the speed "
          "over `slow`; the integrals of the torque and of the reading; the time from first to "
          "last sample.")
      .def(
          "bending",
          [](const Penalty& p, const Recordings& recordings, bool mask_standstill,
             const Eigen::VectorXd& theta) {
            const py::gil_scoped_release nogil;
            return p.bending(all_masked(recordings, mask_standstill, nullptr), theta);
          },
          py::arg("recordings"), py::arg("mask_standstill"), py::arg("theta"),

          "Return the window integrals of friction that the trapezoidal rule misses, because it "
          "takes friction as straight between samples.")
      .def_property_readonly("terms", &Penalty::terms, "The term of each coefficient.")
      .def_property_readonly("cumulative", &Penalty::cumulative)
      .def_property_readonly("window_count", &Penalty::window_count)
      .def_property_readonly("windows", &Penalty::window_bounds,
                             "First and last sample of each window, shape (window_count, 2).")
      .def_property_readonly(
          "recording_of",
          [](const Penalty&
                 p) {  // An array, because a list would be built and read number by number.
            const std::vector<int>& run = p.recording_of();
            return Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>(
                Eigen::Map<const Eigen::VectorXi>(run.data(), static_cast<Eigen::Index>(run.size()))
                    .cast<std::int64_t>());
          },
          "Index of the recording of each window, shape (window_count,).")
      .def_property_readonly("usable_duration", &Penalty::usable_duration,
                             "Integrated time of each window [s].")
      .def_property_readonly("window_duration",
                             [](const Penalty& p) { return p.window_choice().duration; })
      .def_property_readonly("noise_share",
                             [](const Penalty& p) { return p.window_choice().noise_share; })
      .def_property_readonly("noise_limited",
                             [](const Penalty& p) { return p.window_choice().noise_limited; })
      .def_property_readonly("standing_samples", &Penalty::standing_samples)
      .def_property_readonly("unusable_intervals", &Penalty::unusable_intervals)
      .def_property_readonly("total_samples", &Penalty::total_samples);
  py::class_<CompressedPenalty, PenaltyFunction>(
      m, "CompressedPenalty",
      "The same penalty within bounds, at a cost that does not depend on the "
      "recording's length.")
      .def(py::init([](const Penalty& penalty, Eigen::VectorXd lower, Eigen::VectorXd upper,
                       int threads) {
             const search::Domain domain{std::move(lower), std::move(upper)};
             base::Pool pool(threads, SignalPoll{});
             return CompressedPenalty(penalty, domain, pool);
           }),
           py::arg("penalty"), py::arg("lower"), py::arg("upper"), py::kw_only(),
           py::arg("threads") = 0, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly(
          "exact", &CompressedPenalty::exact,
          "Whether the penalty meets the tolerance; otherwise use the direct sum.")
      .def_property_readonly("reason", &CompressedPenalty::reason,
                             "Reason if the tolerance is not met; empty otherwise.")
      .def_property_readonly("passes", &CompressedPenalty::passes,
                             "Number of shapes at which the samples were summed.")
      .def_property_readonly(
          "error", &CompressedPenalty::error,
          "Largest error between those shapes, as a share of the columns' squared norm.");
  using identify::PenaltyParts;
  py::class_<PenaltyParts>(
      m, "PenaltyParts",
      "A penalty that is summed part by part, for callers that need it once or twice.")
      .def(py::init([](const Recordings& recordings, const std::vector<std::string>& terms,
                       const WindowOptions& windows, Residual residual, bool mask_standstill,
                       double gear_ratio, const std::vector<std::string>& per_recording,
                       int threads) {
             const py::gil_scoped_release nogil;
             return with_pool(samples_of(recordings), threads, [&](base::Pool* pool) {
               return std::make_unique<PenaltyParts>(all_masked(recordings, mask_standstill, pool),
                                                     terms, windows, residual, gear_ratio,
                                                     per_recording);
             });
           }),
           py::kw_only(), py::arg("recordings"), py::arg("terms"), py::arg("windows"),
           py::arg("residual"), py::arg("mask_standstill") = true, py::arg("gear_ratio") = 1.0,
           py::arg("per_recording") = std::vector<std::string>{}, py::arg("threads") = 0)
      .def_property_readonly("window_count", &PenaltyParts::window_count)
      .def(
          "refit",
          [](const PenaltyParts& parts, Eigen::VectorXd lower, Eigen::VectorXd upper,
             const Eigen::VectorXd& start, int threads) {
            const search::Domain domain{std::move(lower), std::move(upper)};
            const py::gil_scoped_release nogil;
            return with_pool(parts.samples(), threads, [&](base::Pool* pool) {
              return identify::refit(parts, domain, start, pool);
            });
          },
          py::arg("lower"), py::arg("upper"), py::arg("start"), py::kw_only(),
          py::arg("threads") = 0, "Return the minimum within bounds near a start.");
}

}  // namespace jointid::bind
