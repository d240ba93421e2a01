// Calls that begin work over recordings beside the interpreter.

#include <cmath>
#include <utility>

#include "bind/beside.hpp"
#include "bind/recordings.hpp"
#include "diagnose/ripple.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/solve/window_shifts.hpp"

namespace jointid::bind {

using identify::CompressedPenalty;
using identify::Penalty;
using identify::PenaltyParts;
using identify::Residual;
using identify::WindowOptions;

void bind_begun(py::module_& m) {
  m.def(
      "begin_search",
      [](const Recordings& recordings, const std::vector<std::string>& terms,
         const WindowOptions& windows, Residual residual, bool mask_standstill, double gear_ratio,
         const std::vector<std::string>& per_recording, const std::vector<Eigen::Index>& free,
         Eigen::VectorXd lower, Eigen::VectorXd upper, int threads) {
        const std::int64_t samples = samples_of(recordings);
        if (!Beside::has_room(samples, threads)) return std::optional<Beside>{};
        const search::Domain domain{std::move(lower), std::move(upper)};
        const auto make = [=](base::Pool*) {
          auto penalty =
              std::make_unique<Penalty>(all_masked(recordings, mask_standstill, nullptr), terms,
                                        windows, residual, gear_ratio, per_recording);
          if (residual == Residual::instruments) penalty->project_reading(free);
          return penalty;
        };
        return std::make_optional<Beside>(samples, threads, make, [=](const Penalty& penalty) {
          base::Pool alone(1);
          return CompressedPenalty(penalty, domain, alone);
        });
      },
      py::kw_only(), py::arg("recordings"), py::arg("terms"), py::arg("windows"),
      py::arg("residual"), py::arg("mask_standstill"), py::arg("gear_ratio"),
      py::arg("per_recording"), py::arg("free"), py::arg("lower"), py::arg("upper"),
      py::arg("threads") = 0,
      JOINTID_TEXT("Begin to make a penalty whose reading is projected, and its compressed form."));
  m.def(
      "ripple",
      [](const Recordings& recordings, const std::vector<std::string>& terms,
         const WindowOptions& windows, Residual residual, bool mask_standstill, double gear_ratio,
         const std::vector<std::string>& per_recording, const Eigen::VectorXd& theta, int halves,
         int threads) {
        return Beside(samples_of(recordings), threads, [=](base::Pool* pool) {
          const PenaltyParts parts(all_masked(recordings, mask_standstill, pool), terms, windows,
                                   residual, gear_ratio, per_recording);
          auto found = diagnose::ripple_spectrum(parts, theta, std::abs(gear_ratio), halves, pool);
          return std::make_tuple(found.windows, found.power, std::move(found.multiple));
        });
      },
      py::kw_only(), py::arg("recordings"), py::arg("terms"), py::arg("windows"),
      py::arg("residual"), py::arg("mask_standstill"), py::arg("gear_ratio"),
      py::arg("per_recording"), py::arg("theta"), py::arg("halves"), py::arg("threads") = 0,
      JOINTID_TEXT("Begin to sum over short windows: their number, the sum of squared mean "
                   "residuals, and the "
                   "magnitude of their sum over each half multiple of the motor's angle."));
  m.def(
      "window_shifts",
      [](const Penalty& penalty, const Recordings& recordings,
         const std::vector<std::string>& terms, bool mask_standstill, double gear_ratio,
         const std::vector<std::string>& per_recording, Eigen::VectorXd lower,
         Eigen::VectorXd upper, const Eigen::VectorXd& best, int threads) {
        const search::Domain domain{std::move(lower), std::move(upper)};
        return Beside(samples_of(recordings), threads, [=, &penalty](base::Pool* pool) {
          auto found =
              identify::window_shifts(penalty, all_masked(recordings, mask_standstill, pool), terms,
                                      gear_ratio, per_recording, domain, best, pool);
          return std::make_pair(std::move(found.halved), std::move(found.doubled));
        });
      },
      py::arg("penalty"), py::kw_only(), py::arg("recordings"), py::arg("terms"),
      py::arg("mask_standstill"), py::arg("gear_ratio"), py::arg("per_recording"), py::arg("lower"),
      py::arg("upper"), py::arg("best"), py::arg("threads") = 0, py::keep_alive<0, 1>(),
      JOINTID_TEXT("Begin to look for the minima with each window halved and with neighbours "
                   "joined in pairs; "
                   "None where there "
                   "are no such windows."));
}

}  // namespace jointid::bind
