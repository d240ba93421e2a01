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
                            "What a window's residual is compared with.")
      .value("sensor", Residual::sensor)
      .value("torque", Residual::torque)
      .value("instruments", Residual::instruments)
      .finalize();
  py::class_<PenaltyFunction>(m, "PenaltyFunction",
                              "What every form of the penalty offers to a search.")
      .def(
          "__call__",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) { return p(theta); },
          py::arg("theta"), py::call_guard<py::gil_scoped_release>(), "Sum of squared residuals.")
      .def(
          "evaluate",
          [](const PenaltyFunction& p, const Eigen::MatrixXd& candidates, int threads) {
            if (candidates.rows() != p.parameters()) {
              throw std::invalid_argument("candidates must have one row a parameter, " +
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
          "Penalties of many candidates, one a column, shape (parameters, count).")
      .def(
          "residuals",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            p.residuals(theta, residual, nullptr);
            return residual;
          },
          py::arg("theta"), "Residuals, one a row.")
      .def(
          "jacobian",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::VectorXd residual;
            Eigen::MatrixXd jacobian;
            p.residuals(theta, residual, &jacobian);
            return jacobian;
          },
          py::arg("theta"), "Derivatives of the residuals, shape (rows, parameters).")
      .def(
          "columns",
          [](const PenaltyFunction& p, const Eigen::VectorXd& shapes) {
            Eigen::MatrixXd columns;
            p.columns(shapes, columns);
            return columns;
          },
          py::arg("shapes"), "Columns of all coefficients, shape (rows, coefficients).")
      .def(
          "linear_columns",
          [](const PenaltyFunction& p, const Eigen::VectorXd& theta) {
            Eigen::MatrixXd columns;
            const Eigen::Index c = p.coefficients();
            p.linear_columns(theta.tail(theta.size() - c), theta.head(c), columns);
            return columns;
          },
          py::arg("theta"), "Columns of the balance made linear there, shape (rows, coefficients).")
      .def_property_readonly("is_linear", &PenaltyFunction::is_linear,
                             "Whether the balance is linear in the coefficients for given shapes.")
      .def_property_readonly("target", &PenaltyFunction::target,
                             "What the columns add up to [N m s], one a row.")
      .def_property_readonly("names", &PenaltyFunction::names)
      .def_property_readonly("coefficients", &PenaltyFunction::coefficients)
      .def_property_readonly("residual", &PenaltyFunction::residual);
  using identify::FirstStage;
  py::class_<FirstStage>(m, "FirstStage",
                         "The sensor's reading, explained by the motion of a rigid link.")
      .def_readonly("acceleration", &FirstStage::acceleration,
                    "Whether the velocity change is among the instruments; it is left out where "
                    "gravity suffices.")
      .def_readonly("strength", &FirstStage::strength,
                    "F statistic of the link's columns beyond those of the balance.")
      .def_readonly("share", &FirstStage::share,
                    "Share of the reading's square without its mean that only they explain.")
      .def_property_readonly("weak", &FirstStage::weak,
                             "Whether they explain too little for an estimate of the gain.");
  py::class_<Penalty, PenaltyFunction>(
      m, "Penalty",

      "The integral penalty of recordings and terms, by the direct sum; a row is a window.")
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

          "Penalty, window residuals with the reading itself, and the derivatives of the "
          "penalty's "
          "residuals, in one pass: what the sandwich of an estimate's covariance is made of.")
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
          py::arg("theta"), "The same, and what `columns` returns at its shapes.")
      .def(
          "residuals",
          [](const Penalty& p, const Eigen::VectorXd& theta) {
            const py::gil_scoped_release nogil;
            Eigen::VectorXd residual;
            p.residuals(theta, residual, nullptr);
            p.observe(theta, residual);
            return residual;
          },
          py::arg("theta"), "Residuals of the windows, with the reading itself.")
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

          "Window integrals of all coefficients, shape (windows, coefficients), of the reading "
          "itself.")
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
          "Replace the gain's column by the part of the reading that the motion "
          "explains; `free` "
          "are the parameters that vary. Only with the residual 'instruments', which "
          "is that of "
          "the torque before.")
      .def_property_readonly("first_stage", &Penalty::first_stage,
                             "How the motion explains the reading; None if it is not projected.")
      .def(
          "torque_steps",
          [](const Penalty& p, const Recordings& recordings, bool mask_standstill) {
            const py::gil_scoped_release nogil;
            return p.torque_steps(all_masked(recordings, mask_standstill, nullptr));
          },
          py::arg("recordings"), py::arg("mask_standstill"),
          "How far the torque rises over each window's usable intervals.")
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

          "How a rigid link moves in each window, shape (window_count, 11): how much faster it "
          "becomes; cosine and sine of the angle in its middle, times the integrated time; "
          "that "
          "time; how far the torque rises over the usable intervals, times the recording's "
          "period "
          "in `periods`; friction of one size, viscous, and fading with the speed over `slow`; "
          "the integrals of the torque and of the reading; the time from first to last "
          "sample.")
      .def(
          "bending",
          [](const Penalty& p, const Recordings& recordings, bool mask_standstill,
             const Eigen::VectorXd& theta) {
            const py::gil_scoped_release nogil;
            return p.bending(all_masked(recordings, mask_standstill, nullptr), theta);
          },
          py::arg("recordings"), py::arg("mask_standstill"), py::arg("theta"),

          "What the windows' friction lacks because the trapezoid rule takes it as straight.")
      .def_property_readonly("terms", &Penalty::terms, "The term of each coefficient.")
      .def_property_readonly("cumulative", &Penalty::cumulative)
      .def_property_readonly("window_count", &Penalty::window_count)
      .def_property_readonly("windows", &Penalty::window_bounds,
                             "First and last sample of each window, shape (window_count, 2).")
      .def_property_readonly(
          "recording_of",
          [](const Penalty& p) {  // an array: a list is made and read number by number
            const std::vector<int>& run = p.recording_of();
            return Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>(
                Eigen::Map<const Eigen::VectorXi>(run.data(), static_cast<Eigen::Index>(run.size()))
                    .cast<std::int64_t>());
          },
          "Which recording each window belongs to, shape (window_count,).")
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
      .def_property_readonly("exact", &CompressedPenalty::exact,
                             "Whether it meets the tolerance; else use the direct sum.")
      .def_property_readonly("reason", &CompressedPenalty::reason, "Why not; empty if it does.")
      .def_property_readonly("passes", &CompressedPenalty::passes,
                             "Shapes at which the samples were summed.")
      .def_property_readonly("error", &CompressedPenalty::error,
                             "Largest error found between those, of the columns' squared size.");
  using identify::PenaltyParts;
  py::class_<PenaltyParts>(
      m, "PenaltyParts", "A penalty that is summed part by part, for what needs it once or twice.")
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
          py::arg("threads") = 0, "The minimum within bounds near a start.");
}

}  // namespace jointid::bind
